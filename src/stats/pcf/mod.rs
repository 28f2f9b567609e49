//! Pair correlation function g(r) of a stationary pattern, with several edge corrections.
//!
//! 1. Visit all pairs of points up to the largest distance from which the kernel extends to a bin,
//!    and weight each pair to compensate for pairs that the border hides.
//! 2. Collect the distances in a fine histogram and smooth it with the kernel (see `smoother`).
//! 3. Divide by the value expected for independent points of the same density.

use crate::choice::UnknownChoice;
mod smoother;

use super::StatsError;
use super::edge_weight::EdgeWeights;
use super::error::all_inside;
use super::pairs::PairGrid;
use crate::geometry::{Point, Window};
use crate::mosaic::hexagonal_spacing;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
pub use smoother::Kernel;
pub(super) use smoother::Smoother;
use std::f64::consts::TAU;
use strum::{Display, EnumString, VariantArray, VariantNames};

/// Rule that compensates for pairs of which one point lies beyond the border and is not seen.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    Display,
    EnumString,
    VariantArray,
    VariantNames,
)]
#[serde(rename_all = "snake_case")]
#[strum(
    serialize_all = "kebab-case",
    parse_err_ty = UnknownChoice,
    parse_err_fn = UnknownChoice::among::<EdgeCorrection>
)]
pub enum EdgeCorrection {
    /// Division of the sum over pairs at distance r by c(r), the isotropised set covariance of the
    /// window.
    ///
    /// c(r) is the area of W ∩ (W + Δ) divided by the area of W, averaged over all directions of
    /// the shift Δ of length r, where W is the window. In a w × h rectangle, c(r) is 1 −
    /// 2r(w+h)/(πwh) + r²/(πwh). At distances beyond the shorter side, where this formula is not
    /// valid, translation weights are used instead.
    ///
    /// In a polygon, c(r) is computed by [`crate::geometry::SetCovariance`] and taken as at least
    /// .01. On a torus, this choice is replaced by [`EdgeCorrection::Torus`].
    #[default]
    SetCovariance,
    /// Weight of each pair: |W| / |W ∩ (W + Δ)|, at most 100. Here |·| is the area, W the window
    /// and Δ the vector between the two points.
    ///
    /// In a w × h rectangle this is wh/((w−|Δx|)(h−|Δy|)); in a polygon it is within 2 · 10⁻³ of
    /// the exact value. Source: Ohser & Stoyan (1981), <https://doi.org/10.1002/bimj.4710230602>.
    Translation,
    /// Weight of each pair: the inverse of the share of a circle that lies in the window. The
    /// circle is centred on one point of the pair and passes through the other.
    ///
    /// There are two such circles, one around each point. The weight of the pair is the mean of
    /// both inverse shares, each bounded to 100. Source: Ripley (1976),
    /// <https://doi.org/10.2307/3212829>.
    Isotropic,
    /// Pairing of points with the periodic images of other points, so that no pair is hidden. For
    /// torus windows only.
    Torus,
    /// No correction, so that g falls with r.
    None,
}

/// Options for estimating the pair correlation function.
///
/// Lengths are in hexagonal spacings of the pattern: s = √(2/(√3 λ)) for the density λ.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PcfOptions {
    /// Shape of the smoothing kernel.
    pub kernel: Kernel,
    /// Standard deviation σ of the kernel, in hexagonal spacings: .005–1, default .1.
    ///
    /// The distances between samplers that Lanaro et al. (2020) printed are consistent with σ from
    /// .10 to .12 only.
    pub bandwidth: f64,
    /// Left edge of the first bin, in hexagonal spacings: at most 50, default .15. It must be at
    /// least 1.5 `bandwidth`, because nearer to 0 the kernel extends to negative distances.
    pub r_min: f64,
    /// Right edge of the last bin, in hexagonal spacings: above `r_min`, at most 50, default 2.5.
    pub r_max: f64,
    /// Number of bins: 1–2000, default 200. g is evaluated at the left edges of the bins.
    pub bins: usize,
    /// Edge correction: compensation for the pairs that the border hides.
    pub edge: EdgeCorrection,
}

impl Default for PcfOptions {
    fn default() -> Self {
        Self {
            kernel: Kernel::Gaussian,
            bandwidth: 0.1,
            r_min: 0.15,
            r_max: 2.5,
            bins: 200,
            edge: EdgeCorrection::SetCovariance,
        }
    }
}

