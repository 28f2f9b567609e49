use super::{Criterion, negative_laplacian};
use crate::image::{Plane, gaussian};

/// Width of the Gaussian, in spacings: narrow, so that close neighbours stay apart; suppression deals with the noise.
const SIGMA: f64 = 0.13;

const CRITERION: Criterion = Criterion { threshold: 0., suppression: 0.55, relative: None };

/// A cone is a bright spot: −∇² of G(.13 s)∗I. Any concave place is a candidate.
pub(super) fn response(image: &Plane, spacing: f64) -> (Plane, Criterion) {
    let blurred = gaussian(image, SIGMA * spacing);
    (negative_laplacian(&blurred), CRITERION)
}
