//! Monte Carlo test of whether a mosaic could be a realisation of a sampler, judged by its pair
//! correlation function.
//!
//! 1. Simulate the sampler with the mosaic's own number of points and window.
//! 2. Compute the l-infinity distance of every curve, the mosaic's included, to the mean of all
//!    other curves, and find the rank of the mosaic's distance.
//! 3. Test the mosaic's curve against the global envelope of the simulated curves, by extreme rank
//!    length (Myllymäki et al. 2017, <https://doi.org/10.1111/rssb.12172>).
//!
//! Both p-values are exact, as all curves are treated alike (Barnard 1963, in the discussion of
//! Bartlett, <https://doi.org/10.1111/j.2517-6161.1963.tb00508.x>).

use super::{CompareError, curve, draw, l_infinity};
use crate::geometry::Window;
use crate::numeric::stepped_quantile;
use crate::sample::Sampler;
use crate::stats::{Deviation, Moments, Pcf, PcfOptions, moments, nearest_neighbours, rank_envelope};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// Step to whose multiples g is rounded before the envelope test.
///
/// Where a sampler makes no pairs, all simulated curves are exactly equal. Without rounding, a
/// negligible difference there would count as extreme.
const RESOLUTION: f64 = 1e-3;

/// Options of a verdict: number of simulations and significance level.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct VerdictOptions {
    /// Number of simulations per sampler: 39 to 9999, default 199. The smallest p-value possible is
    /// 1 / (`simulations` + 1), so .025 for 39 simulations and .005 for 199.
    pub simulations: usize,
    /// Significance level of the test and of the envelope: a mosaic differs from a sampler if its
    /// p-value is at most `level`. Greater than 0 and less than .5, default .05.
    pub level: f64,
}

impl Default for VerdictOptions {
    fn default() -> Self {
        Self { simulations: 199, level: 0.05 }
    }
}

impl VerdictOptions {
    /// Checks that every option is in its range.
    ///
    /// # Errors
    /// Fails if an option is out of its range; the error states the ranges.
    pub fn validate(&self) -> Result<(), CompareError> {
        if (39..=9_999).contains(&self.simulations) && self.level > 0. && self.level < 0.5 {
            return Ok(());
        }
        Err(CompareError::Simulations { found: self.simulations })
    }
}

/// Result of comparing a mosaic's pair correlation function with those of simulations of a sampler.
///
/// Two patterns of the same sampler differ too, and the more so the fewer points they have: at 300
/// points their l-infinity distance is .08–.09. So there is no fixed distance below which two
/// patterns are the same. The simulations have the mosaic's own number of points and window, and
/// thus show which distance is usual.
#[derive(Clone, Debug, PartialEq)]
pub struct SamplerVerdict {
    /// Name of the sampler.
    pub sampler: String,
    /// Number of simulations with which the mosaic was compared.
    pub simulations: usize,
    /// Smallest and largest number of points in a simulation. It may differ from that of the
    /// mosaic, since some samplers can only make certain numbers of points.
    pub points: (usize, usize),
    /// l-infinity distance between the mosaic's curve and the mean of all simulated curves.
    pub l_infinity: f64,
    /// Usual l-infinity distance: the median over the simulations of the distance between a
    /// simulated curve and the mean of all other curves, the mosaic's included.
    pub l_infinity_usual: f64,
    /// Large but still plausible l-infinity distance: the 95 % quantile over the simulations of the
    /// distance between a simulated curve and the mean of all other curves, the mosaic's included.
    pub l_infinity_most: f64,
    /// p-value by l-infinity: fraction of all curves, the mosaic's included, that lie at least as
    /// far from the mean of the other curves as the mosaic's curve does.
    pub p_l_infinity: f64,
    /// p-value of the global envelope test by extreme rank length. The test judges g at each
    /// distance r by the scatter of the simulations at that r. Before the test, g is rounded to
    /// three decimals.
    pub p_envelope: f64,
    /// Significance level of the test and of the envelope, copied from [`VerdictOptions`].
    pub level: f64,
    /// Ranges of distance r, in hexagonal spacings, in which the mosaic's g(r) lies outside the
    /// envelope.
    pub outside: Vec<(f64, f64)>,
    /// Mean and standard deviation of the regularity indices of the simulations (all points, sample
    /// standard deviation).
    pub ri: Moments,
    /// Band that contains the simulated curves but for the most extreme ones, whose fraction is at
    /// most `level`.
    pub envelope: Envelope,
}

/// Global envelope of simulated pair correlation functions, at the same distances as the mosaic's
/// curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    /// Distances r in hexagonal spacings.
    pub r: Vec<f64>,
    /// Mean of the simulated curves, one value per distance.
    pub mean: Vec<f64>,
    /// Lower edge of the band, one value per distance.
    pub low: Vec<f64>,
    /// Upper edge of the band, one value per distance.
    pub high: Vec<f64>,
}

