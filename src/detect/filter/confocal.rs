use super::{Criterion, negative_laplacian};
use crate::detect::spacing::CLEAR;
use crate::image::{Plane, gaussian};

/// Width of the Gaussian, in spacings, where the image is clear: narrow, so that close neighbours stay apart.
const NARROWEST: f64 = 0.13;
/// Where it is not, the Gaussian is wider by so much for every unit of clarity below `CLEAR`, up to `WIDEST`. Chosen on
/// hand-marked images with white, smooth and Poisson-like noise of 0–1 standard deviations, and at .7 and 1.5 times their size.
const WIDENING: f64 = 0.0174;
const WIDEST: f64 = 0.21;

const CRITERION: Criterion = Criterion { threshold: 0., suppression: 0.55, relative: None };

/// A cone is a bright spot: −∇² of G(σ)∗I, σ = .13 s, up to .21 s in noise (by the `clarity` of the image's ring). Any concave
/// place is a candidate.
pub(in crate::detect) fn response(image: &Plane, spacing: f64, clarity: f64) -> (Plane, Criterion) {
    let blurred = gaussian(image, sigma(clarity) * spacing);
    (negative_laplacian(&blurred), CRITERION)
}

/// In spacings.
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
