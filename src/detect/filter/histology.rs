use super::{Criterion, negative_laplacian};
use crate::detect::flatten::normalise;
use crate::image::{Plane, gaussian};

/// Width of the Gaussian, in spacings: as wide as a disc, so that texture and outline make no maxima of their own.
const SIGMA: f64 = 0.22;
/// Neighbourhood, in spacings, in which the response is made even.
const CONTRAST: f64 = 2.;

const CRITERION: Criterion = Criterion { threshold: 0.3, suppression: 0.55, relative: None };

/// An inner segment is a disc, brighter than what surrounds it: −∇² of G(.22 s)∗I, divided by its local root mean
/// square (σ = 2 s).
pub(super) fn response(image: &Plane, spacing: f64) -> (Plane, Criterion) {
    (evened(&blobs(image, spacing).0, spacing), CRITERION)
}

/// The response before it is made even, and the suppression radius of its maxima in spacings.
pub(in crate::detect) fn blobs(image: &Plane, spacing: f64) -> (Plane, f64) {
    (negative_laplacian(&gaussian(image, SIGMA * spacing)), CRITERION.suppression)
}

/// Responses divided by their local root mean square.
pub(in crate::detect) fn evened(blobs: &Plane, spacing: f64) -> Plane {
    normalise(blobs, CONTRAST * spacing)
}
