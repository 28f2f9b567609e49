//! Computation of the tables of Lanaro et al. with the samplers of this library, and comparison
//! with the printed values.
//!
//! 1. Draw patterns of a sampler in the unit square and measure each pattern as the paper does
//!    ([`pattern`]).
//! 2. Average the regularity indices of the patterns, and test whether a single pattern could have
//!    the printed index ([`made_row`]).
//! 3. Average the pair correlation functions, and compute the l-infinity distance between two
//!    samplers with its standard error ([`distance_between`]).

use super::printed::PrintedRegularity;
use crate::compare::{CompareError, curve, draw, l_infinity, mean_curve};
use crate::geometry::{Point, Window};
use crate::sample::Sampler;
use crate::stats::{
    Deviation, Moments, Pcf, PcfOptions, StatsError, moments, nearest_neighbours, pcf_on_one_thread,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use sha2::{Digest, Sha256};

/// Pattern in the unit square with the measurements of the paper's tables.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// Points of the pattern.
    pub points: Vec<Point>,
    /// Mean and standard deviation of the nearest-neighbour distances of all points. Distances have
    /// no edge correction, and the standard deviation is that of the population (divisor n), as in
    /// the paper.
    pub nearest: Moments,
    /// Pair correlation function, estimated with default options.
    pub pcf: Pcf,
}

/// Computes the pair correlation function of a pattern with another `bandwidth` than the default,
/// in hexagonal spacings. The curve begins at the default distance or at 1.5 bandwidths, the least
/// that [`PcfOptions`] allow, whichever is larger.
///
/// # Errors
/// Fails if the bandwidth is out of range.
pub fn with_bandwidth(pattern: &Pattern, bandwidth: f64) -> Result<Pcf, StatsError> {
    let default = PcfOptions::default();
    let options = PcfOptions { bandwidth, r_min: default.r_min.max(1.5 * bandwidth), ..default };
    pcf_on_one_thread(&pattern.points, &Window::unit_square(), &options)
}

/// Draws and measures pattern number `k` of about `n` points of `sampler` in the unit square.
///
/// The random generator is seeded by a hash of `seed`, the sampler's name, `n` and `k`.
///
/// # Errors
/// Fails if the sampler cannot make a pattern of about `n` points.
pub fn pattern(sampler: &dyn Sampler, n: usize, k: usize, seed: u64) -> Result<Pattern, CompareError> {
    let window = Window::unit_square();
    let mut hash = Sha256::new_with_prefix(b"paper");
    hash.update(seed.to_le_bytes());
    hash.update(sampler.name());
    hash.update((n as u64).to_le_bytes());
    hash.update((k as u64).to_le_bytes());
    let mut rng = ChaCha8Rng::from_seed(hash.finalize().into());
    let points = draw(sampler, n, &window, &mut rng)?;
    let pcf = curve(sampler, &points, &window, &PcfOptions::default())?;
    let nearest = moments(&nearest_neighbours(&points, &window).distances, Deviation::Population);
    Ok(Pattern { points, nearest, pcf })
}

/// Row of Table 1, as printed and as computed from patterns of this library's sampler.
///
/// Every pattern gives one value of each column of the table. The moments are the mean and standard
/// deviation of these values over the patterns.
#[derive(Clone, Debug)]
pub struct MadeRow {
    /// Row as printed in the paper.
    pub printed: PrintedRegularity,
    /// Name of the sampler in this library.
    pub sampler: String,
    /// Number of points asked of the sampler.
    pub n: usize,
    /// Number of patterns that were drawn.
    pub patterns: usize,
    /// Mean and standard deviation, over the patterns, of a pattern's mean nearest-neighbour
    /// distance.
    pub mean: Moments,
    /// Mean and standard deviation, over the patterns, of the standard deviation of a pattern's
    /// nearest-neighbour distances.
    pub sd: Moments,
    /// Mean and standard deviation, over the patterns, of a pattern's regularity index.
    pub ri: Moments,
}

/// Largest distance at which a printed value and the mean of the computed values are said to agree,
/// in standard deviations of the computed values. About 95 % of normally distributed values lie
/// this near to their mean.
const USUAL: f64 = 2.;

impl MadeRow {
    /// Returns the distance of the printed regularity index from the mean of the computed ones, in
    /// standard deviations of single patterns; positive if the printed index is larger. Returns
    /// `None` if the computed indices do not vary.
    pub fn deviations(&self) -> Option<f64> {
        let (mean, sd) = self.ri.mean.zip(self.ri.sd.filter(|sd| *sd > 0.))?;
        Some((self.printed.ri - mean) / sd)
    }

    /// Returns whether a single pattern could have the printed regularity index: the index lies
    /// within two standard deviations of the mean over the patterns.
    pub fn agrees(&self) -> bool {
        self.deviations().is_some_and(|z| z.abs() <= USUAL)
    }

    /// Estimates how many points the printed pattern had, from its mean nearest-neighbour distance.
    /// Returns the number of points and its standard deviation for a single pattern.
    ///
    /// The number follows from the computed patterns, since the mean distance is proportional to
    /// 1/√n for n points. Returns `None` for fewer than two patterns.
    pub fn points_by_mean_distance(&self) -> Option<(f64, f64)> {
        let (mean, sd) = self.mean.mean.zip(self.mean.sd)?;
        let points = self.n as f64 * (mean / self.printed.mean).powi(2);
        // the relative deviation of the square is twice that of the mean distance
        Some((points, 2. * points * sd / mean))
    }