impl SamplerVerdict {
    /// Returns whether the mosaic could be a realisation of the sampler: the p-value of the
    /// envelope test is above the significance level.
    pub fn alike(&self) -> bool {
        self.p_envelope > self.level
    }
}

/// Pair correlation function, number of points and regularity index of one simulation.
struct Simulation {
    pcf: Pcf,
    n: usize,
    ri: Option<f64>,
}

/// Tests whether a mosaic of `n` points in `window`, with the pair correlation function `mosaic`,
/// could be a realisation of `sampler`.
///
/// The sampler is simulated with the same `n` and window. All curves, the mosaic's included, are
/// treated alike, so both p-values are exact Monte Carlo p-values (Barnard 1963; Myllymäki et al.
/// 2017, <https://doi.org/10.1111/rssb.12172>). Each simulation has a random generator of its own,
/// seeded by a hash of `seed`, the sampler's name, `n`, the window and the number of the
/// simulation; the result is the same for any number of threads.
///
/// # Errors
/// Fails if an option is out of range, the sampler cannot fill the window, or the mosaic's curve
/// was estimated with other options than `pcf_options`.
pub fn verdict(
    mosaic: &Pcf,
    n: usize,
    window: &Window,
    sampler: &dyn Sampler,
    pcf_options: &PcfOptions,
    options: &VerdictOptions,
    seed: u64,
) -> Result<SamplerVerdict, CompareError> {
    options.validate()?;
    let base = seed_of(sampler.name(), n, window, seed);
    let simulations = (0..options.simulations)
        .into_par_iter()
        .map(|k| {
            let mut rng =
                ChaCha8Rng::from_seed(base.clone().chain_update((k as u64).to_le_bytes()).finalize().into());
            let points = draw(sampler, n, window, &mut rng)?;
            let pcf = curve(sampler, &points, window, pcf_options)?;
            let nearest = nearest_neighbours(&points, window);
            let ri = moments(&nearest.distances, Deviation::Sample).ri;
            Ok(Simulation { pcf, n: points.len(), ri })
        })
        .collect::<Result<Vec<_>, _>>()?;

    let curves: Vec<&[f64]> = simulations.iter().map(|s| s.pcf.g.as_slice()).collect();
    // sums over all curves, the mosaic's included; without one curve they give the mean of the
    // others
    let sums: Vec<f64> = (0..mosaic.g.len())
        .map(|bin| curves.iter().filter_map(|g| g.get(bin)).sum::<f64>() + mosaic.g[bin])
        .collect();
    let others = simulations.len() as f64;
    let from_others = |g: &[f64]| {
        let away = g.iter().zip(&sums).map(|(g, sum)| (g - (sum - g) / others).abs());
        away.fold(0., f64::max)
    };
    let mean: Vec<f64> = sums.iter().zip(&mosaic.g).map(|(sum, g)| (sum - g) / others).collect();
    let mean_pcf = match simulations.first() {
        Some(first) => Pcf { g: mean.clone(), ..first.pcf.clone() },
        None => return Err(CompareError::Simulations { found: 0 }),
    };
    // also returns an error for curves that cannot be compared
    let distance = l_infinity(mosaic, &mean_pcf)?;
    let mut usual: Vec<f64> = curves.iter().map(|g| from_others(g)).collect();
    usual.sort_unstable_by(f64::total_cmp);
    let as_far = usual.len() - usual.partition_point(|&d| d < distance);
    let seen = |g: &[f64]| g.iter().map(|g| (g / RESOLUTION).round() * RESOLUTION).collect::<Vec<f64>>();
    let (mosaic_seen, curves_seen) = (seen(&mosaic.g), curves.iter().map(|g| seen(g)).collect::<Vec<_>>());
    let curves_seen: Vec<&[f64]> = curves_seen.iter().map(Vec::as_slice).collect();
    let Some(envelope) = rank_envelope(&mosaic_seen, &curves_seen, options.level) else {
        return Err(CompareError::Simulations { found: curves.len() });
    };
    let outside = envelope.outside(&mosaic_seen).into_iter().map(|(from, to)| (mosaic.r[from], mosaic.r[to]));
    let indexes: Vec<f64> = simulations.iter().filter_map(|s| s.ri).collect();
    let made = || simulations.iter().map(|s| s.n);
    Ok(SamplerVerdict {
        sampler: sampler.name().to_owned(),
        simulations: simulations.len(),
        points: (made().min().unwrap_or(0), made().max().unwrap_or(0)),
        l_infinity: distance,
        l_infinity_usual: stepped_quantile(&usual, 0.5),
        l_infinity_most: stepped_quantile(&usual, 0.95),
        p_l_infinity: (as_far + 1) as f64 / (usual.len() + 1) as f64,
        p_envelope: envelope.p_value,
        level: options.level,
        outside: outside.collect(),
        ri: moments(&indexes, Deviation::Sample),
        envelope: Envelope { r: mosaic.r.clone(), mean, low: envelope.low, high: envelope.high },
    })
}

