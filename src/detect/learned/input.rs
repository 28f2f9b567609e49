//! Input of the networks: an image resampled so that cones have the network's spacing, and
//! normalised.
//!
//! 1. If the new pixels are larger, a Gaussian first removes detail too fine for them.
//! 2. Cubics (Catmull and Rom 1974, <https://doi.org/10.1016/B978-0-12-079050-0.50020-5>)
//!    interpolate the values at the new pixels.
//! 3. The drift is subtracted, and the contrast is made even.

use crate::image::{PARALLEL_PIXELS, Plane, gaussian, mirror, plane_of, values};
use rayon::prelude::*;

/// Standard deviation, in px of the resampled image, of the Gaussian filter whose result is
/// subtracted as drift.
///
/// The networks were trained with this value, with [`CONTRAST`] and with [`FLOOR`].
const DRIFT: f64 = 8.;
/// Standard deviation, in px of the resampled image, of the Gaussian neighbourhood in which
/// contrast is measured.
const CONTRAST: f64 = 12.;
/// Fraction of the mean contrast that is added to the local contrast.
///
/// Without this floor, areas without structure would be blown up.
const FLOOR: f64 = 0.1;

/// Returns `image` with its drift subtracted and its contrast made even.
///
/// With g the image and G(σ) a Gaussian filter of σ px, the result is a / (d + .1 mean d), where a
/// = g − G(8)∗g and d = √(G(12)∗a²).
pub(super) fn normalised(image: &Plane) -> Plane {
    let level = image - &gaussian(image, DRIFT);
    let deviation = gaussian(&level.mapv(|v| v * v), CONTRAST).mapv(|v| v.max(0.).sqrt());
    let mean = deviation.iter().map(|&v| f64::from(v)).sum::<f64>() / deviation.len().max(1) as f64;
    let floor = (FLOOR * mean + 1e-12) as f32;
    let mut out = level;
    out.zip_mut_with(&deviation, |v, d| *v /= d + floor);
    out
}

/// Returns `image` resampled to pixels of `step` × `step` px; its upper and its left edge stay
/// where they are.
pub(super) fn resampled(image: &Plane, step: f64) -> Plane {
    let (h, w) = image.dim();
    // a pixel itself blurs by about half its width; this Gaussian adds what a pixel of `step` px
    // blurs more
    let blurred = if step > 1. { gaussian(image, 0.5 * (step * step - 1.).sqrt()) } else { image.clone() };
    let source = values(&blurred);
    let (rows, columns) = (taps(h, step), taps(w, step));
    let width = columns.len();
    let mut data = vec![0f32; rows.len() * width];
    let fill = |(out, tap): (&mut [f32], &Tap)| {
        let mut row = vec![0f32; w];
        for (&y, &weight) in tap.at.iter().zip(&tap.weights) {
            row.iter_mut().zip(&source[y * w..(y + 1) * w]).for_each(|(r, v)| *r += weight * v);
        }
        for (o, tap) in out.iter_mut().zip(&columns) {
            *o = tap.at.iter().zip(&tap.weights).map(|(&x, weight)| weight * row[x]).sum();
        }
    };
    if data.len() >= PARALLEL_PIXELS {
        data.par_chunks_mut(width).zip(&rows).for_each(fill);
    } else {
        data.chunks_mut(width).zip(&rows).for_each(fill);
    }
    plane_of(rows.len(), width, data)
}

/// Four samples of the image from which a new sample is computed, and their weights.
struct Tap {
    /// Indices of the four samples.
    at: [usize; 4],
    /// Catmull–Rom weights of the four samples.
    weights: [f32; 4],
}

/// Returns the taps of all new samples along a side of `length` px.
fn taps(length: usize, step: f64) -> Vec<Tap> {
    let count = ((length as f64 / step + 0.5).floor() as usize).max(1);
    (0..count)
        .map(|k| {
            let place = (k as f64 + 0.5) * step - 0.5;
            let first = place.floor();
            let t = place - first;
            let weights = [
                0.5 * t * (-1. + t * (2. - t)),
                1. + 0.5 * t * t * (-5. + 3. * t),
                0.5 * t * (1. + t * (4. - 3. * t)),
                0.5 * t * t * (t - 1.),
            ];
            let at = std::array::from_fn(|k| mirror(first as isize + k as isize - 1, length));
            Tap { at, weights: weights.map(|v| v as f32) }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_stays_a_plane_wherever_it_is_sampled() {
        let image = Plane::from_shape_fn((60, 80), |(y, x)| 3. + 0.5 * x as f32 - 0.25 * y as f32);
        for step in [0.5, 1., 1.7] {
            let new = resampled(&image, step);
            assert_eq!(new.ncols(), (80. / step + 0.5) as usize);
            let (i, j) = (new.ncols() / 2, new.nrows() / 3);
            let (x, y) = ((i as f64 + 0.5) * step - 0.5, (j as f64 + 0.5) * step - 0.5);
            assert!((f64::from(new[[j, i]]) - (3. + 0.5 * x - 0.25 * y)).abs() < 1e-3);
        }
    }

    #[test]
    fn neither_gain_nor_offset_changes_what_the_network_sees() {
        let image = Plane::from_shape_fn((50, 50), |(y, x)| (0.8 * x as f32).sin() + (0.7 * y as f32).cos());
        let other = image.mapv(|v| 40. * v + 7.);
        let difference = (normalised(&image) - normalised(&other)).iter().map(|v| v.abs()).fold(0., f32::max);
        assert!(difference < 1e-3);
    }
}
