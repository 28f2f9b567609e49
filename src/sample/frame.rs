use super::SampleError;
use crate::geometry::{Point, Rectangle, Window};
use crate::mosaic::hexagonal_spacing;

/// Largest number of points of a pattern, so that it fits into memory.
const MAX_POINTS: usize = 100_000_000;
/// Largest allowed ratio of the longer to the shorter side of a window's bounds; in longer windows
/// a pattern has no meaning.
const MAX_ASPECT: f64 = 1e6;

/// Rectangle in which every sampler works: the bounds of the window, with the upper left corner
/// moved to the origin.
///
/// Positions lie in [0, width) × [0, height). [`Frame::place`] converts a position in the frame to
/// a point of the window.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Width, in the window's unit.
    pub width: f64,
    /// Height, in the window's unit.
    pub height: f64,
    /// `true` if opposite edges are glued together.
    pub torus: bool,
    bounds: Rectangle,
}

impl Frame {
    /// Creates the frame for the bounds of a window.
    ///
    /// # Errors
    /// Fails if `n` exceeds 10⁸, or one side of the bounds is more than 10⁶ times as long as the
    /// other.
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

    /// Returns the hexagonal spacing of `n` points in the frame, or 0 if `n` is 0.
    ///
    /// The hexagonal spacing is the distance between neighbours in a triangular lattice of the same
    /// density.
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
