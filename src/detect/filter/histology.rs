use super::{Criterion, negative_laplacian};
use crate::detect::flatten::normalise;
use crate::image::{Plane, gaussian};

/// Width of the Gaussian, in spacings: as wide as a disc, so that texture and outline make no maxima of their own.
const SIGMA: f64 = 0.22;
/// Neighbourhood, in spacings, in which the response is made even.
const CONTRAST: f64 = 2.;

/// Rods and the gaps between outlined discs make maxima too, but lower ones; discs of different size touch at less than the mean
/// distance. On 300 simulated images of every look, many harsh, Dice .962; with .3 and .55 s it was .949.
const CRITERION: Criterion = Criterion { threshold: 0.65, suppression: 0.45, relative: None };

/// An inner segment is a disc, brighter than what surrounds it: −∇² of G(.22 s)∗I, divided by its local root mean
/// square (σ = 2 s).
pub(in crate::detect) fn response(image: &Plane, spacing: f64, _clarity: f64) -> (Plane, Criterion) {
    (normalise(&blobs(image, spacing), CONTRAST * spacing), CRITERION)
}

/// The response before it is made even.
pub(in crate::detect) fn blobs(image: &Plane, spacing: f64) -> Plane {
    negative_laplacian(&gaussian(image, SIGMA * spacing))
}
