use crate::geometry::WindowError;
use thiserror::Error;

/// Reason why an image cannot be made.
#[derive(Debug, Error, PartialEq)]
pub enum RenderError {
    /// Option that is outside its range.
    #[error("{option} is {value}: it must be from {low} to {high} {unit}")]
    OutOfRange {
        /// Name of the option that is out of its range.
        option: &'static str,
        /// Value that the option had.
        value: f64,
        /// Smallest value that is allowed.
        low: f64,
        /// Largest value that is allowed.
        high: f64,
        /// Unit of `value`, `low` and `high`.
        unit: &'static str,
    },
    /// Image with more pixels than are allowed.
    #[error(
        "an image of {width} × {height} px is too large: expected at most {limit} pixels, so make the \
         width or height smaller"
    )]
    TooLarge {
        /// Width of the image, in px.
        width: usize,
        /// Height of the image, in px.
        height: usize,
        /// Largest number of pixels allowed.
        limit: usize,
    },
    /// Point with a coordinate that is infinite or not a number.
    #[error("point {index} (counted from 0) is ({x}, {y}): expected finite coordinates")]
    NotFinite {
        /// Index of the point, from 0.
        index: usize,
        /// Value of the point's x coordinate.
        x: f64,
        /// Value of the point's y coordinate.
        y: f64,
    },
    /// Points whose nearest neighbours could not be found.
    #[error("the neighbours of {points} points could not be found: {reason}")]
    Neighbours {
        /// Number of points passed.
        points: usize,
        /// Message of the spatial index.
        reason: String,
    },
    /// The image has no area.
    #[error(transparent)]
    Window(#[from] WindowError),
    /// There are too few points to tell how large a cone is.
    #[error(
        "the size of the cones follows from the distances between the points, and {found} points are too \
         few: give at least 4 points, or the spacing"
    )]
    SpacingUnknown {
        /// Number of points passed.
        found: usize,
    },
}

/// Returns an error if `value` is not in the range from `low` to `high`.
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
