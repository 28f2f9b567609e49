//! The central data type: points, the window in which they were seen, and the scale of that window.
//!
//! # Examples
//! ```
//! use conemosaic::prelude::*;
//!
//! let window = Window::rectangle(0., 0., 100., 50.)?; // px
//! let points = vec![Point::new(20., 30.), Point::new(60., 10.), Point::new(120., 10.)];
//! let scale = Scale::new(0.5, 288.)?; // µm per px, µm per degree
//! let (mosaic, outside) = Mosaic::new(points, window, LengthUnit::Pixel, Some(scale))?;
//!
//! assert_eq!((mosaic.len(), outside), (2, 1));
//! assert_eq!(mosaic.density(), 2. / 5000.); // points per px²
//! assert_eq!(mosaic.micrometres_per_unit(), Some(0.5));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod io;
mod normative;
mod scale;

pub use normative::{Meridian, RetinalPlace};
pub use scale::{MICROMETRES_PER_DEGREE, Scale, ScaleError, micrometres_per_degree};

use crate::geometry::{Point, Window, WindowError};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Length unit of a mosaic's coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum LengthUnit {
    /// Image pixels; pixel (0, 0) is the centre of the top-left pixel.
    #[serde(rename = "px")]
    Pixel,
    /// Micrometres on the retina.
    #[serde(rename = "um")]
    Micrometre,
    /// Length without a physical meaning: the side of the unit square.
    #[serde(rename = "unit")]
    Unit,
}

impl LengthUnit {
    /// Returns the factor that converts a length in this unit to the unit `wanted`.
    ///
    /// `None` if the conversion needs a scale that is not known, or if only one of the two units is
    /// [`Unit`](Self::Unit).
    pub fn factor_to(self, wanted: Self, scale: Option<Scale>) -> Option<f64> {
        match (self, wanted) {
            _ if self == wanted => Some(1.),
            (Self::Pixel, Self::Micrometre) => scale.map(|s| s.micrometres_per_pixel()),
            (Self::Micrometre, Self::Pixel) => scale.map(|s| 1. / s.micrometres_per_pixel()),
            _ => None,
        }
    }

    /// Returns the symbol that column headers use: `px`, `um` or `unit`.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Pixel => "px",
            Self::Micrometre => "um",
            Self::Unit => "unit",
        }
    }
}

/// Error for points that cannot be a mosaic.
#[derive(Debug, Error, PartialEq)]
pub enum MosaicError {
    /// Coordinate that is infinite or not a number.
    #[error("point {index} (counted from 0) is ({x}, {y}): expected finite coordinates")]
    NotFinite {
        /// 0-based index of the point.
        index: usize,
        /// Coordinate x of the point.
        x: f64,
        /// Coordinate y of the point.
        y: f64,
    },
    /// Window without a valid shape.
    #[error(transparent)]
    Window(#[from] WindowError),
}

/// Cone centres with the window in which they could have been seen, its unit and its scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Mosaic {
    points: Vec<Point>,
    window: Window,
    unit: LengthUnit,
    scale: Option<Scale>,
}

impl Mosaic {
    /// Makes a mosaic of the points inside `window`, and counts the points outside, which it leaves
    /// out.
    ///
    /// Points on the border count as inside. `unit` is the unit of both the points and the window.
    /// `scale` applies to pixels only; without it, results stay in pixels and say so.
    ///
    /// # Errors
    /// Fails if a coordinate is not finite.
    pub fn new(
        points: Vec<Point>,
        window: Window,
        unit: LengthUnit,
        scale: Option<Scale>,
    ) -> Result<(Self, usize), MosaicError> {
        if let Some((index, p)) = points.iter().enumerate().find(|(_, p)| !p.is_finite()) {
            return Err(MosaicError::NotFinite { index, x: p.x, y: p.y });
        }
        let given = points.len();
        let mut points = points;
        points.retain(|&p| window.contains(p));
        let dropped = given - points.len();
        Ok((Self { points, window, unit, scale }, dropped))
    }

    /// Returns the points, in the order in which they were passed to [`Self::new`].
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Returns the window in which points could have been seen.
    pub const fn window(&self) -> &Window {
        &self.window
    }

    /// Returns the unit of the coordinates and of the window.
    pub const fn unit(&self) -> LengthUnit {
        self.unit
    }

    /// Returns the micrometres per unit of the coordinates, or `None` if they are not known.
    pub fn micrometres_per_unit(&self) -> Option<f64> {
        match self.unit {
            LengthUnit::Pixel => self.scale.map(|s| s.micrometres_per_pixel()),
            LengthUnit::Micrometre => Some(1.),
            LengthUnit::Unit => None,
        }
    }

    /// Returns the scale from pixels to micrometres and degrees, or `None` if it is not known.
    pub const fn scale(&self) -> Option<Scale> {
        self.scale
    }

    /// Returns the number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Returns whether the mosaic has no points.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Returns the density in points per squared unit: n / A, without edge correction.
    pub fn density(&self) -> f64 {
        self.points.len() as f64 / self.window.area()
    }

    /// Returns the hexagonal spacing of the mosaic, in units of the coordinates.
    ///
    /// It is the function [`hexagonal_spacing()`] of the number of points and the area of the
    /// window; `None` if there are no points.
    pub fn hexagonal_spacing(&self) -> Option<f64> {
        hexagonal_spacing(self.points.len(), self.window.area())
    }
}

/// Returns the distance between neighbours in the perfect triangular lattice of n points in `area`.
///
/// s = √(2 A / (√3 n)), which is twice the r_max of Gamito & Maddock (2009, eq. 5),
/// <https://doi.org/10.1145/1640443.1640451>. `None` for n = 0.
pub fn hexagonal_spacing(n: usize, area: f64) -> Option<f64> {
    (n > 0).then(|| (2. * area / (3f64.sqrt() * n as f64)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_outside_the_window_are_counted_and_left_out() {
        let points = vec![Point::new(0.5, 0.5), Point::new(1.5, 0.5), Point::new(1., 1.)];
        let (mosaic, dropped) = Mosaic::new(points, Window::unit_square(), LengthUnit::Unit, None).unwrap();
        assert_eq!((mosaic.len(), dropped), (2, 1));
    }

    #[test]
    fn coordinates_that_are_not_numbers_are_refused() {
        let points = vec![Point::new(0., 0.), Point::new(f64::NAN, 0.)];
        let error = Mosaic::new(points, Window::unit_square(), LengthUnit::Unit, None).unwrap_err();
        assert!(matches!(error, MosaicError::NotFinite { index: 1, .. }));
    }
}
