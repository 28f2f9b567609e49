use super::{Criterion, negative_laplacian};
use crate::detect::flatten::normalise;
use crate::image::{Plane, gaussian};

const SIGMA: f64 = 0.22;
const CONTRAST: f64 = 2.;
const CRITERION: Criterion = Criterion { threshold: 0.3, suppression: 0.6 };

/// An inner segment is a disc, brighter than what surrounds it: the
/// Laplacian of a Gaussian as wide as the disc fills it, so that texture and outline do not make maxima of their own.
pub(super) fn response(image: &Plane, spacing: f64) -> (Plane, Criterion) {
    let blurred = gaussian(image, SIGMA * spacing);
    (normalise(&negative_laplacian(&blurred), CONTRAST * spacing), CRITERION)
}
