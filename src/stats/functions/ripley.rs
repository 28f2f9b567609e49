//! Ripley's K and the pair correlation function g, with several edge corrections.
//!
//! 1. Visit all pairs up to the largest r (for g, plus the half-width of its kernel), in parts that
//!    may run in parallel.
//! 2. Add the weights of each pair to the first row of a table, with one row per r, whose r is at
//!    least the distance of the pair.
//! 3. Sum the rows up to each r and divide by the expected number of pairs.

use super::kernel_pcf::{Binned, PcfCurves};
use super::{first_at_least, settle};
use crate::geometry::{Point, Window};
use crate::stats::edge_weight::EdgeWeights;
use crate::stats::pairs::PairGrid;
use rayon::prelude::*;

/// Number of parts into which a large pattern is split.
///
/// Parts may run in parallel, but their sums are added in a fixed order. The number is fixed too,
/// so that the result does not depend on the number of threads.
const CHUNKS: usize = 32;
/// Smallest number of points for which a pattern is split into [`CHUNKS`] parts; smaller patterns
/// are summed on one thread.
const CHUNKED_FROM: usize = 2048;

/// K and g at a series of distances r, with several edge corrections.
///
/// K(r) is the number of ordered pairs up to distance r, weighted by the edge correction and
/// divided by λ²A, for n points of density λ in a window of area A. Here λ² is estimated by
/// n(n−1)/A².
///
/// The border correction is an exception. It counts only pairs whose first point is at least r from
/// the border, and divides them by λ and by the number of such points, with λ = n/A.
///
/// Sources: K of Ripley (1977), <https://doi.org/10.1111/j.2517-6161.1977.tb01615.x>; translation
/// correction of Ohser & Stoyan (1981), <https://doi.org/10.1002/bimj.4710230602>; isotropic
/// correction of Ripley (1976), <https://doi.org/10.2307/3212829>.
#[derive(Clone, Debug)]
pub(super) struct Ripley {
    /// K without edge correction.
    pub none: Vec<f64>,
    /// K with the border correction; NaN where no point is at least r from the border.
    pub border: Vec<f64>,
    /// K with the translation correction.
    pub translation: Vec<f64>,
    /// K with the isotropic correction.
    pub isotropic: Vec<f64>,
    /// g with the translation correction.
    pub g_translation: PcfCurves,
    /// g with the isotropic correction.
    pub g_isotropic: PcfCurves,
}

/// Sums over the pairs of one part of the pattern, one row per distance r.
///
/// A pair counts in the first row whose r is at least the distance of the pair.
struct Sums {
    /// Sums of pair weights per row: without correction, with translation and with isotropic
    /// correction.
    k: Vec<[f64; 3]>,
    /// Number of ordered pairs for the border correction, as differences from row to row.
    ///
    /// Row r needs the pairs up to distance r whose first point is at least r from the border. A
    /// pair therefore adds 1 in the first row whose r is at least its distance. It subtracts 1 in
    /// the first row whose r exceeds the distance of its first point to the border.
    border: Vec<i64>,
    /// Pair distances and weights for g.
    g: Binned,
}

impl Ripley {
    /// Computes the functions of at least two points, all inside the window.
    ///
    /// `borders` contains the distance of every point to the border, and `r` the distances at which
    /// the functions are evaluated. The pair correlation function g is computed only if `with_g` is
    /// `true`, because it needs a wider search; its values mean nothing otherwise.
    pub(super) fn new(points: &[Point], borders: &[f64], window: &Window, r: &[f64], with_g: bool) -> Self {
        let (n, area, rows) = (points.len(), window.area(), r.len());
        let density = n as f64 / area;
        let empty = Binned::new(r[rows - 1], density);
        let torus = window.is_torus();
        let reach = r[rows - 1] + if with_g { empty.half_width() } else { 0. };
        let per_step = r.get(1).map_or(0., |step| step.recip());
        let grid = PairGrid::new(points, window, torus, reach);
        let weights = EdgeWeights::new(window);
        // For each point, in the order in which the grid sorts them: the number of rows whose r is
        // at most the distance to the border.
        let borders = grid.sorted(borders);
        let seen_from: Vec<usize> = borders.iter().map(|&b| rows_up_to(r, b)).collect();
        let chunks = if n < CHUNKED_FROM { 1 } else { CHUNKS.min(grid.rows()) };
        let sums_of = |chunk: usize| {
            let part = chunk * grid.rows() / chunks..(chunk + 1) * grid.rows() / chunks;
            let mut sums = Sums { k: vec![[0.; 3]; rows], border: vec![0; rows + 1], g: empty.clone() };
            grid.visit(part, |i, j, dx, dy| {
                let d = (dx * dx + dy * dy).sqrt();
                let translation = if torus { 1. } else { weights.translation(dx, dy) };
                // Circles that do not cross the border have weight 1; this saves computing their
                // arcs.
                let isotropic = if borders[i] >= d && borders[j] >= d {
                    1.
                } else {
                    let from = grid.point(i);
                    weights.isotropic(from, Point::new(from.x + dx, from.y + dy), d)
                };
                // A pair was visited once and counts in both orders.
                if with_g {
                    sums.g.add(d, 2. * translation, 2. * isotropic);
                }
                let at = settle(r, (d * per_step) as usize, d);
                let Some(k) = sums.k.get_mut(at) else { return };
                *k = [k[0] + 2., k[1] + 2. * translation, k[2] + 2. * isotropic];
                let ends = [seen_from[i], seen_from[j]];
                // If both points are farther from the border than the last r, nothing has to be
                // subtracted.
                if ends == [rows; 2] {
                    sums.border[at] += 2;
                    return;
                }
                for end in ends {
                    if at < end {
                        sums.border[at] += 1;
                        sums.border[end] -= 1;
                    }
                }
            });
            sums
        };
        let parts: Vec<Sums> =
            if chunks > 1 { (0..chunks).into_par_iter().map(sums_of).collect() } else { vec![sums_of(0)] };

        let per_pair = area / (n as f64 * (n - 1) as f64);
        let cumulated = |at_row: &dyn Fn(&Sums, usize) -> f64| {
            let mut sum = 0.;
            let mut up_to = |k| {
                sum += parts.iter().map(|s| at_row(s, k)).sum::<f64>();
                sum
            };
            (0..rows).map(&mut up_to).collect::<Vec<f64>>()
        };
        let k_of = |at_row: &dyn Fn(&Sums, usize) -> f64| {
            cumulated(at_row).into_iter().map(|pairs| pairs * per_pair).collect::<Vec<f64>>()
        };
        let mut ends = vec![0usize; rows + 1];
        for &end in &seen_from {
            ends[end] += 1;
        }
        let mut left = n;
        let border = cumulated(&|s, k| s.border[k] as f64)
            .into_iter()
            .enumerate()
            .map(|(k, pairs)| {
                left -= ends[k];
                if left > 0 { pairs / (density * left as f64) } else { f64::NAN }
            })
            .collect();
        let mut g = empty;
        parts.iter().for_each(|part| g.merge(&part.g));
        let [g_translation, g_isotropic] = g.curves(r, per_pair);
        Self {
            none: k_of(&|s, k| s.k[k][0]),
            border,
            translation: k_of(&|s, k| s.k[k][1]),
            isotropic: k_of(&|s, k| s.k[k][2]),
            g_translation,
            g_isotropic,
        }
    }
}

/// Returns the number of entries of `r` that are at most `b`.
fn rows_up_to(r: &[f64], b: f64) -> usize {
    let k = first_at_least(r, b);
    if k < r.len() && r[k] <= b { k + 1 } else { k }
}