impl PcfOptions {
    /// Checks that every option is in its range.
    ///
    /// # Errors
    /// Fails if an option is out of its range; the error names the permitted range.
    pub fn validate(&self) -> Result<(), StatsError> {
        let check = |ok: bool, option, value, range| {
            if ok { Ok(()) } else { Err(StatsError::Option { option, value, range }) }
        };
        // Rounding must not refuse a value at exactly the lower limit, such as .15 for 1.5 × .1.
        let in_range = |v: f64, low: f64, high: f64| v >= low * (1. - 1e-9) && v <= high;
        check(in_range(self.bandwidth, 0.005, 1.), "PCF bandwidth", self.bandwidth, "0.005 to 1 spacings")?;
        check(
            in_range(self.r_min, 1.5 * self.bandwidth, 50.),
            "PCF r_min",
            self.r_min,
            "at least 1.5 bandwidths, at most 50 spacings",
        )?;
        check(
            in_range(self.r_max, self.r_min, 50.) && self.r_max > self.r_min,
            "PCF r_max",
            self.r_max,
            "above r_min, at most 50 spacings",
        )?;
        check((1..=2000).contains(&self.bins), "number of PCF bins", self.bins as f64, "1 to 2000")
    }

    /// Returns the left edges of the bins, in hexagonal spacings.
    pub fn radii(&self) -> Vec<f64> {
        (0..self.bins).map(|b| self.r_min + b as f64 * self.bin_width()).collect()
    }

    /// Returns the width of a bin, in hexagonal spacings.
    fn bin_width(&self) -> f64 {
        (self.r_max - self.r_min) / self.bins as f64
    }
}

/// Pair correlation function of a pattern, and the options with which it was estimated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pcf {
    /// Distances at which g is evaluated, in hexagonal spacings of the pattern.
    pub r: Vec<f64>,
    /// Values of g at the distances `r`; 1 for independent points.
    pub g: Vec<f64>,
    /// Hexagonal spacing of the pattern, in the unit of the coordinates.
    pub spacing: f64,
    /// Options that were used. On a torus, [`EdgeCorrection::SetCovariance`] has been replaced by
    /// [`EdgeCorrection::Torus`].
    pub options: PcfOptions,
}

/// Estimates the pair correlation function of a stationary pattern.
///
/// g(r) = A Σ_{i≠j} k_σ(r − |x_i − x_j|) / (n (n−1) · 2πr · c(r)), with A the area of the window, n
/// the number of points x_i, k_σ the kernel and c(r) the edge correction.
///
/// With the Gaussian kernel, distances are collected in a histogram whose bins are at most σ/24
/// wide. Each distance is spread over four bins by cubic interpolation, and the histogram is then
/// smoothed. The time is linear in n, and the result is within 10⁻⁷ of the sum over pairs. Large
/// patterns use all threads, with the same result for any number of them.
///
/// Sources: Öztireli & Gross (2012), <https://doi.org/10.1145/2366145.2366189>; Illian et al.
/// (2008), <https://doi.org/10.1002/9780470725160>.
///
/// # Errors
/// Fails if an option is out of range, there are fewer than two points, a point is not inside the
/// window, or the torus correction is requested for a window that is no torus.
///
/// # Examples
/// ```
/// use conemosaic::prelude::*;
///
/// let window = Window::rectangle(0., 0., 10., 10.)?;
/// let lattice = |i: usize| Point::new((i % 10) as f64 + 0.5, (i / 10) as f64 + 0.5);
/// let points: Vec<Point> = (0..100).map(lattice).collect();
///
/// let found = pcf(&points, &window, &PcfOptions::default())?;
/// let (r, g) = (found.options.radii(), &found.g); // r in hexagonal spacings
/// let highest = (0..g.len()).max_by(|&a, &b| g[a].total_cmp(&g[b])).ok_or("no bins")?;
/// // a square lattice of side 1 has a hexagonal spacing of 1.075
/// assert!((r[highest] - 1. / 1.075).abs() < 0.05);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn pcf(points: &[Point], window: &Window, options: &PcfOptions) -> Result<Pcf, StatsError> {
    estimate(points, window, options, true)
}

/// Estimates the pair correlation function as [`pcf`] does, but never hands work to another thread.
pub(crate) fn pcf_on_one_thread(
    points: &[Point],
    window: &Window,
    options: &PcfOptions,
) -> Result<Pcf, StatsError> {
    estimate(points, window, options, false)
}

