//! Bootstrap intervals of statistics of clustered values: entire clusters are drawn at random, and
//! the spread of the statistic over the resamples gives its interval.
//!
//! 1. Draw as many clusters as there are, with replacement, and compute every statistic; repeat.
//! 2. Leave each cluster out in turn (jackknife), which shows how skewed a statistic is.
//! 3. Read off the quantiles of the resamples at levels corrected for bias and skewness (BCa; Efron
//!    1987, Journal of the American Statistical Association 82:171,
//!    <https://doi.org/10.1080/01621459.1987.10478410>).

use crate::numeric::linear_quantile;
use crate::numeric::mean;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use statrs::distribution::{ContinuousCDF, Normal};

/// Interval as an array of its lower and its upper end.
pub type Interval = [f64; 2];

/// Default number of resamples for [`bootstrap()`]. With 5000, 125 resamples lie in each tail of a
/// 95 % interval.
pub const RESAMPLES: usize = 5000;

/// Fraction of the resamples that lie below a 95 % interval, and fraction that lie above it.
const TAIL: f64 = 0.025;

/// Returns the 95 % bootstrap intervals of several statistics at once, bias-corrected and
/// accelerated (BCa; Efron 1987, <https://doi.org/10.1080/01621459.1987.10478410>).
///
/// Each entry of `clusters` holds the indices of values that belong together, such as the images of
/// one subject. A resample consists of `clusters.len()` entire clusters, drawn with replacement.
/// `statistics` takes the indices in a resample and returns every statistic, or `None` for a
/// statistic that is undefined there. Resamples in which a statistic is undefined do not enter its
/// interval.
///
/// The interval of a statistic is `None` if there are fewer than two clusters, or if the statistic
/// of all values together is undefined.
pub fn bootstrap(
    clusters: &[Vec<usize>],
    resamples: usize,
    rng: &mut ChaCha8Rng,
    statistics: impl Fn(&[usize]) -> Vec<Option<f64>>,
) -> Vec<Option<Interval>> {
    let all: Vec<usize> = clusters.iter().flatten().copied().collect();
    let estimates = statistics(&all);
    if clusters.len() < 2 {
        return vec![None; estimates.len()];
    }
    let mut drawn = vec![Vec::with_capacity(resamples); estimates.len()];
    let mut indexes = Vec::with_capacity(all.len());
    for _ in 0..resamples {
        indexes.clear();
        for _ in clusters {
            indexes.extend_from_slice(&clusters[rng.random_range(0..clusters.len())]);
        }
        keep_finite(&mut drawn, statistics(&indexes));
    }
    let mut left_out = vec![Vec::with_capacity(clusters.len()); estimates.len()];
    for k in 0..clusters.len() {
        let others = clusters.iter().enumerate().filter(|(i, _)| *i != k).flat_map(|(_, c)| c);
        keep_finite(&mut left_out, statistics(&others.copied().collect::<Vec<_>>()));
    }
    let normal = Normal::standard();
    estimates
        .into_iter()
        .zip(drawn.iter_mut().zip(&left_out))
        .map(|(estimate, (drawn, left_out))| bca(estimate?, drawn, left_out, &normal))
        .collect()
}

/// Appends each value to the list of its statistic, unless the value is undefined or not finite.
fn keep_finite(kept: &mut [Vec<f64>], values: Vec<Option<f64>>) {
    for (kept, value) in kept.iter_mut().zip(values) {
        kept.extend(value.filter(|v| v.is_finite()));
    }
}

/// Returns the BCa interval of a statistic. `estimate` is the statistic of all clusters. `drawn`
/// contains its values in the resamples, and `left_out` its values with each cluster left out in
/// turn.
fn bca(estimate: f64, drawn: &mut [f64], left_out: &[f64], normal: &Normal) -> Option<Interval> {
    drawn.sort_unstable_by(f64::total_cmp);
    let below = drawn.partition_point(|v| *v < estimate);
    let equal = drawn.partition_point(|v| *v <= estimate) - below;
    let share = (below as f64 + equal as f64 / 2.) / drawn.len() as f64;
    let middle = mean(left_out).unwrap_or(estimate);
    let sum = |power: i32| left_out.iter().map(|v| (middle - v).powi(power)).sum::<f64>();
    let spread = sum(2);
    // Efron's acceleration, a sixth of the skewness of the jackknife values
    let acceleration = if spread > 0. { sum(3) / (6. * spread.powf(1.5)) } else { 0. };
    let bias = normal.inverse_cdf(share);
    let tail = |tail: f64| {
        let z = bias + normal.inverse_cdf(tail);
        let corrected = normal.cdf(bias + z / (1. - acceleration * z));
        // If all resamples lie on one side of the estimate, the bias is infinite and the correction
        // is undefined: the plain quantile of the resamples is used instead.
        if bias.is_finite() && corrected.is_finite() { corrected } else { tail }
    };
    Some([linear_quantile(drawn, tail(TAIL))?, linear_quantile(drawn, tail(1. - TAIL))?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, Exp1};

    fn rng(seed: u64) -> ChaCha8Rng {
        ChaCha8Rng::seed_from_u64(seed)
    }

    fn singles(n: usize) -> Vec<Vec<usize>> {
        (0..n).map(|i| vec![i]).collect()
    }

    fn of_mean(values: &[f64], clusters: &[Vec<usize>], seed: u64) -> Option<Interval> {
        let statistic = |at: &[usize]| vec![mean(&at.iter().map(|&i| values[i]).collect::<Vec<_>>())];
        bootstrap(clusters, 2000, &mut rng(seed), statistic)[0]
    }

    #[test]
    fn interval_of_a_constant_is_the_constant() {
        assert_eq!(of_mean(&[0.25; 12], &singles(12), 1), Some([0.25, 0.25]));
    }

    #[test]
    fn one_cluster_tells_nothing_of_its_scatter() {
        assert_eq!(of_mean(&[1., 2., 3.], &[vec![0, 1, 2]], 1), None);
        assert_eq!(of_mean(&[], &[], 1), None);
    }

    #[test]
    fn clusters_of_equal_images_count_as_one_image_each() {
        let values: Vec<f64> = (0..60).map(|i| f64::from(i / 10)).collect();
        let subjects: Vec<Vec<usize>> = (0..6).map(|s| (10 * s..10 * s + 10).collect()).collect();
        let by_subject = of_mean(&values, &subjects, 3).unwrap();
        let six: Vec<f64> = (0..6).map(f64::from).collect();
        assert_eq!(by_subject, of_mean(&six, &singles(6), 3).unwrap());
        let by_image = of_mean(&values, &singles(60), 3).unwrap();
        assert!(by_subject[1] - by_subject[0] > 2. * (by_image[1] - by_image[0]));
    }

    #[test]
    fn intervals_of_a_skewed_mean_cover_it_about_as_often_as_they_say() {
        let mut source = rng(5);
        let covered = (0..400)
            .filter(|&seed| {
                let values: Vec<f64> = (0..30).map(|_| Exp1.sample(&mut source)).collect();
                let [low, high] = of_mean(&values, &singles(30), seed).unwrap();
                low <= 1. && 1. <= high
            })
            .count();
        println!("{covered} of 400 cover the mean");
        assert!((368..=392).contains(&covered), "{covered}");
    }
}
