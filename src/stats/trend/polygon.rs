//! Sums of orthonormal waves over the points in a polygon, and least-squares fits of polynomials.
//!
//! Cosine waves are orthogonal over a rectangle, but not over a polygon. The means of their
//! products are therefore integrated along the outline of the polygon (Green's theorem), and a
//! Cholesky decomposition of the resulting Gram matrix makes the waves orthonormal.

use super::waves::waves;
use crate::geometry::{Point, Polygon};
use crate::numeric::Cholesky;
use std::f64::consts::{PI, SQRT_2};

/// Number of pieces per shorter side of the polygon's bounds into which the outline is cut for
/// integrals along it.
///
/// On pieces of this length the waves vary slowly, so that Gauss's rule on each piece is exact to
/// rounding.
const PIECES: f64 = 16.;
/// Largest share of the mean square of a wave or polynomial that may be left, after its projections
/// on earlier ones are subtracted, for it to count as dependent on them.
///
/// Such a wave contributes nothing of its own, and dividing by so small a remainder would amplify
/// errors.
const LEAST_OWN: f64 = 1e-3;

/// Returns one value per group of waves: the mean, over its waves, of the squared sum of the wave
/// over the points.
///
/// Each mode (j, k) is the wave cos(jπu)·cos(kπv). In the order of `groups`, each wave is made
/// orthogonal to 1 and to the earlier waves, and scaled to mean square 1 over the polygon. Waves
/// that depend linearly on earlier ones are left out; a group without other waves has the value 0.
///
/// `unit` contains the points in coordinates (u, v) in which the polygon's bounds are the unit
/// square.
pub(super) fn mean_squares<const N: usize>(
    polygon: &Polygon,
    unit: &[(f64, f64)],
    groups: [&[(usize, usize)]; N],
) -> [f64; N] {
    let modes: Vec<(usize, usize)> =
        std::iter::once((0, 0)).chain(groups.iter().flat_map(|g| g.iter().copied())).collect();
    let most = modes.iter().map(|&(j, k)| j.max(k)).max().unwrap_or(0);
    let integrals = CosineIntegrals::new(polygon, 2 * most);
    let gram = |a: usize, b: usize| integrals.product(modes[a], modes[b]);
    let mut sums = vec![0.; modes.len()];
    let (mut across, mut down) = (vec![1.; most + 1], vec![1.; most + 1]);
    for &(u, v) in unit {
        waves(u, &mut across);
        waves(v, &mut down);
        for (sum, &(j, k)) in sums.iter_mut().zip(&modes) {
            *sum += across[j] * down[k];
        }
    }
    let factor = Cholesky::new(modes.len(), LEAST_OWN, gram);
    factor.forward(&mut sums);
    let mut first = 1;
    groups.map(|group| {
        // `own`: indices of the waves of this group that do not depend linearly on earlier waves.
        let own: Vec<usize> = (first..first + group.len()).filter(|&k| factor.is_own(k)).collect();
        first += group.len();
        own.iter().map(|&k| sums[k] * sums[k]).sum::<f64>() / own.len().max(1) as f64
    })
}

/// Returns the coefficients c of the function f = Σ c·term for which the mean of f·`terms[k]` over
/// the polygon is `means[k]`, for every k.
///
/// Terms are polynomials in coordinates (u, v) in which the polygon's bounds are the unit square,
/// and have degree at most 2 in u. Returns `None` if the terms are linearly dependent.
pub(super) fn least_squares<const N: usize>(
    polygon: &Polygon,
    terms: [impl Fn((f64, f64)) -> f64; N],
    means: [f64; N],
) -> Option<[f64; N]> {
    // The outline rule integrates ∂F/∂u, so F is needed: the integral of each product from 0 to u.
    // Products have degree 4 in u at most, for which Gauss's rule with 3 nodes is exact.
    // Nodes from −1 to 1, each with its weight.
    const GAUSS: [(f64, f64); 3] =
        [(-0.774_596_669_241_483_4, 5. / 9.), (0., 8. / 9.), (0.774_596_669_241_483_4, 5. / 9.)];
    let mut gram = [[0.; N]; N];
    for (u, v, weight) in rule(polygon) {
        for (at, share) in GAUSS {
            let values: [f64; N] = std::array::from_fn(|k| terms[k]((u * (1. + at) / 2., v)));
            for (row, a) in gram.iter_mut().zip(values) {
                for (entry, b) in row.iter_mut().zip(values) {
                    *entry += weight * u * share / 2. * a * b;
                }
            }
        }
    }
    let bounds = polygon.bounds();
    let area = polygon.area() / bounds.area();
    let factor = Cholesky::new(N, LEAST_OWN, |a, b| gram[a][b] / area);
    let mut solution = means;
    factor.forward(&mut solution);
    factor.backward(&mut solution);
    (0..N).all(|k| factor.is_own(k)).then_some(solution)
}

