use super::StatsError;
use super::edge_weight::EdgeWeights;
use super::pairs::PairGrid;
use crate::geometry::{Point, Window};
use crate::mosaic::hexagonal_spacing;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Shape of the kernel that smooths pair distances; all have integral 1 and the same standard deviation, the bandwidth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kernel {
    /// exp(−t²/2σ²), cut at 6.5 σ: what the paper's numbers were made with.
    #[default]
    Gaussian,
    /// Constant within √3 σ.
    Box,
    /// Falling linearly to 0 at √6 σ.
    Triangle,
}

impl Kernel {
    /// Bandwidths beyond which a pair does not count.
    pub(super) fn reach(self) -> f64 {
        match self {
            Self::Gaussian => 6.5,
            Self::Box => 3f64.sqrt(),
            Self::Triangle => 6f64.sqrt(),
        }
    }

    /// At `t` bandwidths from the middle, for bandwidth 1.
    fn at(self, t: f64) -> f64 {
        let reach = self.reach();
        if t.abs() > reach {
            return 0.;
        }
        match self {
            Self::Gaussian => (-0.5 * t * t).exp() / TAU.sqrt(),
            Self::Box => 0.5 / reach,
            Self::Triangle => (reach - t.abs()) / (reach * reach),
        }
    }
}

/// How the pairs that the border hides are made up for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EdgeCorrection {
    /// The sum at r is divided by the isotropised set covariance, in a w × h window 1 − 2r(w+h)/(πwh) + r²/(πwh); beyond
    /// the shorter side, where that does not hold, translation weights. In a polygon the covariance is averaged over
    /// directions ([`crate::geometry::SetCovariance`]), at least .01. On a torus this means [`EdgeCorrection::Torus`].
    #[default]
    SetCovariance,
    /// Each pair weighs the area of the window W over |W ∩ (W + Δ)|, at most 100: wh/((w−|Δx|)(h−|Δy|)) in a rectangle,
    /// within 10⁻³ of the exact value in a polygon (Ohser & Stoyan 1981).
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
    if let Some((index, p)) =
        points.iter().enumerate().find(|(_, p)| !(p.is_finite() && window.contains(**p)))
    {
        return Err(StatsError::Outside { index, x: p.x, y: p.y });
    }
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

/// Sums Σ weight · k(r − d) over pairs, at the left edges of the bins.
pub(super) struct Smoother {
    kernel: Kernel,
    bins: usize,
    first: f64,
    bin_width: f64,
    bandwidth: f64,
    /// Gaussian: weights on fine nodes, `per_bin` a bin; node 0 is `lead` nodes before the first bin. Others: the sums.
    nodes: Vec<f64>,
    per_bin: usize,
    lead: usize,
}

impl Smoother {
    pub(super) fn new(options: &PcfOptions, spacing: f64) -> Self {
        let bin_width = options.bin_width() * spacing;
        let bandwidth = options.bandwidth * spacing;
        let mut smoother = Self {
            kernel: options.kernel,
            bins: options.bins,
            first: options.r_min * spacing,
            bin_width,
            bandwidth,
            nodes: Vec::new(),
            per_bin: 1,
            lead: 0,
        };
        if options.kernel == Kernel::Gaussian {
            // Cubic interpolation errs by .07 (node distance/σ)⁴ of the kernel's peak: 2·10⁻⁷ at σ/24, less in a
            // sum over pairs.
            smoother.per_bin = (24. * bin_width / bandwidth).ceil().max(1.) as usize;
            // Two nodes more, for the interpolation at either end.
            smoother.lead = smoother.half_width() + 2;
            smoother.nodes = vec![0.; (options.bins - 1) * smoother.per_bin + 2 * smoother.lead + 1];
        } else {
            smoother.nodes = vec![0.; options.bins];
        }
        smoother
    }

    /// Nodes on either side of a bin that its Gaussian reaches.
    fn half_width(&self) -> usize {
        (self.kernel.reach() * self.bandwidth * self.per_bin as f64 / self.bin_width).ceil() as usize
    }

