use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Retinal micrometres per degree of visual angle in the average eye.
///
/// The value that Lanaro et al. (2020) use, after Drasdo & Fowler (1974),
/// <https://doi.org/10.1136/bjo.58.8.709>.
pub const MICROMETRES_PER_DEGREE: f64 = 288.;

/// Axial length, in mm, of the reference eye of the Metricks package, in which a degree spans 291
/// µm.
const REFERENCE_AXIAL_LENGTH_MM: f64 = 24.;
/// Micrometres per degree in the reference eye of the Metricks package, which is 24 mm long.
const REFERENCE_MICROMETRES_PER_DEGREE: f64 = 291.;

/// Error for a scale that is not a positive number.
#[derive(Debug, Error, PartialEq)]
#[error("{quantity} is {value}: it must be a positive number")]
pub struct ScaleError {
    quantity: &'static str,
    value: f64,
}

/// Returns `value` if it is a positive number; errors call it `quantity`.
fn positive(quantity: &'static str, value: f64) -> Result<f64, ScaleError> {
    if value.is_finite() && value > 0. { Ok(value) } else { Err(ScaleError { quantity, value }) }
}

/// Returns the retinal micrometres per degree in an eye of this axial length.
///
/// The rule is that of the Metricks package: 291 µm × length / 24 mm.
///
/// # Errors
/// Fails if the length is not a positive number.
pub fn micrometres_per_degree(axial_length_mm: f64) -> Result<f64, ScaleError> {
    let length = positive("axial length in mm", axial_length_mm)?;
    Ok(REFERENCE_MICROMETRES_PER_DEGREE * length / REFERENCE_AXIAL_LENGTH_MM)
}

/// Size of a pixel on the retina, in micrometres and in degrees of visual angle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scale {
    um_per_px: f64,
    um_per_degree: f64,
}

impl Scale {
    /// Makes a scale from µm per pixel and µm per degree.
    ///
    /// # Errors
    /// Fails if either is not a positive number.
    pub fn new(um_per_px: f64, um_per_degree: f64) -> Result<Self, ScaleError> {
        Ok(Self {
            um_per_px: positive("µm per pixel", um_per_px)?,
            um_per_degree: positive("µm per degree", um_per_degree)?,
        })
    }

    /// Makes a scale from pixels per degree and µm per degree.
    ///
    /// # Errors
    /// Fails if either is not a positive number.
    pub fn from_pixels_per_degree(pixels_per_degree: f64, um_per_degree: f64) -> Result<Self, ScaleError> {
        let per_degree = positive("pixels per degree", pixels_per_degree)?;
        Self::new(um_per_degree / per_degree, um_per_degree)
    }

    /// Returns the micrometres per pixel.
    pub const fn micrometres_per_pixel(&self) -> f64 {
        self.um_per_px
    }

    /// Returns the micrometres per degree of visual angle.
    pub const fn micrometres_per_degree(&self) -> f64 {
        self.um_per_degree
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn average_eye_and_individual_eye_use_their_own_rule() {
        let average = Scale::from_pixels_per_degree(576., MICROMETRES_PER_DEGREE).unwrap();
        assert_eq!(average.micrometres_per_pixel(), 0.5);
        assert_eq!(micrometres_per_degree(24.).unwrap(), 291.);
    }

    #[test]
    fn scales_that_are_not_positive_are_refused() {
        assert!(Scale::new(0., 288.).is_err());
        assert!(Scale::new(f64::NAN, 288.).is_err());
        assert!(micrometres_per_degree(-24.).is_err());
    }
}
