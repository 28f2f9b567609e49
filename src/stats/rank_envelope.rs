//! Global envelope test by extreme rank length: one p-value for an entire observed curve among
//! simulated curves (Myllymäki et al. 2017, J. R. Stat. Soc. B 79, 381–404,
//! <https://doi.org/10.1111/rssb.12172>).

/// Result of comparing an observed curve with simulated curves: the global p-value and envelope.
#[derive(Clone, Debug, PartialEq)]
pub struct RankEnvelope {
    /// Probability that a curve of the simulated process is at least as extreme as the observed
    /// curve, by extreme rank length.
    pub p_value: f64,
    /// Lower edge of the envelope, one value per bin.
    pub low: Vec<f64>,
    /// Upper edge of the envelope, one value per bin.
    pub high: Vec<f64>,
}

impl RankEnvelope {
    /// Returns the ranges of bins in which `curve` is outside the envelope, each as (first bin,
    /// last bin).
    pub fn outside(&self, curve: &[f64]) -> Vec<(usize, usize)> {
        let mut stretches: Vec<(usize, usize)> = Vec::new();
        for (bin, value) in curve.iter().enumerate() {
            if (self.low[bin]..=self.high[bin]).contains(value) {
                continue;
            }
            match stretches.last_mut() {
                Some((_, last)) if *last + 1 == bin => *last = bin,
                _ => stretches.push((bin, bin)),
            }
        }
        stretches
    }
}

/// Tests an observed curve against simulated curves by extreme rank length.
///
/// In every bin, all curves, observed and simulated, are ranked both from the smallest value and
/// from the largest; a curve takes the smaller of its two ranks, and tied curves share their mean
/// rank. The ranks of each curve are sorted in rising order, and curves are compared
/// lexicographically by their sorted ranks: the smaller, the more extreme. The p-value is the share
/// of curves, including the observed curve itself, that are at least as extreme as the observed
/// curve.
///
/// The most extreme curves, at most the share `level` of all, are then removed. The envelope is the
/// range of the remaining curves in every bin. The observed curve lies within it in every bin if
/// and only if its p-value is above `level` (up to ties).
///
/// Returns `None` without simulations, or if the curves differ in length.
///
/// Source: Myllymäki et al. (2017), <https://doi.org/10.1111/rssb.12172>.
pub fn rank_envelope(observed: &[f64], simulated: &[&[f64]], level: f64) -> Option<RankEnvelope> {
    let curves: Vec<&[f64]> = [observed].into_iter().chain(simulated.iter().copied()).collect();
    let (count, bins) = (curves.len(), observed.len());
    if count < 2 || curves.iter().any(|c| c.len() != bins) {
        return None;
    }
    let mut ranks = vec![Vec::with_capacity(bins); count];
    let mut order: Vec<usize> = (0..count).collect();
    (0..bins).for_each(|bin| {
        order.sort_unstable_by(|&a, &b| curves[a][bin].total_cmp(&curves[b][bin]));
        let mut first = 0;
        while first < count {
            let value = curves[order[first]][bin];
            let tied = order[first..].iter().take_while(|&&c| curves[c][bin] == value).count();
            // Twice the rank is stored, 2 to 2·count, so that the mean rank of tied curves is an
            // integer.
            let from_below = 2 * first + tied + 1;
            let rank = from_below.min(2 * (count + 1) - from_below);
            order[first..first + tied].iter().for_each(|&c| ranks[c].push(rank));
            first += tied;
        }
    });
    ranks.iter_mut().for_each(|r| r.sort_unstable());
    let mut extremes: Vec<&Vec<usize>> = ranks.iter().collect();
    extremes.sort_unstable();
    let p_value = |of: &Vec<usize>| extremes.partition_point(|e| *e <= of) as f64 / count as f64;
    let kept: Vec<&[f64]> =
        curves.iter().zip(&ranks).filter(|(_, r)| p_value(r) > level).map(|(c, _)| *c).collect();
    let hull = |start: f64, wider: fn(f64, f64) -> f64| {
        (0..bins).map(|bin| kept.iter().map(|c| c[bin]).fold(start, wider)).collect()
    };
    Some(RankEnvelope {
        p_value: p_value(&ranks[0]),
        low: hull(f64::INFINITY, f64::min),
        high: hull(f64::NEG_INFINITY, f64::max),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    /// Simulates curves in which neighbouring bins are correlated.
    fn curves(count: usize, seed: u64) -> Vec<Vec<f64>> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut curve = || {
            let mut value = 0.;
            (0..50)
                .map(|_| {
                    let step: f64 = StandardNormal.sample(&mut rng);
                    value = 0.8 * value + step;
                    value
                })
                .collect()
        };
        (0..count).map(|_| curve()).collect()
    }

    fn test(all: &[Vec<f64>]) -> RankEnvelope {
        let simulated: Vec<&[f64]> = all[1..].iter().map(Vec::as_slice).collect();
        rank_envelope(&all[0], &simulated, 0.05).unwrap()
    }

    #[test]
    fn one_curve_in_twenty_of_the_same_process_is_rejected() {
        let rejected = (0..400).filter(|&seed| test(&curves(100, seed)).p_value <= 0.05).count();
        // 20 are expected, with a standard deviation of 4.4.
        assert!((8..=34).contains(&rejected), "{rejected}");
    }

    #[test]
    fn a_curve_leaves_the_envelope_if_and_only_if_it_is_rejected() {
        for seed in 0..200 {
            let all = curves(100, seed);
            let envelope = test(&all);
            assert_eq!(envelope.p_value <= 0.05, !envelope.outside(&all[0]).is_empty(), "seed {seed}");
        }
    }

    #[test]
    fn a_bump_is_found_where_it_is() {
        let mut all = curves(200, 1);
        (20..40).for_each(|bin| all[0][bin] += 12.);
        let envelope = test(&all);
        assert_eq!(envelope.p_value, 1. / 200.);
        assert_eq!(envelope.outside(&all[0]), [(20, 39)]);
    }

    #[test]
    fn curves_without_scatter_are_all_alike() {
        let flat = vec![vec![0.; 10]; 20];
        let envelope = test(&flat);
        assert_eq!((envelope.p_value, envelope.low[3], envelope.high[3]), (1., 0., 0.));
        let mut other = flat;
        other[0][4] = 1.;
        assert_eq!(test(&other).p_value, 1. / 20.);
        assert_eq!(rank_envelope(&[1.], &[], 0.05), None);
    }
}