/// Returns points (u, v) on the outline with weights such that Σ weight · F(u, v) is the integral
/// of ∂F/∂u over the polygon (Green's theorem).
fn rule(polygon: &Polygon) -> impl Iterator<Item = (f64, f64, f64)> {
    let b = polygon.bounds();
    let nodes = polygon.boundary_rule(b.width().min(b.height()) / PIECES);
    let unit = move |p: Point| ((p.x - b.x0()) / b.width(), (p.y - b.y0()) / b.height());
    nodes.into_iter().map(move |(p, weight)| {
        let (u, v) = unit(p);
        (u, v, weight / b.height())
    })
}

/// Means of cos(aπu)·cos(bπv) over a polygon, for all integers a and b from 0 to `side` − 1.
struct CosineIntegrals {
    /// Number of values of a, and likewise of b.
    side: usize,
    /// Mean for a and b, at index a · `side` + b.
    means: Vec<f64>,
}

impl CosineIntegrals {
    /// Computes the means for a and b up to `most`, by integration along the outline.
    fn new(polygon: &Polygon, most: usize) -> Self {
        let side = most + 1;
        let mut means = vec![0.; side * side];
        let (mut along, mut down) = (vec![0.; side], vec![0.; side]);
        for (u, v, weight) in rule(polygon) {
            for k in 0..side {
                let frequency = k as f64 * PI;
                along[k] = weight * if k == 0 { u } else { (frequency * u).sin() / frequency };
                down[k] = (frequency * v).cos();
            }
            for (row, a) in means.chunks_exact_mut(side).zip(&along) {
                for (mean, b) in row.iter_mut().zip(&down) {
                    *mean += a * b;
                }
            }
        }
        let area = means[0];
        means.iter_mut().for_each(|mean| *mean /= area);
        Self { side, means }
    }

    /// Returns the mean over the polygon of the product of the waves (j, k) and (l, m).
    ///
    /// The wave (j, k) is cos(jπu)·cos(kπv), times √2 for each of j and k that is not 0. The
    /// product of two cosines is half the sum of the cosines of the difference and of the sum of
    /// their arguments.
    fn product(&self, (j, k): (usize, usize), (l, m): (usize, usize)) -> f64 {
        let norm = |k: usize| if k == 0 { 1. } else { SQRT_2 };
        let mean = |a: usize, b: usize| self.means[a * self.side + b];
        let four =
            [(j.abs_diff(l), k.abs_diff(m)), (j + l, k.abs_diff(m)), (j.abs_diff(l), k + m), (j + l, k + m)];
        let sum: f64 = four.iter().map(|&(a, b)| mean(a, b)).sum();
        norm(j) * norm(k) * norm(l) * norm(m) * sum / 4.
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn l_shape() -> Polygon {
        let corners = [(0., 0.), (2., 0.), (2., 0.4), (0.7, 0.4), (0.7, 1.), (0., 1.)];
        Polygon::new(vec![corners.iter().map(|&(x, y)| Point::new(x, y)).collect()]).unwrap()
    }

    #[test]
    fn integrals_along_the_outline_are_those_over_the_area() {
        let polygon = l_shape();
        let integrals = CosineIntegrals::new(&polygon, 8);
        let rectangle = |w: f64, h: f64, a: usize, b: usize| {
            let part = |k: usize, side: f64| {
                let frequency = k as f64 * PI;
                if k == 0 { side } else { (frequency * side).sin() / frequency }
            };
            part(a, w) * part(b, h)
        };
        let area = 0.4 + 0.35 * 0.6;
        for (a, b) in [(0, 0), (1, 0), (0, 3), (2, 5), (8, 8)] {
            // The L is a wide and a high rectangle minus their intersection, in units of its
            // bounds.
            let over_area = rectangle(1., 0.4, a, b) + rectangle(0.35, 1., a, b) - rectangle(0.35, 0.4, a, b);
            let found = integrals.means[a * 9 + b];
            assert!((found - over_area / area).abs() < 1e-12, "{a} {b}: {found}");
        }
    }

    #[test]
    fn a_plane_is_fitted_exactly() {
        let polygon = l_shape();
        let terms = [|_: (f64, f64)| 1., |(u, _): (f64, f64)| u, |(_, v): (f64, f64)| v];
        // Mean products of 1 + 2u − v with the terms follow from the mean products of the terms
        // with each other.
        let gram = |a: usize, b: usize| {
            let sums = rule(&polygon).map(|(u, v, w)| {
                let u_power = i32::from(a == 1) + i32::from(b == 1);
                let v_power = i32::from(a == 2) + i32::from(b == 2);
                w * u.powi(u_power + 1) / f64::from(u_power + 1) * v.powi(v_power)
            });
            sums.sum::<f64>() / (polygon.area() / polygon.bounds().area())
        };
        let means = [0, 1, 2].map(|a| gram(a, 0) + 2. * gram(a, 1) - gram(a, 2));
        let found = least_squares(&polygon, terms, means).unwrap();
        for (c, expected) in found.iter().zip([1., 2., -1.]) {
            assert!((c - expected).abs() < 1e-9, "{found:?}");
        }
    }
}