/// Smallest number of points for which the work is split into [`CHUNKS`] parts that may run in
/// parallel.
const CHUNKED_FROM: usize = 8192;
/// Number of parts into which a large pattern is split.
///
/// It is fixed, so that the order of the sums, and hence their rounding, does not depend on the
/// number of threads.
const CHUNKS: usize = 32;
/// Largest permitted ratio of the search distance to the shorter side of a torus. Higher ratios are
/// refused, because the search would go around the torus a thousand times for every point.
const MAX_TURNS: f64 = 1000.;

/// Estimates g, in parallel if `parallel` is `true` and the pattern has at least [`CHUNKED_FROM`]
/// points.
fn estimate(
    points: &[Point],
    window: &Window,
    options: &PcfOptions,
    parallel: bool,
) -> Result<Pcf, StatsError> {
    options.validate()?;
    let n = points.len();
    let bounds = window.bounds();
    let (w, h, area) = (bounds.width(), bounds.height(), window.area());
    let spacing = match hexagonal_spacing(n, area) {
        Some(spacing) if n > 1 => spacing,
        _ => {
            let statistic = "the pair correlation function";
            return Err(StatsError::TooFewPoints { statistic, needed: 2, found: n });
        }
    };
    all_inside(points, window)?;
    let mut options = *options;
    if window.is_torus() && options.edge == EdgeCorrection::SetCovariance {
        options.edge = EdgeCorrection::Torus;
    }
    let torus = options.edge == EdgeCorrection::Torus;
    if torus && !window.is_torus() {
        return Err(StatsError::NotATorus);
    }
    let reach = spacing * (options.r_max + options.kernel.reach() * options.bandwidth);
    let turns = reach / w.min(h);
    if torus && turns > MAX_TURNS {
        let range = "at most 1000, so the window is too thin for its few points";
        return Err(StatsError::Option { option: "r_max in turns around the torus", value: turns, range });
    }

    let weights = EdgeWeights::new(window);
    // Largest distance at which the formula of the set covariance is valid.
    let covered = weights.covariance_reach();
    let grid = PairGrid::new(points, window, torus, reach);
    let chunks = if n < CHUNKED_FROM { 1 } else { CHUNKS.min(grid.rows()) };
    let sums_of = |chunk: usize| {
        let rows = chunk * grid.rows() / chunks..(chunk + 1) * grid.rows() / chunks;
        let mut plain = Smoother::new(&options, spacing);
        // Sums with translation weights, for the bins beyond `covered`.
        let mut weighted = None;
        match options.edge {
            EdgeCorrection::SetCovariance if options.r_max * spacing > covered => {
                let mut far = Smoother::new(&options, spacing);
                grid.visit(rows, |_, _, dx, dy| {
                    let d = (dx * dx + dy * dy).sqrt();
                    plain.add(d, 1.);
                    far.add(d, weights.translation(dx, dy));
                });
                weighted = Some(far.sums());
            }
            EdgeCorrection::SetCovariance | EdgeCorrection::Torus | EdgeCorrection::None => {
                grid.visit(rows, |_, _, dx, dy| plain.add((dx * dx + dy * dy).sqrt(), 1.));
            }
            EdgeCorrection::Translation => {
                grid.visit(rows, |_, _, dx, dy| {
                    plain.add((dx * dx + dy * dy).sqrt(), weights.translation(dx, dy));
                });
            }
            EdgeCorrection::Isotropic => grid.visit(rows, |from, _, dx, dy| {
                let d = (dx * dx + dy * dy).sqrt();
                let from = grid.point(from);
                plain.add(d, weights.isotropic(from, Point::new(from.x + dx, from.y + dy), d));
            }),
        }
        (plain.sums(), weighted)
    };
    let sums: Vec<_> = if parallel && chunks > 1 {
        (0..chunks).into_par_iter().map(sums_of).collect()
    } else {
        (0..chunks).map(sums_of).collect()
    };

    let r = options.radii();
    // Every unordered pair was visited once; the formula counts both orders.
    let pairs = n as f64 * (n - 1) as f64 / 2.;
    let g = r
        .iter()
        .enumerate()
        .map(|(b, &r)| {
            let r = r * spacing;
            let covariance = match options.edge {
                EdgeCorrection::SetCovariance if r <= covered => weights.covariance(r),
                _ => 1.,
            };
            let beyond = r > covered;
            let sum: f64 = sums
                .iter()
                .map(|(plain, far)| if beyond { far.as_ref().unwrap_or(plain) } else { plain }[b])
                .sum();
            // Where there is no pair, interpolation may leave values such as −10⁻⁹.
            (area * sum / (pairs * TAU * r * covariance)).max(0.)
        })
        .collect();
    Ok(Pcf { r, g, spacing, options })
}

#[cfg(test)]
mod tests;
