//! Classical filter of confocal images, in which a cone is a bright spot.
//!
//! The response is −∇² of G(σ)∗I, the image I filtered by a Gaussian of standard deviation σ. In a
//! clear image σ is .13 spacings; the noisier the image, the wider the Gaussian, up to .21
//! spacings.

use super::{Criterion, negative_laplacian};
use crate::detect::spacing::CLEAR;
use crate::image::{Plane, gaussian};

/// Standard deviation of the Gaussian in a clear image, in spacings: narrow, so that close
/// neighbours stay apart.
const NARROWEST: f64 = 0.13;
/// Increase of the width, in spacings, for every unit by which the clarity is below [`CLEAR`].
///
/// It was chosen on hand-marked images with white, smooth and Poisson-like noise of 0–1 standard
/// deviations, and on the same images at .7 and 1.5 times their size.
const WIDENING: f64 = 0.0174;
/// Largest width of the Gaussian, in spacings; it applies at clarities below 1.6, where noise is
/// stronger than the cones.
const WIDEST: f64 = 0.21;

/// Criterion for cones: every positive maximum of the response is a cone unless a higher one is
/// within .55 spacings.
///
/// The response is positive where the blurred image curves downwards, as it does on a bright spot.
const CRITERION: Criterion = Criterion { threshold: 0., suppression: 0.55, relative: None };

/// Returns the response of the filter to `image`, whose cones are `spacing` px apart, and the
/// criterion for cones.
///
/// The Gaussian is wider where `clarity` is low
/// ([`RingProfile::clarity`](crate::detect::RingProfile::clarity)).
pub(in crate::detect) fn response(image: &Plane, spacing: f64, clarity: f64) -> (Plane, Criterion) {
    let blurred = gaussian(image, sigma(clarity) * spacing);
    (negative_laplacian(&blurred), CRITERION)
}

/// Returns the standard deviation of the Gaussian, in spacings, at `clarity`.
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