/// Starts the hash that seeds the random generators of the simulations: from `seed`, the sampler's
/// name, `n` and the window. The caller adds the number of the simulation.
fn seed_of(sampler: &str, n: usize, window: &Window, seed: u64) -> Sha256 {
    let bounds = window.bounds();
    let mut hash = Sha256::new_with_prefix(b"verdict");
    hash.update(seed.to_le_bytes());
    hash.update((sampler.len() as u64).to_le_bytes());
    hash.update(sampler);
    hash.update((n as u64).to_le_bytes());
    [bounds.x0(), bounds.y0(), bounds.x1(), bounds.y1()].iter().for_each(|v| hash.update(v.to_le_bytes()));
    match window {
        Window::Polygon(polygon) => hash.update(polygon.bytes()),
        Window::Rectangle(_) | Window::Torus(_) => hash.update([u8::from(window.is_torus())]),
    }
    hash
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use crate::sample::{SampleError, sampler};
    use crate::stats::{StatsError, pcf};

    const N: usize = 150;

    fn pattern(name: &str, seed: u64) -> Result<Vec<Point>, SampleError> {
        sampler(name)?.sample(N, &Window::unit_square(), &mut ChaCha8Rng::seed_from_u64(seed))
    }

    fn curve(name: &str, seed: u64) -> Result<Pcf, StatsError> {
        pcf(&pattern(name, seed).unwrap_or_default(), &Window::unit_square(), &PcfOptions::default())
    }

    fn judge(mosaic: &Pcf, name: &str, simulations: usize) -> SamplerVerdict {
        let options = VerdictOptions { simulations, ..VerdictOptions::default() };
        let window = Window::unit_square();
        verdict(mosaic, N, &window, sampler(name).unwrap(), &mosaic.options, &options, 1).unwrap()
    }

    #[test]
    fn a_sampler_s_own_patterns_are_as_it_is_in_nineteen_of_twenty() {
        let rejected = |p: fn(&SamplerVerdict) -> f64| {
            move |found: &[SamplerVerdict]| found.iter().filter(|v| p(v) <= 0.05).count()
        };
        let found: Vec<SamplerVerdict> =
            (0..60).map(|seed| judge(&curve("bridson", seed).unwrap(), "bridson", 39)).collect();
        // 3 of 60 are expected; 9 or more have a probability of 1/300
        assert!(rejected(|v| v.p_envelope)(&found) < 9);
        assert!(rejected(|v| v.p_l_infinity)(&found) < 9);
    }

    #[test]
    fn another_process_is_told_apart_and_it_is_said_where() {
        let found = judge(&curve("jittered", 1).unwrap(), "dart-throwing", 99);
        assert_eq!((found.p_envelope, found.p_l_infinity), (0.01, 0.01));
        assert!(!found.alike());
        // dart throwing has no pairs closer than its radius, a jittered grid has such pairs
        let (from, to) = found.outside[0];
        assert!(from < 0.3 && to > 0.4, "{:?}", found.outside);
        assert!((found.ri.mean.unwrap() - 12.).abs() < 2., "{:?}", found.ri);
    }

    #[test]
    fn usual_distance_is_that_of_two_patterns_of_one_process() {
        let found = judge(&curve("dart-throwing", 3).unwrap(), "dart-throwing", 199);
        // measured: .16 at 100 points, .08–.09 at 300
        assert!((0.08..0.16).contains(&found.l_infinity_usual), "{}", found.l_infinity_usual);
        assert!(found.l_infinity_most > found.l_infinity_usual);
        assert_eq!(found.points, (N, N));
    }

    #[test]
    fn threads_do_not_matter() {
        let mosaic = curve("bridson", 5).unwrap();
        let expected = judge(&mosaic, "jittered", 39);
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            assert_eq!(pool.install(|| judge(&mosaic, "jittered", 39)), expected);
        }
    }

    #[test]
    fn what_cannot_be_judged_says_why() {
        let mosaic = curve("uniform", 1).unwrap();
        let few = VerdictOptions { simulations: 10, ..VerdictOptions::default() };
        let uniform = sampler("uniform").unwrap();
        let window = Window::unit_square();
        let error = verdict(&mosaic, N, &window, uniform, &mosaic.options, &few, 1).unwrap_err();
        assert!(error.to_string().contains("39"), "{error}");
        let other = PcfOptions { bins: 100, ..mosaic.options };
        let error = verdict(&mosaic, N, &window, uniform, &other, &VerdictOptions::default(), 1);
        assert!(matches!(error, Err(CompareError::NotComparable { .. })), "{error:?}");
    }
}
