//! Classical filter of histology, in which an inner segment is a disc brighter than its
//! surroundings.
//!
//! With s the spacing, the response is −∇² of G(.22 s)∗I, the image I filtered by a Gaussian of
//! standard deviation .22 s, divided by its local root mean square in a Gaussian neighbourhood of σ
//! = 2 s.

use super::{Criterion, negative_laplacian};
use crate::detect::flatten::normalise;
use crate::image::{Plane, gaussian};

/// Standard deviation of the Gaussian, in spacings: as wide as a disc, so that texture and outline
/// make no maxima of their own.
const SIGMA: f64 = 0.22;
/// Standard deviation, in spacings, of the Gaussian window for the local root mean square, by which
/// the response is divided.
const CONTRAST: f64 = 2.;

/// Criterion for cones.
///
/// Rods and the gaps between outlined discs make maxima too, but lower ones, hence the threshold.
/// Discs of different size touch at less than the mean distance, hence the short suppression. On
/// 300 varied simulated images, many of them difficult, the Dice coefficient is .962; with a
/// threshold of .3 and a suppression of .55 spacings it was .949.
const CRITERION: Criterion = Criterion { threshold: 0.65, suppression: 0.45, relative: None };

/// Returns the response of the filter to `image`, whose cones are `spacing` px apart, and the
/// criterion for cones.
///
/// The clarity has no influence on this filter.
pub(in crate::detect) fn response(image: &Plane, spacing: f64, _clarity: f64) -> (Plane, Criterion) {
    (normalise(&blobs(image, spacing), CONTRAST * spacing), CRITERION)
}

/// Returns the negative Laplacian of the smoothed image: the response of the filter before it is
/// divided by its local root mean square.
pub(in crate::detect) fn blobs(image: &Plane, spacing: f64) -> Plane {
    negative_laplacian(&gaussian(image, SIGMA * spacing))
}
