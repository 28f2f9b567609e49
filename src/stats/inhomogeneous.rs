//! Second-order functions of patterns whose density varies: the inhomogeneous pair correlation
//! function and K, and the pair correlation function of locally scaled distances.
//!
//! 1. Estimate the intensity λ at every point.
//! 2. Visit all pairs up to the largest distance from which the kernel extends to a bin, each with
//!    its translation weight.
//! 3. For g and K divide the weight by λ_i λ_j; for the locally scaled g divide the distance by the
//!    local spacing instead.

use super::edge_weight::EdgeWeights;
use super::error::all_inside;
use super::intensity::{default_intensity_bandwidth, intensity_at_points};
use super::pairs::PairGrid;
use super::pcf::Smoother;
use super::{PcfOptions, StatsError};
use crate::geometry::{Point, Window};
use crate::mosaic::hexagonal_spacing;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Smallest number of points that is accepted; fewer points do not determine how the intensity
/// varies.
const FEWEST: usize = 20;

/// Pair correlation and K functions of a pattern whose density varies across the window.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Inhomogeneous {
    /// Distances at which the functions are evaluated, in hexagonal spacings at the mean density.
    pub r: Vec<f64>,
    /// Inhomogeneous pair correlation function: 1 for independent points of any intensity.
    pub g: Vec<f64>,
    /// Inhomogeneous K, in squared units of the coordinates: πr² for independent points.
    pub k: Vec<f64>,
    /// Pair correlation function of locally scaled distances: each distance is divided by the
    /// hexagonal spacing at the density around the pair. It suits mosaics whose spacing follows
    /// their density.
    pub g_scaled: Vec<f64>,
    /// Hexagonal spacing at the mean density, in units of the coordinates.
    pub spacing: f64,
    /// Standard deviation of the kernel that estimated the intensity, in units of the coordinates.
    pub bandwidth: f64,
    /// Smallest and largest intensity at a point, per squared unit of the coordinates.
    pub intensity: (f64, f64),
}

