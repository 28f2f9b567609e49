use super::SampleError;
use crate::geometry::{Point, Rectangle, Window};
use crate::mosaic::hexagonal_spacing;

const MAX_POINTS: usize = 100_000_000;
const MAX_ASPECT: f64 = 1e6;

/// What every sampler asks of its window: it works on [0, width) × [0, height) and places the result there.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Horizontal side.
    pub width: f64,
    /// Vertical side.
    pub height: f64,
    /// Whether opposite edges are glued.
    pub torus: bool,
    bounds: Rectangle,
}

impl Frame {
    /// The bounds of a window.
    ///
    /// # Errors
    /// If `n` points or a window of this shape are beyond all samplers.
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

    /// Hexagonal spacing of `n` points; 0 without points.
    pub fn spacing(&self, n: usize) -> f64 {
        hexagonal_spacing(n, self.width * self.height).unwrap_or(0.)
    }

    /// The point at (x, y) from the upper left corner. Rounding must not carry it over the right or lower edge.
    pub fn place(&self, x: f64, y: f64) -> Point {
        let inside = |v: f64, low: f64, high: f64| (low + v).clamp(low, high.next_down());
        Point::new(
            inside(x, self.bounds.x0(), self.bounds.x1()),
            inside(y, self.bounds.y0(), self.bounds.y1()),
        )
    }
}