    /// Returns whether a single pattern of `n` points could have the printed mean nearest-neighbour
    /// distance: the number of points that the distance implies differs from `n` by at most two of
    /// its standard deviations. `false` for fewer than two patterns.
    pub fn mean_agrees(&self) -> bool {
        let off = |(points, sd): (f64, f64)| (points - self.n as f64).abs() <= USUAL * sd;
        self.points_by_mean_distance().is_some_and(off)
    }
}

/// Summarises `patterns` as one row of Table 1.
pub fn made_row(printed: PrintedRegularity, sampler: &str, n: usize, patterns: &[&Pattern]) -> MadeRow {
    let over = |value: fn(&Moments) -> Option<f64>| {
        let values: Vec<f64> = patterns.iter().filter_map(|p| value(&p.nearest)).collect();
        moments(&values, Deviation::Sample)
    };
    MadeRow {
        printed,
        sampler: sampler.to_owned(),
        n,
        patterns: patterns.len(),
        mean: over(|m| m.mean),
        sd: over(|m| m.sd),
        ri: over(|m| m.ri),
    }
}

/// Returns the highest value of a pair correlation function and the distance, in hexagonal
/// spacings, at which it occurs; `None` for an empty curve.
pub fn peak(curve: &Pcf) -> Option<(f64, f64)> {
    curve.g.iter().copied().zip(curve.r.iter().copied()).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// l-infinity distance between the mean pair correlation functions of two samplers, with its
/// standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistanceBetween {
    /// Distance between the mean curves ḡ₁ and ḡ₂: max |ḡ₁ − ḡ₂|.
    pub l_infinity: f64,
    /// Standard error of `l_infinity`, by jackknife: each pattern of either sampler is left out in
    /// turn.
    pub error: f64,
}

/// Computes the l-infinity distance between the mean curves of two lists of patterns, with its
/// standard error.
///
/// # Errors
/// Fails if a list is empty, or if the curves differ in distances, kernel, bandwidth or edge
/// correction.
pub fn distance_between(a: &[&Pcf], b: &[&Pcf]) -> Result<DistanceBetween, CompareError> {
    let between = |a: &[&Pcf], b: &[&Pcf]| match (mean_curve(a), mean_curve(b)) {
        (Some(a), Some(b)) => l_infinity(&a, &b),
        _ => Err(CompareError::TooFewPoints { found: 0 }),
    };
    let without = |list: &[&Pcf], i: usize| -> Vec<Pcf> {
        list.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, c)| (*c).clone()).collect()
    };
    // jackknife variance of a statistic, from its values with one pattern left out
    let variance = |values: &[f64]| {
        let m = values.len() as f64;
        let mean = values.iter().sum::<f64>() / m;
        (m - 1.) / m * values.iter().map(|v| (v - mean).powi(2)).sum::<f64>()
    };
    let mut error = 0.;
    for (varied, fixed) in [(a, b), (b, a)].into_iter().filter(|(varied, _)| varied.len() > 1) {
        let leave_one_out = (0..varied.len())
            .map(|i| {
                let kept = without(varied, i);
                between(&kept.iter().collect::<Vec<_>>(), fixed)
            })
            .collect::<Result<Vec<f64>, _>>()?;
        error += variance(&leave_one_out);
    }
    Ok(DistanceBetween { l_infinity: between(a, b)?, error: error.sqrt() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::sampler;

    #[test]
    fn distances_of_means_are_those_expected_of_the_samplers() {
        let of = |name: &str| -> Vec<Pattern> {
            (0..10).map(|k| pattern(sampler(name).unwrap(), 1024, k, 1).unwrap()).collect()
        };
        let (darts, jittered) = (of("dart-throwing"), of("jittered"));
        let curves = |p: &[Pattern]| p.iter().map(|p| p.pcf.clone()).collect::<Vec<_>>();
        let (a, b) = (curves(&darts), curves(&jittered));
        let [a, b] = [&a, &b].map(|c| c.iter().collect::<Vec<_>>());
        let found = distance_between(&a, &b).unwrap();
        assert!((found.l_infinity - 0.73).abs() < 0.04, "{found:?}");
        assert!((0.001..0.05).contains(&found.error), "{found:?}");
        let (g, r) = peak(&mean_curve(&a).unwrap()).unwrap();
        assert!((g - 1.62).abs() < 0.05 && (r - 0.85).abs() < 0.04, "{g} at {r}");
    }

    #[test]
    fn printed_index_agrees_if_a_pattern_could_have_it() {
        let patterns: Vec<Pattern> =
            (0..10).map(|k| pattern(sampler("jittered").unwrap(), 100, k, 1).unwrap()).collect();
        let ours =
            moments(&patterns.iter().filter_map(|p| p.nearest.ri).collect::<Vec<_>>(), Deviation::Sample);
        let row = |ri: f64| {
            let printed =
                PrintedRegularity { name: "x".into(), mean: patterns[0].nearest.mean.unwrap(), sd: 1., ri };
            made_row(printed, "jittered", 100, &patterns.iter().collect::<Vec<_>>())
        };
        assert!(row(ours.mean.unwrap()).agrees());
        assert!(!row(ours.mean.unwrap() + 3. * ours.sd.unwrap()).agrees());
        let (points, scatter) = row(1.).points_by_mean_distance().unwrap();
        assert!((points - 100.).abs() < 3. * scatter && scatter < 15., "{points} ± {scatter}");
    }
}
