//! Quadratic fit of the density by Legendre polynomials.

use super::polygon;
use crate::geometry::Polygon;

/// Lower bound on the smallest fitted density when the ratio of densities is computed, as a share
/// of the largest fitted density.
///
/// It bounds the ratio to 100. A quadratic fit may fall to 0 or below, where a ratio would mean
/// nothing.
const LEAST_SHARE: f64 = 0.01;

/// Fitted density divided by its mean: Σ c P_j(2u−1) P_k(2v−1) over the six pairs of degrees j + k
/// ≤ 2, with Legendre polynomials P.
///
/// The fit is made in coordinates (u, v) in which the bounds of the window are the unit square.
pub(super) struct DensityFit {
    /// Coefficients c of the six terms, in the order of [`Self::DEGREES`]: constant, u, v, u², uv,
    /// v².
    pub(super) coefficients: [f64; 6],
}

impl DensityFit {
    /// Degrees (j, k) of the six terms: all with j + k ≤ 2, which describe any quadratic surface.
    const DEGREES: [(i32, i32); 6] = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)];

    /// Returns the value of the term P_j(2u−1) P_k(2v−1) at (u, v) in the unit square.
    fn term((j, k): (i32, i32), (u, v): (f64, f64)) -> f64 {
        let legendre = |degree: i32, t: f64| match degree {
            0 => 1.,
            1 => t,
            _ => 1.5 * t * t - 0.5,
        };
        legendre(j, 2. * u - 1.) * legendre(k, 2. * v - 1.)
    }

    /// Fits the density of points in the unit square, over which the terms are orthogonal.
    ///
    /// Each coefficient is therefore the mean of its term over the points, times (2j + 1)(2k + 1).
    pub(super) fn new(unit: &[(f64, f64)]) -> Self {
        let coefficients = Self::DEGREES.map(|(j, k)| {
            let norm = f64::from((2 * j + 1) * (2 * k + 1));
            norm * unit.iter().map(|&at| Self::term((j, k), at)).sum::<f64>() / unit.len() as f64
        });
        Self { coefficients }
    }

    /// Fits the density of points in a polygon by least squares, because the terms are not
    /// orthogonal over a polygon.
    ///
    /// `unit` contains the points in coordinates in which the polygon's bounds are the unit square.
    /// If the least-squares problem has no unique solution, the fit is constant.
    pub(super) fn within(polygon: &Polygon, unit: &[(f64, f64)]) -> Self {
        let means =
            Self::DEGREES.map(|d| unit.iter().map(|&at| Self::term(d, at)).sum::<f64>() / unit.len() as f64);
        let fitted =
            polygon::least_squares(polygon, Self::DEGREES.map(|d| move |at| Self::term(d, at)), means);
        Self { coefficients: fitted.unwrap_or([1., 0., 0., 0., 0., 0.]) }
    }

    /// Returns the ratio of the largest to the smallest fitted density, at most 100.
    ///
    /// Both are sought on a grid of 33 × 33 points that covers the unit square. Only the grid
    /// points for which `inside` is true count.
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
        // A polygon may be so thin that no grid point is inside.
        if greatest <= 0. { 1. } else { greatest / least.max(LEAST_SHARE * greatest) }
    }
}
