//! Flattening of an image: its slow drift is subtracted and its contrast made even.

use crate::image::{Plane, gaussian, values};

/// Smallest local contrast that a plane is divided by, as a fraction of the largest local contrast
/// in the plane.
///
/// Without this floor, the noise of empty margins would be blown up.
const FLOOR: f32 = 1e-3;

/// Returns the image less its slow drift, divided by its local contrast.
///
/// With I the image and G(σ) a Gaussian filter of σ = longer side / 8, the result is g /
/// √(G(σ)∗g²), where g = I − G(σ)∗I. It has mean about 0 and standard deviation about 1 everywhere.
pub fn flatten(image: &Plane) -> Plane {
    let (h, w) = image.dim();
    let sigma = h.max(w) as f64 / 8.;
    let mut level = gaussian(image, sigma);
    level.zip_mut_with(image, |drift, v| *drift = v - *drift);
    normalise(&level, sigma)
}

/// Returns `plane` divided by its local root mean square √(G(σ)∗plane²), with `sigma` in px.
pub(super) fn normalise(plane: &Plane, sigma: f64) -> Plane {
    let mut variance = gaussian(&plane.mapv(|v| v * v), sigma);
    let floor = (FLOOR * FLOOR * highest(&variance)).max(f32::MIN_POSITIVE);
    variance.zip_mut_with(plane, |variance, v| *variance = v / variance.max(floor).sqrt());
    variance
}

/// Returns the highest value of a plane without negative values.
///
/// Sixteen maxima are kept side by side, because comparisons with a single maximum would have to
/// wait for each other.
fn highest(plane: &Plane) -> f32 {
    let values = values(plane);
    let (blocks, rest) = values.as_chunks::<16>();
    let higher = |a: f32, b: f32| if b > a { b } else { a };
    let lanes =
        blocks.iter().fold([0f32; 16], |top, block| std::array::from_fn(|k| higher(top[k], block[k])));
    lanes.iter().chain(rest).copied().fold(0., higher)
}
