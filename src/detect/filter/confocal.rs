//! Classical filter of confocal images, in which a cone is a bright spot.
//!
//! The response is −∇² of G(σ)∗I, with σ from .13 spacings in a clear image to .21 spacings in
//! noise.

use super::{Criterion, negative_laplacian};
use crate::detect::spacing::CLEAR;
use crate::image::{Plane, gaussian};

/// Standard deviation of the Gaussian in a clear image, in spacings: narrow, so that close
/// neighbours stay apart.
const NARROWEST: f64 = 0.13;
/// Increase of the width, in spacings, for every unit by which the clarity is below `CLEAR`.
///
/// It was chosen on hand-marked images with white, smooth and Poisson-like noise of 0–1 standard
/// deviations, and on the same images at .7 and 1.5 times their size.
const WIDENING: f64 = 0.0174;
/// Largest width of the Gaussian, in spacings.
const WIDEST: f64 = 0.21;

/// Criterion for cones: every positive maximum of the response, where the blurred image is concave,
/// unless a higher one is within .55 spacings.
const CRITERION: Criterion = Criterion { threshold: 0., suppression: 0.55, relative: None };

/// Returns the response of the filter to an image with the given cone `spacing` in px, and the
/// criterion for cones.
///
/// The filter is wider where `clarity`, the clarity of the image's ring, is low.
pub(in crate::detect) fn response(image: &Plane, spacing: f64, clarity: f64) -> (Plane, Criterion) {
    let blurred = gaussian(image, sigma(clarity) * spacing);
    (negative_laplacian(&blurred), CRITERION)
}

/// Returns the width of the Gaussian, in spacings, for an image of the given clarity.
fn sigma(clarity: f64) -> f64 {
    (NARROWEST + WIDENING * (CLEAR - clarity)).clamp(NARROWEST, WIDEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_filter_is_wider_in_noise() {
        assert_eq!(sigma(f64::INFINITY), 0.13);
        assert_eq!(sigma(8.), 0.13);
        assert!(sigma(4.) > 0.15 && sigma(3.) > sigma(4.));
        assert_eq!(sigma(f64::NEG_INFINITY), 0.21);
    }
}
