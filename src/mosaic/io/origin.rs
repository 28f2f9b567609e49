use crate::choice::UnknownChoice;
use crate::geometry::Point;
use serde::{Deserialize, Serialize};
use std::str::FromStr;
use strum::{Display, VariantArray};

/// What a file calls the centre of the top-left pixel, along both axes.
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
    /// (0, 0): this crate, NumPy, OpenCV, integer ROIs and, since 1.52t, all point ROIs of ImageJ.
    #[default]
    #[serde(rename = "0")]
    #[strum(serialize = "0")]
    Zero,
    /// (0.5, 0.5): distances from the top-left corner, as WebPlotDigitizer counts.
    #[serde(rename = "0.5")]
    #[strum(serialize = "0.5")]
    Half,
    /// (1, 1): MATLAB.
    #[serde(rename = "1")]
    #[strum(serialize = "1")]
    One,
}

impl Origin {
    /// The coordinate of the centre of the first pixel: 0, 0.5 or 1.
    pub const fn value(self) -> f64 {
        match self {
            Self::Zero => 0.,
            Self::Half => 0.5,
            Self::One => 1.,
        }
    }

    /// A point of such a file, counted from 0 at the centre of the top-left pixel.
    pub const fn to_zero_based(self, p: Point) -> Point {
        Point::new(p.x - self.value(), p.y - self.value())
    }
}

impl FromStr for Origin {
    type Err = UnknownChoice;

    /// Reads it as a number: 1.0 is 1.
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
