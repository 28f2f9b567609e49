//! Paired permutation test by flipping signs: if two methods do not differ, every difference could
//! as well have had the other sign.
//!
//! 1. Sum the differences of each cluster, whose signs flip together.
//! 2. Try all choices of signs if there are at most 16 clusters, otherwise a random sample of them.
//! 3. Count the choices of signs whose sum lies at least as far from zero as the observed sum.
//!
//! Source: Fisher (1935), The Design of Experiments, section 21.

use crate::numeric::mean;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// Largest number of clusters for which every choice of signs is tried: 2¹⁶ = 65,536 choices, about
/// as many as are drawn at random for more clusters ([`DRAWN`]).
const MOST_EXACT: usize = 16;
/// Number of choices of signs that are drawn at random if there are more than [`MOST_EXACT`]
/// clusters. The observed signs are counted as one more choice, so p is a multiple of 1/50,000.
const DRAWN: usize = 49_999;

/// Tests whether the mean of paired differences is zero, by flipping their signs, and returns the
/// two-sided p-value.
///
/// The p-value is the fraction of choices of signs for which the mean difference lies at least as
/// far from zero as the observed one (Fisher 1935, The Design of Experiments, section 21). Each
/// entry of `clusters` holds indices into `differences`. The differences of one cluster, such as
/// those of the images of one subject, change sign together.
///
/// For n ≤ 16 clusters, all choices are tried and p is exact; the smallest p-value possible is 2 /
/// 2ⁿ: .06 for 5 clusters, .008 for 8. For more clusters, 49,999 choices are drawn and p is (1 +
/// the number of drawn choices at least as far from zero) / 50,000.
///
/// A cluster whose differences sum to 0 does not count as one of the n clusters, as its sign
/// changes nothing. If all clusters sum to 0, p is 1. Indices beyond the end of `differences` are
/// ignored. Returns `None` if there are no differences.
pub fn sign_flip_test(differences: &[f64], clusters: &[Vec<usize>], rng: &mut ChaCha8Rng) -> Option<f64> {
    mean(differences)?;
    let sums: Vec<f64> = clusters
        .iter()
        // `get` instead of `[i]`: the library must not panic, whatever its caller passes
        .map(|c| c.iter().filter_map(|&i| differences.get(i)).sum())
        .filter(|sum: &f64| *sum != 0.)
        .collect();
    // sums that differ only by rounding count as equally far from zero
    let rounding = 1e-12 * sums.iter().map(|s| s.abs()).sum::<f64>();
    let observed = sums.iter().sum::<f64>().abs() - rounding;
    let is_as_far = |flipped: f64| flipped.abs() >= observed;
    if sums.len() <= MOST_EXACT {
        let choices = 1u32 << sums.len();
        let flipped = |choice: u32| -> f64 {
            sums.iter().enumerate().map(|(k, s)| if choice >> k & 1 == 1 { -s } else { *s }).sum()
        };
        let far = (0..choices).filter(|&choice| is_as_far(flipped(choice))).count();
        return Some(far as f64 / f64::from(choices));
    }
    let far = (0..DRAWN)
        .filter(|_| is_as_far(sums.iter().map(|s| if rng.random::<bool>() { -s } else { *s }).sum()))
        .count();
    Some((1 + far) as f64 / (1 + DRAWN) as f64)
}

/// Returns the smallest p-value that [`sign_flip_test`] can give for `clusters` clusters, none of
/// which has differences that sum to zero; 1 for no clusters.
///
/// For n ≤ 16 clusters it is 2 / 2ⁿ. Two of the 2ⁿ choices of signs always lie as far from zero as
/// the observed sum: the observed signs and their opposites. With fewer than 6 clusters, p is thus
/// above .05, whatever the data. For more than 16 clusters it is 1 / 50,000.
pub fn least_p(clusters: usize) -> f64 {
    match i32::try_from(clusters) {
        Ok(0) => 1.,
        Ok(n) if clusters <= MOST_EXACT => 2. / 2f64.powi(n),
        _ => 1. / (1 + DRAWN) as f64,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    fn p(differences: &[f64], clusters: &[Vec<usize>]) -> f64 {
        sign_flip_test(differences, clusters, &mut ChaCha8Rng::seed_from_u64(1)).unwrap()
    }

    fn singles(n: usize) -> Vec<Vec<usize>> {
        (0..n).map(|i| vec![i]).collect()
    }

    #[test]
    fn differences_of_one_sign_have_the_least_p_value_there_is() {
        for n in 1..=10 {
            let differences: Vec<f64> = (1..=n).map(f64::from).collect();
            let clusters = singles(differences.len());
            assert_eq!(p(&differences, &clusters), 2. / 2f64.powi(n));
            assert_eq!(least_p(clusters.len()), 2. / 2f64.powi(n));
        }
    }

    #[test]
    fn small_samples_have_the_p_values_counted_by_hand() {
        // the observed sum is 1 + 2 + 3 − 4 = 2; of the 16 sums ±1 ±2 ±3 ±4, all but the two that
        // are 0 lie at least that far from 0
        assert_eq!(p(&[1., 2., 3., -4.], &singles(4)), 14. / 16.);
        // the observed sum is 4 + 2 − 1 = 5; the 8 sums ±1 ±2 ±4 are the odd numbers from −7 to 7,
        // and −7, −5, 5 and 7 lie at least that far from 0
        assert_eq!(p(&[-1., 2., 4.], &singles(3)), 4. / 8.);
        assert_eq!(p(&[1., -1.], &singles(2)), 1.);
        assert_eq!(p(&[0., 0., 0.], &singles(3)), 1.);
    }

    /// The data are Darwin's: differences in height of 15 pairs of crossed and self-fertilised
    /// maize plants, in eighths of an inch.
    ///
    /// Their sum is 314. Fisher counts 863 of 32,768 choices of signs with a sum of 314 or more,
    /// and as many with −314 or less.
    #[test]
    fn darwins_maize_has_fishers_p_value() {
        let maize = [49., -67., 8., 16., 6., 23., 28., 41., 14., 29., 56., 24., 75., 60., -48.];
        assert_eq!(p(&maize, &singles(15)), 2. * 863. / 32_768.);
    }

    #[test]
    fn images_of_a_subject_change_sign_together() {
        let differences = [0.1; 20];
        let subjects: Vec<Vec<usize>> = (0..5).map(|s| (4 * s..4 * s + 4).collect()).collect();
        assert_eq!(p(&differences, &subjects), 2. / 32.);
    }

    #[test]
    fn drawn_signs_agree_with_all_signs() {
        let differences: Vec<f64> = (0..15).map(|i| f64::from((i * 7) % 15) - 5.5).collect();
        let exact = p(&differences, &singles(15));
        // two more differences that hardly matter raise the number of clusters above the exact
        // test's limit
        let more: Vec<f64> = differences.iter().copied().chain([1e-6, -1e-6]).collect();
        assert!((p(&more, &singles(17)) - exact).abs() < 0.01, "{exact}");
        let alike = vec![1.; 20];
        assert_eq!(p(&alike, &singles(20)), least_p(20));
        assert_eq!((least_p(0), least_p(17)), (1., 2e-5));
        assert_eq!(sign_flip_test(&[], &[], &mut ChaCha8Rng::seed_from_u64(1)), None);
    }
}
