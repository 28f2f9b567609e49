//! Quadratic fit of the density by Legendre polynomials.

use super::polygon;
use crate::geometry::Polygon;

/// Lower bound on the fitted density when the ratio of densities is computed, as a share of the
/// largest density. Below it, the ratio would mean nothing.
const LEAST_SHARE: f64 = 0.01;

/// Density divided by its mean, fitted in the unit square: 1 + Σ c P_j(2x−1) P_k(2y−1) with
/// Legendre polynomials P and 1 ≤ j + k ≤ 2.
pub(super) struct DensityFit {
    /// Coefficients of the six terms, in the order of their highest powers: 1, x, y, x², xy, y².
    pub(super) coefficients: [f64; 6],
}

impl DensityFit {
    /// Degrees (j, k) of the six terms.
    const DEGREES: [(i32, i32); 6] = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)];

    /// Returns the value of the term of degrees (j, k) at (u, v) in the unit square.
    fn term((j, k): (i32, i32), (u, v): (f64, f64)) -> f64 {
        let legendre = |degree: i32, t: f64| match degree {
            0 => 1.,
            1 => t,
            _ => 1.5 * t * t - 0.5,
        };
        legendre(j, 2. * u - 1.) * legendre(k, 2. * v - 1.)
    }

    /// Fits the density of points of the unit square, over which the terms are orthogonal.
    pub(super) fn new(unit: &[(f64, f64)]) -> Self {
        let coefficients = Self::DEGREES.map(|(j, k)| {
            let norm = f64::from((2 * j + 1) * (2 * k + 1));
            norm * unit.iter().map(|&at| Self::term((j, k), at)).sum::<f64>() / unit.len() as f64
        });
        Self { coefficients }
    }

    /// Fits the density of points of a polygon by least squares, because the terms are not
    /// orthogonal over a polygon.
    ///
    /// `unit` holds the points in coordinates in which the polygon's bounds are the unit square. If
    /// the least-squares problem has no unique solution, the fit is constant.
    pub(super) fn within(polygon: &Polygon, unit: &[(f64, f64)]) -> Self {
        let means =
            Self::DEGREES.map(|d| unit.iter().map(|&at| Self::term(d, at)).sum::<f64>() / unit.len() as f64);
        let fitted =
            polygon::least_squares(polygon, Self::DEGREES.map(|d| move |at| Self::term(d, at)), means);
        Self { coefficients: fitted.unwrap_or([1., 0., 0., 0., 0., 0.]) }
    }

    /// Returns the ratio of the largest to the smallest fitted density, at most 100, over the
    /// places of a grid for which `inside` is true.
    pub(super) fn ratio(&self, inside: impl Fn((f64, f64)) -> bool) -> f64 {
        let steps = 32;
        let (mut least, mut greatest) = (f64::INFINITY, 0f64);
        for (i, j) in (0..=steps).flat_map(|i| (0..=steps).map(move |j| (i, j))) {
            let at = (f64::from(i) / f64::from(steps), f64::from(j) / f64::from(steps));
            if !inside(at) {
                continue;
            }
            let density: f64 =
                Self::DEGREES.iter().zip(&self.coefficients).map(|(&d, c)| c * Self::term(d, at)).sum();
            least = least.min(density);
            greatest = greatest.max(density);
        }
        // A polygon may be so thin that no place of the grid is inside.
        if greatest <= 0. { 1. } else { greatest / least.max(LEAST_SHARE * greatest) }
    }
}
