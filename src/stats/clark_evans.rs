//! Aggregation index of Clark and Evans, with two corrections for the border of the window.

use super::functions::FirstDistance;
use crate::geometry::{NearestNeighbours, Window};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Number of distances at which G is taken for the cdf rule, as in spatstat.
const ROWS: usize = 513;

/// Aggregation index of Clark & Evans (1954), <https://doi.org/10.2307/1931034>.
///
/// It is the mean nearest-neighbour distance divided by that of independent points of the same
/// density, 1/(2√λ): 1 for independent points, 2.149 for the triangular lattice. All values are
/// `None` for fewer than two points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ClarkEvans {
    /// Index of all points without correction: too large, because neighbours beyond the border are
    /// not seen.
    pub naive: Option<f64>,
    /// Index by Donnelly (1978): the expectation is corrected for the border,
    /// 1/(2√λ) + (.0514 + .0412/√n) · perimeter/n.
    ///
    /// Donnelly found the correction by simulation in rectangles. In polygons, where spatstat gives
    /// none, it is an approximation. `None` on a torus.
    pub donnelly: Option<f64>,
    /// Index from the mean of the Kaplan–Meier estimate of G.
    ///
    /// G is taken at 513 distances from 0 to √(ln 10⁵/(πλ)), and each step of it counts at its left
    /// end. Also `None` if no point is nearer to its neighbour than to the border.
    pub cdf: Option<f64>,
}

/// Computes the index; `borders` are the distances of all points to the border.
pub(super) fn clark_evans(window: &Window, nearest: &NearestNeighbours, borders: &[f64]) -> ClarkEvans {
    let n = nearest.distances.len() as f64;
    if nearest.distances.is_empty() {
        return ClarkEvans::default();
    }
    let density = n / window.area();
    let expected = 0.5 / density.sqrt();
    let mean = nearest.distances.iter().sum::<f64>() / n;
    let r_max = (1e5f64.ln() / (PI * density)).sqrt();
    let r: Vec<f64> = (0..ROWS).map(|k| k as f64 * r_max / (ROWS - 1) as f64).collect();
    let g = FirstDistance::new(&nearest.distances, borders, &r, |_| 1.).kaplan_meier;
    let (mut sum, mut total) = (0., 0.);
    for k in 1..ROWS {
        let step = g[k] - g[k - 1];
        sum += r[k - 1] * step;
        total += step;
    }
    ClarkEvans {
        naive: Some(mean / expected),
        donnelly: (!window.is_torus())
            .then(|| mean / (expected + (0.0514 + 0.0412 / n.sqrt()) * window.perimeter() / n)),
        cdf: (total > 0.).then(|| sum / total / expected),
    }
}