impl Inhomogeneous {
    /// Returns the values of every function at the distances `r`, with the name of its column in
    /// tables.
    pub fn columns(&self) -> [(&'static str, &[f64]); 3] {
        [("g_inhomogeneous", &self.g), ("g_locally_scaled", &self.g_scaled), ("k_inhomogeneous", &self.k)]
    }
}

/// Computes second-order functions of a pattern with a trend in its density.
///
/// Let λ_i be the intensity at point i, estimated from the other points with a Gaussian kernel and
/// edge correction. The kernel's standard deviation is `bandwidth`, in units of the coordinates; it
/// must be at least one hexagonal spacing. `None` gives an eighth of the window's shorter side, but
/// at least 2.5 spacings. The intensity is scaled so that Σ 1/λ_i is the area A of the window. Then
///
/// g(r) = A Σ_{i≠j} k_σ(r − |x_i − x_j|) w_ij/(λ_i λ_j) / ((A² − Σ 1/λ_i²) 2πr),
///
/// with translation weights w_ij. K(r) is the corresponding sum over the pairs up to distance r
/// (Baddeley, Møller & Waagepetersen 2000, <https://doi.org/10.1111/1467-9574.00144>). If all λ_i
/// are equal, g is the same as from [`super::pcf()`] with the translation correction.
///
/// Both functions assume that a trend thins the pattern without changing the distances between the
/// points that remain. In cone mosaics around the fovea, spacing follows density instead. There,
/// distances should be measured in local spacings √(2/(√3 √(λ_i λ_j))), as `g_scaled` does (locally
/// scaled processes: Hahn, Jensen, van Lieshout & Nielsen 2003).
///
/// # Errors
/// Fails if an option is out of range, there are fewer than 20 points, or a point is not inside the
/// window.
pub fn inhomogeneous(
    points: &[Point],
    window: &Window,
    options: &PcfOptions,
    bandwidth: Option<f64>,
) -> Result<Inhomogeneous, StatsError> {
    options.validate()?;
    let (n, area) = (points.len(), window.area());
    let Some(spacing) = hexagonal_spacing(n, area).filter(|_| n >= FEWEST) else {
        let statistic = "the inhomogeneous pair correlation function";
        return Err(StatsError::TooFewPoints { statistic, needed: FEWEST, found: n });
    };
    all_inside(points, window)?;
    let bandwidth = bandwidth.unwrap_or_else(|| default_intensity_bandwidth(n, window));
    if !(bandwidth.is_finite() && bandwidth >= spacing) {
        let range = "at least one hexagonal spacing of the mosaic";
        return Err(StatsError::Option { option: "intensity bandwidth", value: bandwidth, range });
    }
    let intensity = intensity_at_points(points, window, bandwidth);
    let greatest = intensity.iter().copied().fold(0., f64::max);
    let least = intensity.iter().copied().fold(f64::INFINITY, f64::min);

    // Local spacings may be wider than the mean spacing, so the search must extend farther.
    let mean = n as f64 / area;
    let widest = (mean / least).sqrt().max(1.);
    // Largest distance of a pair that is visited.
    let reach = spacing * widest * (options.r_max + options.kernel.reach() * options.bandwidth);
    let bounds = window.bounds();
    // On a torus, distances up to half the shorter side are used, so that each pair counts once,
    // along the shortest way.
    let reach = if window.is_torus() { reach.min(0.5 * bounds.width().min(bounds.height())) } else { reach };
    let grid = PairGrid::new(points, window, window.is_torus(), reach);
    let intensity = grid.sorted(&intensity);
    let weights = EdgeWeights::new(window);
    let mut reweighted = Smoother::new(options, spacing);
    let mut scaled = Smoother::new(options, spacing);
    let r = options.radii();
    let mut steps = vec![0.; r.len()];
    grid.visit(0..grid.rows(), |i, j, dx, dy| {
        let d = (dx * dx + dy * dy).sqrt();
        let edge = if window.is_torus() { 1. } else { weights.translation(dx, dy) };
        let product = intensity[i] * intensity[j];
        reweighted.add(d, edge / product);
        scaled.add(d * (product.sqrt() / mean).sqrt(), edge);
        if let Some(step) = steps.get_mut(r.partition_point(|&r| r * spacing < d)) {
            *step += edge / product;
        }
    });

    // Every unordered pair was visited once; the formula counts both orders.
    let squares: f64 = intensity.iter().map(|l| 1. / (l * l)).sum();
    let pairs = (area * area - squares).max(f64::MIN_POSITIVE) / 2.;
    let around = |r: f64| TAU * r * spacing;
    let g = r.iter().zip(reweighted.sums()).map(|(&r, sum)| (area * sum / (pairs * around(r))).max(0.));
    let ordered = n as f64 * (n - 1) as f64 / 2.;
    let g_scaled = r.iter().zip(scaled.sums()).map(|(&r, sum)| (area * sum / (ordered * around(r))).max(0.));
    let mut sum = 0.;
    let k = steps.iter().map(|step| {
        sum += step;
        area * sum / pairs
    });
    Ok(Inhomogeneous {
        g: g.collect(),
        k: k.collect(),
        g_scaled: g_scaled.collect(),
        r,
        spacing,
        bandwidth,
        intensity: (least, greatest),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::sampler;
    use crate::stats::{EdgeCorrection, pcf};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Slope of the density, which falls to a third from left to right.
    const SLOPE: f64 = 2. / 3.;

    fn pattern(name: &str, n: usize, seed: u64) -> Vec<Point> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        sampler(name).unwrap().sample(n, &Window::unit_square(), &mut rng).unwrap()
    }

    fn thinned(name: &str, n: usize, seed: u64) -> Vec<Point> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed + 1000);
        let mut points = pattern(name, n, seed);
        points.retain(|p| rng.random::<f64>() < 1. - SLOPE * p.x);
        points
    }

    /// Returns the largest deviation of the mean over seeds from `expected`, at distances of at
    /// least .4 spacings.
    fn worst(curves: &[Vec<f64>], r: &[f64], expected: impl Fn(f64) -> f64) -> f64 {
        let mean = |bin: usize| curves.iter().map(|c| c[bin]).sum::<f64>() / curves.len() as f64;
        let bins = (0..r.len()).filter(|&bin| r[bin] > 0.4);
        bins.map(|bin| (mean(bin) - expected(r[bin])).abs()).fold(0., f64::max)
    }

