use serde::{Deserialize, Serialize};

/// Position in the plane: x to the right, y down, in the unit of the mosaic to which it belongs.
///
/// In pixels, (0, 0) is the **centre** of the top-left pixel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Horizontal coordinate, rising to the right.
    pub x: f64,
    /// Vertical coordinate, rising downwards.
    pub y: f64,
}

impl Point {
    /// Returns the point (x, y).
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// Returns the Euclidean distance to `other`.
    pub fn distance(self, other: Self) -> f64 {
        (self.x - other.x).hypot(self.y - other.y)
    }

    /// Returns whether both coordinates are finite numbers.
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }

    /// Returns `[x, y]`, the form in which spatial indices take points.
    pub const fn coordinates(self) -> [f64; 2] {
        [self.x, self.y]
    }
}

impl From<[f64; 2]> for Point {
    fn from([x, y]: [f64; 2]) -> Self {
        Self { x, y }
    }
}
