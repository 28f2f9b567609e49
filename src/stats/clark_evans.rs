//! Aggregation index of Clark and Evans, with two corrections for the border of the window.

use super::functions::FirstDistance;
use crate::geometry::{NearestNeighbours, Window};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Number of distances at which the distribution G of nearest-neighbour distances is evaluated for
/// [`ClarkEvans::cdf`], as in spatstat, so that values can be compared digit by digit.
const ROWS: usize = 513;

/// Aggregation index of Clark & Evans (1954), <https://doi.org/10.2307/1931034>.
///
/// The index is the mean nearest-neighbour distance divided by the mean expected for independent
/// points of the same density λ, which is 1/(2√λ). The index is 1 for independent points and 2.149
/// for the triangular lattice. All values are `None` for fewer than two points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ClarkEvans {
    /// Index of all points without correction for the border. It is too large, because neighbours
    /// beyond the border are not seen.
    pub naive: Option<f64>,
    /// Index of Donnelly (1978): the mean nearest-neighbour distance divided by an expected mean
    /// that is corrected for the border, 1/(2√λ) + (.0514 + .0412/√n) · perimeter/n for n points.
    ///
    /// Donnelly found the correction by simulation in rectangles. In polygons, for which spatstat
    /// gives no value, the correction is an approximation. `None` on a torus.
    pub donnelly: Option<f64>,
    /// Index from the mean of the Kaplan–Meier estimate of G, the distribution of nearest-neighbour
    /// distances.
    ///
    /// G is evaluated at 513 distances from 0 to √(ln 10⁵/(πλ)), where G of independent points is 1
    /// − 10⁻⁵. Its rise between two distances counts at the smaller of the two, as in spatstat.
    /// Also `None` if no point is at least as far from the border as from its nearest neighbour.
    pub cdf: Option<f64>,
}

/// Computes the index with each correction; `borders` are the distances of all points to the
/// border.
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