    #[test]
    fn thinned_poisson_has_g_of_one_and_k_of_a_disc_where_the_stationary_g_is_biased() {
        let window = Window::unit_square();
        let options = PcfOptions { r_max: 4., bandwidth: 0.2, r_min: 0.3, ..PcfOptions::default() };
        let patterns: Vec<_> = (0..40).map(|seed| thinned("uniform", 900, seed)).collect();
        let found: Vec<_> =
            patterns.iter().map(|p| inhomogeneous(p, &window, &options, None).unwrap()).collect();
        let r = &found[0].r;
        let curves: Vec<_> = found.iter().map(|f| f.g.clone()).collect();
        let stationary: Vec<_> = patterns.iter().map(|p| pcf(p, &window, &options).unwrap().g).collect();
        let (bias, was) = (worst(&curves, r, |_| 1.), worst(&stationary, r, |_| 1.));
        assert!(bias < 0.07, "{bias}");
        // 1 + variance of the density over its squared mean: 1 + (2/3)²/12/(2/3)² = 1.083
        assert!(was > 0.07, "{was}");
        let ratios: Vec<_> = found
            .iter()
            .map(|f| f.k.iter().zip(&f.r).map(|(k, r)| k / (0.5 * TAU * (r * f.spacing).powi(2))).collect())
            .collect();
        assert!(worst(&ratios, r, |r| if r > 2. { 1. } else { f64::NAN }) < 0.05);
    }

    #[test]
    fn without_a_trend_it_is_the_stationary_function() {
        let window = Window::unit_square();
        let options = PcfOptions { edge: EdgeCorrection::Translation, ..PcfOptions::default() };
        let points = pattern("dart-throwing", 600, 1);
        let found = inhomogeneous(&points, &window, &options, None).unwrap();
        let stationary = pcf(&points, &window, &options).unwrap().g;
        for curve in [&found.g, &found.g_scaled] {
            assert!(worst(std::slice::from_ref(curve), &found.r, |_| 0.) > 1.3);
            let away = curve.iter().zip(&stationary).map(|(a, b)| (a - b).abs()).fold(0., f64::max);
            assert!(away < 0.12, "{away}");
        }
    }

    #[test]
    fn where_spacing_follows_density_the_scaled_function_is_that_of_the_even_pattern() {
        let window = Window::unit_square();
        let options = PcfOptions { edge: EdgeCorrection::Translation, ..PcfOptions::default() };
        // The map is smooth and widens spacing equally along both axes on the diagonal.
        let widen = |t: f64| (t + 0.9 * t * t) / 1.9;
        let (mut plain, mut scaled, mut even) = (Vec::new(), Vec::new(), Vec::new());
        for seed in 0..8 {
            let points = pattern("dart-throwing", 800, seed);
            even.push(pcf(&points, &window, &options).unwrap().g);
            let moved: Vec<Point> = points.iter().map(|p| Point::new(widen(p.x), widen(p.y))).collect();
            plain.push(pcf(&moved, &window, &options).unwrap().g);
            scaled.push(inhomogeneous(&moved, &window, &options, None).unwrap().g_scaled);
        }
        let r = options.radii();
        let bin_of = |at: f64| r.partition_point(|&r| r < at).min(r.len() - 1);
        let mean = |at: f64| even.iter().map(|g| g[bin_of(at)]).sum::<f64>() / even.len() as f64;
        let (before, after) = (worst(&plain, &r, mean), worst(&scaled, &r, mean));
        assert!(after < 0.6 * before, "{before} {after}");
    }

    #[test]
    fn what_cannot_be_estimated_says_why() {
        let window = Window::unit_square();
        let few = inhomogeneous(&pattern("uniform", 10, 1), &window, &PcfOptions::default(), None);
        assert!(matches!(few, Err(StatsError::TooFewPoints { needed: 20, .. })));
        let points = pattern("uniform", 100, 1);
        let narrow = inhomogeneous(&points, &window, &PcfOptions::default(), Some(0.01));
        assert!(matches!(narrow, Err(StatsError::Option { .. })));
    }
}