    #[inline]
    pub(super) fn add(&mut self, d: f64, weight: f64) {
        match self.kernel {
            Kernel::Gaussian => {
                let at = (d - self.first) * (self.per_bin as f64 / self.bin_width) + self.lead as f64;
                if at < 1. {
                    return;
                }
                let node = at as usize;
                let t = at - node as f64;
                if let Some([a, b, c, e]) = self.nodes.get_mut(node - 1..node + 3) {
                    *a += weight * (t * (t - 1.) * (2. - t) / 6.);
                    *b += weight * ((t + 1.) * (t - 1.) * (t - 2.) / 2.);
                    *c += weight * ((t + 1.) * t * (2. - t) / 2.);
                    *e += weight * ((t + 1.) * t * (t - 1.) / 6.);
                }
            }
            Kernel::Box | Kernel::Triangle => {
                let reach = self.kernel.reach() * self.bandwidth;
                let low = ((d - reach - self.first) / self.bin_width).ceil().max(0.) as usize;
                let high = ((d + reach - self.first) / self.bin_width).floor();
                if high < 0. {
                    return;
                }
                let high = (high as usize).min(self.bins - 1);
                for bin in low..=high {
                    let t = (self.first + bin as f64 * self.bin_width - d) / self.bandwidth;
                    self.nodes[bin] += weight * self.kernel.at(t) / self.bandwidth;
                }
            }
        }
    }

    pub(super) fn sums(self) -> Vec<f64> {
        if self.kernel != Kernel::Gaussian {
            return self.nodes;
        }
        let half = self.half_width();
        let step = self.bin_width / self.per_bin as f64 / self.bandwidth;
        let kernel: Vec<f64> = (0..=2 * half)
            .map(|i| self.kernel.at((i as f64 - half as f64) * step) / self.bandwidth)
            .collect();
        (0..self.bins)
            .map(|bin| {
                let first = self.lead + bin * self.per_bin - half;
                dot(&self.nodes[first..first + kernel.len()], &kernel)
            })
            .collect()
    }
}

