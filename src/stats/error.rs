use crate::geometry::{Point, Window};
use thiserror::Error;

/// A statistic that cannot be computed.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StatsError {
    /// An option is out of its range.
    #[error("{option} is {value}: {range}")]
    Option {
        /// Which one.
        option: &'static str,
        /// What it was.
        value: f64,
        /// What it must be.
        range: &'static str,
    },
    /// Too few points.
    #[error("{statistic} needs at least {needed} points, there are {found}")]
    TooFewPoints {
        /// What was to be computed.
        statistic: &'static str,
        /// The least it can do with.
        needed: usize,
        /// What there was.
        found: usize,
    },
    /// A point is not finite or lies outside the window.
    #[error(
        "point {index} is ({x}, {y}), which is not inside the window: leave it out or give the window it was seen in"
    )]
    Outside {
        /// 0-based index of the point.
        index: usize,
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
    },
    /// The window is a polygon.
    #[error(
        "{statistic} needs a rectangular window: give the rectangle X0, Y0, X1, Y1 that is to be measured"
    )]
    NotRectangular {
        /// What was to be computed.
        statistic: &'static str,
    },
    /// Torus correction asked for in a window with a border.
    #[error(
        "the torus correction needs a torus window, this one has a border: choose another edge correction"
    )]
    NotATorus,
}

/// That every point is finite and in the window.
///
/// # Errors
/// [`StatsError::Outside`] of the first that is not.
pub(super) fn all_inside(points: &[Point], window: &Window) -> Result<(), StatsError> {
    let outside = |p: &Point| !(p.is_finite() && window.contains(*p));
    match points.iter().enumerate().find(|(_, p)| outside(p)) {
        Some((index, p)) => Err(StatsError::Outside { index, x: p.x, y: p.y }),
        None => Ok(()),
    }
}
