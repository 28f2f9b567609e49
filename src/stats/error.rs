use crate::geometry::{Point, Window};
use thiserror::Error;

/// Reason why a statistic cannot be computed.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StatsError {
    /// Option whose value is out of its range.
    #[error("{option} is {value}: expected {range}")]
    Option {
        /// Name of the option.
        option: &'static str,
        /// Value that was set for the option.
        value: f64,
        /// Description of the permitted values.
        range: &'static str,
    },
    /// Pattern with too few points for the statistic.
    #[error("{statistic} needs at least {needed} points, found {found}: use a larger window")]
    TooFewPoints {
        /// Name of the statistic.
        statistic: &'static str,
        /// Smallest number of points that the statistic accepts.
        needed: usize,
        /// Number of points in the pattern.
        found: usize,
    },
    /// Point that is not finite or lies outside the window.
    #[error(
        "point {index} (counted from 0) is at ({x}, {y}), outside the window: leave it out, or give the \
         window in which it was seen"
    )]
    Outside {
        /// 0-based index of the point.
        index: usize,
        /// The point's x coordinate.
        x: f64,
        /// The point's y coordinate.
        y: f64,
    },
    /// Polygonal window, although the statistic is defined in rectangles only.
    #[error(
        "{statistic} needs a rectangular window: give the rectangle X0, Y0, X1, Y1 that is to be measured"
    )]
    NotRectangular {
        /// Name of the statistic.
        statistic: &'static str,
    },
    /// Torus correction requested for a window with a border.
    #[error(
        "the torus correction needs a window that is a torus, but this window has a border: choose another edge \
         correction, or measure the points as a torus"
    )]
    NotATorus,
}

/// Checks that every point is finite and lies in the window.
///
/// # Errors
/// Fails if a point is not finite or not in the window; the error names the first such point.
pub(super) fn all_inside(points: &[Point], window: &Window) -> Result<(), StatsError> {
    let outside = |p: &Point| !(p.is_finite() && window.contains(*p));
    match points.iter().enumerate().find(|(_, p)| outside(p)) {
        Some((index, p)) => Err(StatsError::Outside { index, x: p.x, y: p.y }),
        None => Ok(()),
    }
}