/// Inner product in four interleaved sums, which the processor adds at once.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a4.remainder().iter().zip(b4.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in a4.zip(b4) {
        for lane in 0..4 {
            sums[lane] += x[lane] * y[lane];
        }
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Polygon, Rectangle};
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use std::f64::consts::PI;

    fn points_in(bounds: &Rectangle, n: usize, seed: u64) -> Vec<Point> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        (0..n)
            .map(|_| {
                let (u, v): (f64, f64) = (rng.random(), rng.random());
                Point::new(bounds.x0() + u * bounds.width(), bounds.y0() + v * bounds.height())
            })
            .collect()
    }

    /// The definition, summed over all ordered pairs (and images), for windows wider than r or torus windows.
    fn direct(points: &[Point], window: &Window, options: &PcfOptions) -> Vec<f64> {
        let b = window.bounds();
        let (w, h, n) = (b.width(), b.height(), points.len() as f64);
        let s = hexagonal_spacing(points.len(), w * h).unwrap();
        let sigma = options.bandwidth * s;
        let images = if options.edge == EdgeCorrection::Torus { -6..=6 } else { 0..=0 };
        (0..options.bins)
            .map(|bin| {
                let r =
                    s * (options.r_min + bin as f64 * (options.r_max - options.r_min) / options.bins as f64);
                let mut sum = 0.;
                for (i, p) in points.iter().enumerate() {
                    for (_, q) in points.iter().enumerate().filter(|&(j, _)| j != i) {
                        for (kx, ky) in images.clone().flat_map(|a| images.clone().map(move |b| (a, b))) {
                            let (dx, dy) = (q.x - p.x + w * f64::from(kx), q.y - p.y + h * f64::from(ky));
                            let d = dx.hypot(dy);
                            let t = (r - d) / sigma;
                            let k = match options.kernel {
                                Kernel::Gaussian => (-t * t / 2.).exp() / TAU.sqrt(),
                                Kernel::Box => f64::from(u8::from(t.abs() <= 3f64.sqrt())) / 12f64.sqrt(),
                                Kernel::Triangle => (1. - t.abs() / 6f64.sqrt()).max(0.) / 6f64.sqrt(),
                            } / sigma;
                            let translated = 1. / ((1. - dx.abs() / w) * (1. - dy.abs() / h)).max(0.01);
                            let weight = match options.edge {
                                EdgeCorrection::SetCovariance if r > w.min(h) => translated,
                                EdgeCorrection::SetCovariance => {
                                    let disk = 1. - 2. * r * (w + h) / (PI * w * h) + r * r / (PI * w * h);
                                    1. / disk
                                }
                                EdgeCorrection::Translation => translated,
                                EdgeCorrection::Isotropic => {
                                    // The arc inside, counted on 20 000 points of the circle around p.
                                    let m = 20_000;
                                    let inside = (0..m).filter(|&a| {
                                        let angle = TAU * (f64::from(a) + 0.5) / f64::from(m);
                                        window.contains(Point::new(
                                            p.x + d * angle.cos(),
                                            p.y + d * angle.sin(),
                                        ))
                                    });
                                    (f64::from(m) / inside.count() as f64).min(100.)
                                }
                                EdgeCorrection::Torus | EdgeCorrection::None => 1.,
                            };
                            sum += weight * k;
                        }
                    }
                }
                w * h * sum / (n * (n - 1.) * TAU * r)
            })
            .collect()
    }

    fn worst(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0., f64::max)
    }

    #[test]
    fn fast_sum_agrees_with_the_sum_over_all_pairs() {
        let wide = Rectangle::new(-3., 7., 7., 12.).unwrap();
        let coarse = PcfOptions { bins: 40, ..PcfOptions::default() };
        let points = points_in(&wide, 120, 1);
        for kernel in [Kernel::Gaussian, Kernel::Box, Kernel::Triangle] {
            for (window, edge) in [
                (Window::Rectangle(wide), EdgeCorrection::SetCovariance),
                (Window::Rectangle(wide), EdgeCorrection::Translation),
                (Window::Rectangle(wide), EdgeCorrection::None),
                (Window::Torus(wide), EdgeCorrection::Torus),
            ] {
                let options = PcfOptions { kernel, edge, ..coarse };
                let g = pcf(&points, &window, &options).unwrap().g;
                let difference = worst(&g, &direct(&points, &window, &options));
                assert!(difference < 1e-6, "{kernel:?} {edge:?}: {difference}");
            }
        }
    }

    #[test]
    fn few_points_in_thin_windows_agree_with_the_sum_over_all_pairs() {
        let thin = Rectangle::new(0., 0., 3., 1.).unwrap();
        let options = PcfOptions { bins: 40, ..PcfOptions::default() };
        for n in [2, 3, 12] {
            let points = points_in(&thin, n, n as u64);
            for (window, edge) in [
                (Window::Rectangle(thin), EdgeCorrection::SetCovariance),
                (Window::Torus(thin), EdgeCorrection::Torus),
            ] {
                let options = PcfOptions { edge, ..options };
                let g = pcf(&points, &window, &options).unwrap().g;
                let difference = worst(&g, &direct(&points, &window, &options));
                assert!(difference < 1e-6, "{n} {edge:?}: {difference}");
            }
        }
    }

    #[test]
    fn isotropic_weights_are_the_inverse_share_of_the_circle() {
        let bounds = Rectangle::new(0., 0., 2., 1.).unwrap();
        let window = Window::Rectangle(bounds);
        let options = PcfOptions { bins: 8, edge: EdgeCorrection::Isotropic, ..PcfOptions::default() };
        let points = points_in(&bounds, 20, 5);
        let difference =
            worst(&pcf(&points, &window, &options).unwrap().g, &direct(&points, &window, &options));
        // The arcs of the comparison are counted, not measured.
        assert!(difference < 2e-3, "{difference}");
    }

    #[test]
    fn triangular_lattice_has_its_shells_at_1_root_3_and_2_with_6_neighbours_each() {
        let (columns, rows) = (20, 24);
        let bounds = Rectangle::new(0., 0., 20., 12. * 3f64.sqrt()).unwrap();
        let points: Vec<Point> = (0..rows)
            .flat_map(|j| (0..columns).map(move |i| (i, j)))
            .map(|(i, j)| {
                Point::new(f64::from(i) + 0.5 * f64::from(j % 2) + 0.2, 0.1 + f64::from(j) * 3f64.sqrt() / 2.)
            })
            .collect();
        let options = PcfOptions::default();
        let curve = pcf(&points, &Window::Torus(bounds), &options).unwrap();
        assert_eq!(curve.options.edge, EdgeCorrection::Torus);
        let n = f64::from(columns * rows);
        let shells = [(1., 6.), (3f64.sqrt(), 6.), (2., 6.), (7f64.sqrt(), 12.), (3., 6.)];
        for (r, g) in curve.r.iter().zip(&curve.g) {
            let expected: f64 = shells
                .iter()
                .map(|(at, m)| m * (-((r - at) / 0.1f64).powi(2) / 2.).exp() / (0.1 * TAU.sqrt()))
                .sum::<f64>()
                * bounds.area()
                / ((n - 1.) * TAU * r);
            assert!((g - expected).abs() < 1e-6, "r {r}: {g}, expected {expected}");
        }
    }

    #[test]
    fn independent_points_have_g_1_under_every_correction_but_none() {
        let bounds = Rectangle::new(0., 0., 1., 1.).unwrap();
        let points = points_in(&bounds, 20_000, 9);
        for edge in [EdgeCorrection::SetCovariance, EdgeCorrection::Translation, EdgeCorrection::Isotropic] {
            let options = PcfOptions { edge, ..PcfOptions::default() };
            let g = pcf(&points, &Window::Rectangle(bounds), &options).unwrap().g;
            assert!(g.iter().all(|g| (g - 1.).abs() < 0.04), "{edge:?}");
        }
        let few = &points[..300];
        let options = PcfOptions { edge: EdgeCorrection::None, ..PcfOptions::default() };
        let none = pcf(few, &Window::Rectangle(bounds), &options).unwrap().g;
        let corrected = pcf(few, &Window::Rectangle(bounds), &PcfOptions::default()).unwrap().g;
        assert!(none[199] < 0.87 * corrected[199]);
    }

    fn polygon_of(corners: &[(f64, f64)]) -> Window {
        let ring = corners.iter().map(|&(x, y)| Point::new(x, y)).collect();
        Window::Polygon(Polygon::new(vec![ring]).unwrap())
    }

    #[test]
    fn a_rectangle_given_as_a_polygon_has_the_curve_of_the_rectangle() {
        let bounds = Rectangle::new(10., 0., 13., 2.).unwrap();
        let points = points_in(&bounds, 400, 6);
        let polygon = polygon_of(&[(10., 0.), (13., 0.), (13., 2.), (10., 2.)]);
        for (edge, tolerance) in [
            (EdgeCorrection::SetCovariance, 1e-4),
            (EdgeCorrection::Translation, 1e-9),
            (EdgeCorrection::Isotropic, 1e-9),
            (EdgeCorrection::None, 1e-12),
        ] {
            let options = PcfOptions { edge, ..PcfOptions::default() };
            let expected = pcf(&points, &Window::Rectangle(bounds), &options).unwrap().g;
            let difference = worst(&pcf(&points, &polygon, &options).unwrap().g, &expected);
            assert!(difference < tolerance, "{edge:?}: {difference}");
        }
    }

    #[test]
    fn independent_points_in_an_l_have_g_1_under_every_correction_but_none() {
        let l = polygon_of(&[(0., 0.), (1., 0.), (1., 0.35), (0.35, 0.35), (0.35, 1.), (0., 1.)]);
        let mean_of = |edge: EdgeCorrection| {
            let options = PcfOptions { edge, bins: 30, r_max: 4., ..PcfOptions::default() };
            let curves: Vec<Vec<f64>> = (0..60)
                .map(|seed| {
                    let mut points = points_in(&l.bounds(), 700, seed);
                    points.retain(|&p| l.contains(p));
                    pcf(&points, &l, &options).unwrap().g
                })
                .collect();
            (0..30).map(|b| curves.iter().map(|g| g[b]).sum::<f64>() / 60.).collect::<Vec<f64>>()
        };
        for edge in [EdgeCorrection::SetCovariance, EdgeCorrection::Translation, EdgeCorrection::Isotropic] {
            let mean = mean_of(edge);
            // n varies from pattern to pattern, which biases none of them at this level
            assert!(mean.iter().all(|g| (g - 1.).abs() < 0.05), "{edge:?}: {mean:.3?}");
            let far = mean[10..].iter().sum::<f64>() / 20.;
            assert!((far - 1.).abs() < 0.01, "{edge:?}: {far}");
        }
        assert!(mean_of(EdgeCorrection::None)[29] < 0.75);
    }

    #[test]
    fn torus_curve_does_not_depend_on_where_the_torus_is_cut() {
        let bounds = Rectangle::new(0., 0., 2., 1.).unwrap();
        let window = Window::Torus(bounds);
        let points = points_in(&bounds, 400, 3);
        let moved: Vec<Point> = points
            .iter()
            .map(|p| Point::new((p.x + 1.37).rem_euclid(2.), (p.y + 0.61).rem_euclid(1.)))
            .collect();
        let options = PcfOptions::default();
        let (a, b) = (pcf(&points, &window, &options).unwrap(), pcf(&moved, &window, &options).unwrap());
        assert!(worst(&a.g, &b.g) < 1e-9);
    }

    #[test]
    fn curve_does_not_depend_on_the_unit_or_the_number_of_threads() {
        let bounds = Rectangle::new(0., 0., 1., 1.).unwrap();
        let points = points_in(&bounds, 20_000, 4);
        let options = PcfOptions::default();
        let window = Window::Rectangle(bounds);
        let curve = pcf(&points, &window, &options).unwrap();
        assert_eq!(curve, pcf_on_one_thread(&points, &window, &options).unwrap());
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            assert_eq!(curve, pool.install(|| pcf(&points, &window, &options)).unwrap());
        }
        let metres: Vec<Point> = points.iter().map(|p| Point::new(p.x * 1024. - 512., p.y * 1024.)).collect();
        let scaled = pcf(&metres, &Window::rectangle(-512., 0., 512., 1024.).unwrap(), &options).unwrap();
        assert!(worst(&curve.g, &scaled.g) < 1e-9);
        assert!((scaled.spacing / curve.spacing - 1024.).abs() < 1e-9);
    }

    #[test]
    fn options_out_of_range_say_the_range() {
        let default = PcfOptions::default();
        assert!(default.validate().is_ok());
        for bad in [
            PcfOptions { bandwidth: 0., ..default },
            PcfOptions { bandwidth: f64::NAN, ..default },
            PcfOptions { r_min: 0.1, ..default },
            PcfOptions { r_max: 0.15, ..default },
            PcfOptions { r_max: f64::INFINITY, ..default },
            PcfOptions { bins: 0, ..default },
        ] {
            assert!(matches!(bad.validate(), Err(StatsError::Option { .. })), "{bad:?}");
        }
    }

    #[test]
    fn what_has_no_curve_is_an_error() {
        let (window, options) = (Window::unit_square(), PcfOptions::default());
        let p = Point::new(0.5, 0.5);
        assert!(matches!(pcf(&[p], &window, &options), Err(StatsError::TooFewPoints { found: 1, .. })));
        let outside = [p, Point::new(1.5, 0.5)];
        assert!(matches!(pcf(&outside, &window, &options), Err(StatsError::Outside { index: 1, .. })));
        let not_a_number = [p, Point::new(f64::NAN, 0.5)];
        assert!(matches!(pcf(&not_a_number, &window, &options), Err(StatsError::Outside { index: 1, .. })));
        let torus = PcfOptions { edge: EdgeCorrection::Torus, ..options };
        assert_eq!(pcf(&[p, p], &window, &torus), Err(StatsError::NotATorus));
    }

    proptest! {
        #[test]
        fn any_small_pattern_has_a_finite_curve(
            raw in prop::collection::vec((0..6u8, 0..6u8), 2..30), torus: bool, flat in 0.001..1f64, edge in 0..4u8,
        ) {
            let bounds = Rectangle::new(0., 0., 5., 5. * flat).unwrap();
            let window = if torus { Window::Torus(bounds) } else { Window::Rectangle(bounds) };
            let points: Vec<Point> = raw
                .iter()
                .map(|&(x, y)| Point::new(f64::from(x), (f64::from(y) * flat).min(5. * flat)))
                .collect();
            let edge = [
                EdgeCorrection::SetCovariance,
                EdgeCorrection::Translation,
                EdgeCorrection::Isotropic,
                EdgeCorrection::None,
            ][edge as usize];
            let curve = pcf(&points, &window, &PcfOptions { edge, ..PcfOptions::default() }).unwrap();
            prop_assert!(curve.g.iter().all(|g| g.is_finite() && *g >= 0.));
        }
    }
}
