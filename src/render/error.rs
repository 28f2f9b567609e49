use crate::geometry::WindowError;
use thiserror::Error;

/// A picture that cannot be made.
#[derive(Debug, Error, PartialEq)]
pub enum RenderError {
    /// An option lies outside its range.
    #[error("{option} is {value}: it must be from {low} to {high} {unit}")]
    OutOfRange {
        /// Name of the field.
        option: &'static str,
        /// What it was.
        value: f64,
        /// Smallest value allowed.
        low: f64,
        /// Largest value allowed.
        high: f64,
        /// Unit of all three.
        unit: &'static str,
    },
    /// More pixels than a picture may have.
    #[error("{width} × {height} px is too large: at most {limit} pixels; make width or height smaller")]
    TooLarge {
        /// Width in px.
        width: usize,
        /// Height in px.
        height: usize,
        /// Most pixels allowed.
        limit: usize,
    },
    /// A coordinate is infinite or not a number.
    #[error("point {index} is ({x}, {y}): coordinates must be finite numbers")]
    NotFinite {
        /// 0-based index of the point.
        index: usize,
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
    },
    /// The nearest neighbours of the points could not be found.
    #[error("the neighbours of {points} points could not be found: {reason}")]
    Neighbours {
        /// Number of points.
        points: usize,
        /// What the spatial index says.
        reason: String,
    },
    /// The image has no area.
    #[error(transparent)]
    Window(#[from] WindowError),
    /// Too few points to tell how large a cone is.
    #[error(
        "the size of a cone follows from its neighbours, and {found} points are too few: give at least 4, or the spacing"
    )]
    SpacingUnknown {
        /// Number of points given.
        found: usize,
    },
}

/// Refuses what is outside [low, high] or not a number.
pub(super) fn check(
    option: &'static str,
    value: f64,
    (low, high): (f64, f64),
    unit: &'static str,
) -> Result<(), RenderError> {
    if value >= low && value <= high {
        Ok(())
    } else {
        Err(RenderError::OutOfRange { option, value, low, high, unit })
    }
}
