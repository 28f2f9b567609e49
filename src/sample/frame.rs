use super::SampleError;
use crate::geometry::{Point, Rectangle, Window};
use crate::mosaic::hexagonal_spacing;

/// Largest number of points that may be asked for.
const MAX_POINTS: usize = 100_000_000;
/// Largest ratio of the longer to the shorter side of a window.
const MAX_ASPECT: f64 = 1e6;

/// Bounds of a window, in which every sampler works: [0, width) × [0, height), from the upper left
/// corner.
///
/// [`Frame::place`] takes the result into the window.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Horizontal side, in the window's unit.
    pub width: f64,
    /// Vertical side, in the window's unit.
    pub height: f64,
    /// Opposite edges are glued together.
    pub torus: bool,
    bounds: Rectangle,
}

impl Frame {
    /// Creates the frame for the bounds of a window.
    ///
    /// # Errors
    /// If `n` points, or a window of this shape, are beyond all samplers.
    pub fn new(n: usize, window: &Window) -> Result<Self, SampleError> {
        let bounds = window.bounds();
        let (width, height) = (bounds.width(), bounds.height());
        let aspect = (width / height).max(height / width);
        if n > MAX_POINTS {
            return Err(SampleError::TooMany { n, max: MAX_POINTS });
        }
        if aspect > MAX_ASPECT {
            return Err(SampleError::TooThin { aspect, max: MAX_ASPECT });
        }
        Ok(Self { width, height, torus: window.is_torus(), bounds })
    }

    /// Returns the hexagonal spacing of `n` points in the frame; 0 without points.
    pub fn spacing(&self, n: usize) -> f64 {
        hexagonal_spacing(n, self.width * self.height).unwrap_or(0.)
    }

    /// Returns the point of the window at (x, y) from the frame's upper left corner.
    ///
    /// The result is clamped to the half-open bounds, as rounding must not carry a point over the
    /// right or lower edge.
    pub fn place(&self, x: f64, y: f64) -> Point {
        let inside = |v: f64, low: f64, high: f64| (low + v).clamp(low, high.next_down());
        Point::new(
            inside(x, self.bounds.x0(), self.bounds.x1()),
            inside(y, self.bounds.y0(), self.bounds.y1()),
        )
    }
}
