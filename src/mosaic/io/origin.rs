use crate::choice::UnknownChoice;
use crate::geometry::Point;
use serde::{Deserialize, Serialize};
use std::str::FromStr;
use strum::{Display, VariantArray};

/// Coordinate that a file gives to the centre of the top-left pixel, the same for x and y.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    Display,
    VariantArray,
    strum::VariantNames,
)]
pub enum Origin {
    /// Centre at (0, 0), as in this crate, NumPy, OpenCV and ImageJ.
    ///
    /// ImageJ uses it for integer ROIs and, since version 1.52t, for all point ROIs.
    #[default]
    #[serde(rename = "0")]
    #[strum(serialize = "0")]
    Zero,
    /// Centre at (0.5, 0.5): distances from the top-left corner, as in WebPlotDigitizer.
    #[serde(rename = "0.5")]
    #[strum(serialize = "0.5")]
    Half,
    /// Centre at (1, 1), as in MATLAB.
    #[serde(rename = "1")]
    #[strum(serialize = "1")]
    One,
}

impl Origin {
    /// Returns the coordinate of the centre of the first pixel: 0, 0.5 or 1.
    pub const fn value(self) -> f64 {
        match self {
            Self::Zero => 0.,
            Self::Half => 0.5,
            Self::One => 1.,
        }
    }

    /// Converts a point of a file with this origin to pixels that count from 0 at the centre of the
    /// top-left pixel.
    pub const fn to_zero_based(self, p: Point) -> Point {
        Point::new(p.x - self.value(), p.y - self.value())
    }
}

impl FromStr for Origin {
    type Err = UnknownChoice;

    /// Reads an origin from its number, so that `1.0` is the same as `1`.
    ///
    /// # Errors
    /// Fails if the text is none of the numbers 0, 0.5 and 1.
    fn from_str(text: &str) -> Result<Self, UnknownChoice> {
        let value: Option<f64> = text.parse().ok();
        let fits = |o: &Self| value == Some(o.value());
        Self::VARIANTS.iter().copied().find(fits).ok_or_else(|| UnknownChoice::among::<Self>(text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_pixel_is_zero_whatever_the_file_calls_it() {
        for &origin in Origin::VARIANTS {
            let first = Point::new(origin.value(), origin.value());
            assert_eq!(origin.to_zero_based(first), Point::new(0., 0.));
            assert_eq!(origin.to_string().parse(), Ok(origin));
        }
        assert!("2".parse::<Origin>().is_err());
    }
}
