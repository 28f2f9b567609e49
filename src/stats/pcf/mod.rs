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

/// How the pairs that the border hides are made up for.
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
    /// The sum at r is divided by the isotropised set covariance, in a w × h window 1 − 2r(w+h)/(πwh) + r²/(πwh); beyond
    /// the shorter side, where that does not hold, translation weights. In a polygon the covariance is averaged over
    /// directions ([`crate::geometry::SetCovariance`]), at least .01. On a torus this means [`EdgeCorrection::Torus`].
    #[default]
    SetCovariance,
    /// Each pair weighs the area of the window W over |W ∩ (W + Δ)|, at most 100: wh/((w−|Δx|)(h−|Δy|)) in a rectangle,
    /// within 2 · 10⁻³ of the exact value in a polygon (Ohser & Stoyan 1981).
    Translation,
    /// Each pair weighs the inverse share, within the window, of the circles around either point through the other,
    /// at most 100 (Ripley 1976).
    Isotropic,
    /// Pairs are those of a point and the images of others on the torus: nothing is hidden. Torus windows only.
    Torus,
    /// None: g falls with r.
    None,
}

/// How to estimate the pair correlation function. Lengths are in hexagonal spacings s = √(2/(√3 λ)) of the pattern.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PcfOptions {
    /// Shape of the smoothing kernel.
    pub kernel: Kernel,
    /// Its standard deviation σ, in spacings: .005–1, default .1.
    pub bandwidth: f64,
    /// The first bin, in spacings: at least 1.5 σ (nearer to 0 the kernel reaches negative distances), default .15.
    pub r_min: f64,
    /// The end of the last bin, in spacings: above `r_min`, at most 50, default 2.5.
    pub r_max: f64,
    /// Number of bins; g is taken at their left edges. 1–2000, default 200.
    pub bins: usize,
    /// Edge correction.
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
    /// # Errors
    /// If an option is out of its range; the error says the range.
    pub fn validate(&self) -> Result<(), StatsError> {
        let check = |ok: bool, option, value, range| {
            if ok { Ok(()) } else { Err(StatsError::Option { option, value, range }) }
        };
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

    /// Left edges of the bins, in spacings.
    pub fn radii(&self) -> Vec<f64> {
        (0..self.bins).map(|b| self.r_min + b as f64 * self.bin_width()).collect()
    }

    fn bin_width(&self) -> f64 {
        (self.r_max - self.r_min) / self.bins as f64
    }
}

/// A pair correlation function, with how it was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pcf {
    /// Distances, in hexagonal spacings.
    pub r: Vec<f64>,
    /// g at those distances: 1 for independent points.
    pub g: Vec<f64>,
    /// The hexagonal spacing, in the unit of the coordinates.
    pub spacing: f64,
    /// As used: on a torus the default correction has become [`EdgeCorrection::Torus`].
    pub options: PcfOptions,
}

/// Pair correlation function (Öztireli & Gross 2012; Illian et al. 2008) of a stationary pattern:
///
/// g(r) = A Σ_{i≠j} k_σ(r − |x_i − x_j|) / (n (n−1) · 2πr · c(r)), with k_σ the kernel and c(r) the edge correction.
///
/// Distances go into a histogram whose bins are σ/24 or finer, spread over four bins by cubic interpolation, and that is
/// smoothed: linear in n, within 10⁻⁷ of the sum over pairs. Large patterns use all threads, with the same result for any
/// number of them.
///
/// # Errors
/// If an option is out of range, there are fewer than two points, one is not inside the window, or torus correction is
/// asked for in a bounded window.
pub fn pcf(points: &[Point], window: &Window, options: &PcfOptions) -> Result<Pcf, StatsError> {
    estimate(points, window, options, true)
}

/// [`pcf`] that never hands work to another thread.
pub(crate) fn pcf_on_one_thread(
    points: &[Point],
    window: &Window,
    options: &PcfOptions,
) -> Result<Pcf, StatsError> {
    estimate(points, window, options, false)
}

/// Points from which on the work is cut into [`CHUNKS`] that may run in parallel.
const CHUNKED_FROM: usize = 8192;
const CHUNKS: usize = 32;
/// Images of a torus so thin that a disk holds more turns than this are refused.
const MAX_TURNS: f64 = 1000.;

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
        let range = "at most 1000: the window is too thin for its few points";
        return Err(StatsError::Option { option: "r_max in turns round the torus", value: turns, range });
    }

    let weights = EdgeWeights::new(window);
    let covered = weights.covariance_reach();
    let grid = PairGrid::new(points, window, torus, reach);
    let chunks = if n < CHUNKED_FROM { 1 } else { CHUNKS.min(grid.rows()) };
    let sums_of = |chunk: usize| {
        let rows = chunk * grid.rows() / chunks..(chunk + 1) * grid.rows() / chunks;
        let mut plain = Smoother::new(&options, spacing);
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
    // Every unordered pair was visited once: twice that are ordered.
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
            // Interpolation may leave −10⁻⁹ where there is no pair.
            (area * sum / (pairs * TAU * r * covariance)).max(0.)
        })
        .collect();
    Ok(Pcf { r, g, spacing, options })
}

#[cfg(test)]
mod tests;
