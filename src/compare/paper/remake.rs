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

/// A pattern in the unit square, measured as the paper's tables are.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// Its points.
    pub points: Vec<Point>,
    /// Nearest-neighbour distances of all points, plain distance, population deviation.
    pub nearest: Moments,
    /// Pair correlation function, default options.
    pub pcf: Pcf,
}

/// The pair correlation function of a pattern with another bandwidth, in spacings, from 1.5 of it on.
///
/// # Errors
/// If the bandwidth is out of range.
pub fn with_bandwidth(pattern: &Pattern, bandwidth: f64) -> Result<Pcf, StatsError> {
    let default = PcfOptions::default();
    let options = PcfOptions { bandwidth, r_min: default.r_min.max(1.5 * bandwidth), ..default };
    pcf_on_one_thread(&pattern.points, &Window::unit_square(), &options)
}

/// Pattern number `k` of about `n` points of `sampler` in the unit square; its generator is seeded by a hash of all of
/// these and `seed`.
///
/// # Errors
/// If the sampler makes no pattern of so many points.
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

/// A row of Table 1, printed and re-made: moments over patterns of what each pattern's row would be.
#[derive(Clone, Debug)]
pub struct MadeRow {
    /// As printed.
    pub printed: PrintedRegularity,
    /// Name of our sampler.
    pub sampler: String,
    /// Points asked for.
    pub n: usize,
    /// Patterns made.
    pub patterns: usize,
    /// Of mean distances.
    pub mean: Moments,
    /// Of standard deviations.
    pub sd: Moments,
    /// Of regularity indexes.
    pub ri: Moments,
}

/// Most standard deviations that a printed set, one of its kind, may be away from the mean of ours.
const USUAL: f64 = 2.;

impl MadeRow {
    /// How many standard deviations of single patterns the printed index is above our mean.
    pub fn deviations(&self) -> Option<f64> {
        let (mean, sd) = self.ri.mean.zip(self.ri.sd.filter(|sd| *sd > 0.))?;
        Some((self.printed.ri - mean) / sd)
    }

    /// Whether the printed regularity index could be that of one of our patterns: within two standard deviations.
    pub fn agrees(&self) -> bool {
        self.deviations().is_some_and(|z| z.abs() <= USUAL)
    }

    /// The number of points at which our patterns would have the printed mean distance, which goes with 1/√n, and how far
    /// single patterns scatter about it (standard deviation).
    pub fn points_by_mean_distance(&self) -> Option<(f64, f64)> {
        let (mean, sd) = self.mean.mean.zip(self.mean.sd)?;
        let points = self.n as f64 * (mean / self.printed.mean).powi(2);
        Some((points, 2. * points * sd / mean))
    }

    /// Whether one of our patterns of as many points could have the printed mean distance: within two standard deviations.
    pub fn mean_agrees(&self) -> bool {
        let off = |(points, sd): (f64, f64)| (points - self.n as f64).abs() <= USUAL * sd;
        self.points_by_mean_distance().is_some_and(off)
    }
}

/// The row that `patterns` make.
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

/// The highest value of a curve, and the distance, in spacings, at which it has it.
pub fn peak(curve: &Pcf) -> Option<(f64, f64)> {
    curve.g.iter().copied().zip(curve.r.iter().copied()).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// l-infinity between the mean curves of two samplers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistanceBetween {
    /// max |ḡ₁ − ḡ₂|.
    pub l_infinity: f64,
    /// Its standard error: jackknife over the patterns of each.
    pub error: f64,
}

/// Distance of the mean curves of two lists of patterns, and how sure it is.
///
/// # Errors
/// If a list is empty or curves do not compare.
pub fn distance_between(a: &[&Pcf], b: &[&Pcf]) -> Result<DistanceBetween, CompareError> {
    let between = |a: &[&Pcf], b: &[&Pcf]| match (mean_curve(a), mean_curve(b)) {
        (Some(a), Some(b)) => l_infinity(&a, &b),
        _ => Err(CompareError::TooFewPoints { found: 0 }),
    };
    let without = |list: &[&Pcf], i: usize| -> Vec<Pcf> {
        list.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, c)| (*c).clone()).collect()
    };
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
