//! Random fields for simulated images: slow fields for uneven light, and textures for grain.

use crate::image::Plane;
use ndarray::Array2;
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

/// Draws a standard normal deviate.
pub(super) fn normal(rng: &mut dyn Rng) -> f64 {
    StandardNormal.sample(rng)
}

/// Smooth Gaussian random field of mean 0 and variance 1.
///
/// It is a sum of cubic B-splines, whose coefficients at the knots are random, so its cost does not
/// grow with its correlation length.
pub(super) struct SlowField {
    /// Coefficients of the splines: independent standard normal values, one per knot.
    knots: Array2<f64>,
    /// Distance between neighbouring knots, in px.
    cell: f64,
}

impl SlowField {
    /// Creates a field over an image of `width` × `height` px, with knots every `cell` px (at least
    /// 1).
    pub(super) fn new(width: usize, height: usize, cell: f64, rng: &mut dyn Rng) -> Self {
        let cell = cell.max(1.);
        // every position, up to the last pixel, needs four knots
        let knots = |side: usize| (side as f64 / cell).ceil() as usize + 4;
        let mut values = Array2::zeros((knots(height), knots(width)));
        values.iter_mut().for_each(|v| *v = normal(rng));
        Self { knots: values, cell }
    }

    /// Returns the field at (x, y), in px; beyond the image, the value at the border is returned.
    pub(super) fn at(&self, x: f64, y: f64) -> f64 {
        let (rows, columns) = self.knots.dim();
        self.sum(&Knots::around(x / self.cell, columns), &Knots::around(y / self.cell, rows))
    }

    /// Returns the field at every pixel of an image of `width` × `height` px.
    pub(super) fn plane(&self, width: usize, height: usize) -> Plane {
        let (rows, columns) = self.knots.dim();
        let across: Vec<Knots> = (0..width).map(|x| Knots::around(x as f64 / self.cell, columns)).collect();
        let down: Vec<Knots> = (0..height).map(|y| Knots::around(y as f64 / self.cell, rows)).collect();
        Plane::from_shape_fn((height, width), |(y, x)| self.sum(&across[x], &down[y]) as f32)
    }

    fn sum(&self, x: &Knots, y: &Knots) -> f64 {
        let mut sum = 0.;
        for (j, b) in y.weights.iter().enumerate() {
            let mut row = 0.;
            for (i, a) in x.weights.iter().enumerate() {
                row += a * self.knots[[y.first + j, x.first + i]];
            }
            sum += b * row;
        }
        sum
    }
}

/// Four successive knots along one axis that determine the field at a position, with their weights.
struct Knots {
    /// Index of the first of the four knots.
    first: usize,
    weights: [f64; 4],
}

impl Knots {
    /// Returns the knots around position `at` on an axis with `knots` knots; `at` is in distances
    /// between knots.
    fn around(at: f64, knots: usize) -> Self {
        let at = at.clamp(0., (knots - 4) as f64);
        let mut weights = cubic_b_spline(at.fract());
        // Between knots the variance of a sum of splines drops. Dividing by its square root makes
        // the field equally strong everywhere.
        let deviation = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
        weights.iter_mut().for_each(|w| *w /= deviation);
        Self { first: at as usize, weights }
    }
}

/// Returns the weights of four successive knots at a position between the middle two.
///
/// `t` is the distance from the second knot as a fraction of the distance between knots.
fn cubic_b_spline(t: f64) -> [f64; 4] {
    let u = 1. - t;
    [
        u * u * u / 6.,
        (3. * t * t * t - 6. * t * t + 4.) / 6.,
        (3. * u * u * u - 6. * u * u + 4.) / 6.,
        t * t * t / 6.,
    ]
}

/// Makes white noise smoothed by a Gaussian of standard deviation `sigma` px, scaled back to
/// variance 1.
pub(super) fn texture(width: usize, height: usize, sigma: f64, rng: &mut dyn Rng) -> Plane {
    let mut plane = Plane::zeros((height, width));
    plane.iter_mut().for_each(|v| *v = normal(rng) as f32);
    let mut plane = smooth(&plane, sigma);
    let gain = 1. / smoothed_deviation(sigma) as f32;
    plane.mapv_inplace(|v| v * gain);
    plane
}

/// Returns the factor by which [`smooth`] reduces the standard deviation of white noise.
pub(super) fn smoothed_deviation(sigma: f64) -> f64 {
    // The weight of a pixel is the product w_i w_j of two weights along the axes, so the square
    // root of the sum of all squares is Σ w².
    gaussian(sigma).iter().map(|&w| f64::from(w).powi(2)).sum()
}

/// Convolves with a Gaussian of standard deviation `sigma` px; the image is mirrored at its border.
pub(super) fn smooth(plane: &Plane, sigma: f64) -> Plane {
    if sigma < NARROWEST { plane.clone() } else { crate::image::gaussian(plane, sigma) }
}

/// Smallest standard deviation, in px, of a Gaussian that is applied. A narrower one has fallen to
/// 2·10⁻¹⁰ at the next pixel, so it changes nothing.
const NARROWEST: f64 = 0.15;

/// Returns samples of a Gaussian with sum 1, from −⌈4σ⌉ to ⌈4σ⌉, where it has fallen to 0.03 % of
/// its peak.
///
/// If σ is too small for the Gaussian to extend to the next pixel, the only sample is 1.
fn gaussian(sigma: f64) -> Vec<f32> {
    if sigma < NARROWEST {
        return vec![1.];
    }
    let radius = (4. * sigma).ceil() as i32;
    let weights: Vec<f64> =
        (-radius..=radius).map(|i| (-0.5 * (f64::from(i) / sigma).powi(2)).exp()).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|w| (w / sum) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn mean_and_deviation(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
        let n = values.clone().count() as f64;
        let mean = values.clone().sum::<f64>() / n;
        (mean, (values.map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt())
    }

    #[test]
    fn slow_field_has_variance_one_and_is_smooth() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let field = SlowField::new(400, 400, 8., &mut rng);
        let places = (0..400).flat_map(|y| (0..400).map(move |x| (f64::from(x), f64::from(y))));
        let (mean, sd) = mean_and_deviation(places.clone().map(|(x, y)| field.at(x, y)));
        assert!(mean.abs() < 0.1 && (sd - 1.).abs() < 0.1, "{mean} {sd}");
        let (_, step) = mean_and_deviation(places.map(|(x, y)| field.at(x + 1., y) - field.at(x, y)));
        assert!(step < 0.2, "{step}");
    }

    #[test]
    fn texture_has_variance_one_whatever_its_grain() {
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        for sigma in [0., 0.6, 2.] {
            let plane = texture(256, 256, sigma, &mut rng);
            let (_, sd) = mean_and_deviation(plane.iter().map(|&v| f64::from(v)));
            assert!((sd - 1.).abs() < 0.06, "σ = {sigma}: {sd}");
        }
    }

    #[test]
    fn smoothing_keeps_a_constant_and_spreads_a_point_as_a_gaussian() {
        let flat = smooth(&Plane::from_elem((5, 3), 0.7), 2.);
        assert!(flat.iter().all(|v| (v - 0.7).abs() < 1e-6));
        let mut point = Plane::zeros((41, 41));
        point[[20, 20]] = 1.;
        let spread = smooth(&point, 2.);
        let ratio = spread[[20, 22]] / spread[[20, 20]];
        assert!((ratio - (-0.5f32).exp()).abs() < 1e-5, "{ratio}");
    }
}
