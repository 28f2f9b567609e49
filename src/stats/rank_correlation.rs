//! Spearman's rank correlation with a permutation test.

use rand::Rng;
use rand::seq::SliceRandom;

/// Smallest number of pairs for which a correlation is tested. With 4 pairs, even a perfect
/// correlation has p = .08, so nothing could be significant.
pub const FEWEST_PAIRS: usize = 5;
/// Largest number of pairs for which every order of the values is tried; 8 values have 40 320
/// orders. For more pairs, random orders are drawn.
const MOST_EXACT: usize = 8;
/// Number of random orders that are drawn for more than [`MOST_EXACT`] pairs. With the observed
/// order they are 10 000, so p-values are multiples of .0001.
const PERMUTATIONS: usize = 9_999;

/// Strength and significance of a monotonic relation between two quantities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RankCorrelation {
    /// Number of pairs of values.
    pub n: usize,
    /// Spearman's rank correlation ρ, from −1 to 1; equal values share their mean rank.
    pub rho: f64,
    /// Two-sided p-value by permutation: the probability of a |ρ| at least as large as the observed
    /// |ρ| if the two quantities are independent.
    pub p_value: f64,
}

/// Computes Spearman's rank correlation and tests it by permutation, two-sided.
///
/// With at most 8 pairs, all orders are tried. With more pairs, 9 999 orders are drawn from `rng`,
/// and the observed order counts as one more.
///
/// Returns `None` for fewer than [`FEWEST_PAIRS`] pairs, for values that are not finite, or if one
/// of the quantities does not vary.
///
/// Source: Spearman (1904), <https://doi.org/10.2307/1412159>.
pub fn rank_correlation(pairs: &[(f64, f64)], rng: &mut dyn Rng) -> Option<RankCorrelation> {
    let n = pairs.len();
    if n < FEWEST_PAIRS || pairs.iter().any(|(x, y)| !(x.is_finite() && y.is_finite())) {
        return None;
    }
    let x = centred_ranks(pairs.iter().map(|p| p.0));
    let mut y = centred_ranks(pairs.iter().map(|p| p.1));
    let square = |v: &[f64]| v.iter().map(|a| a * a).sum::<f64>();
    let norm = (square(&x) * square(&y)).sqrt();
    if norm == 0. {
        return None;
    }
    let product = |y: &[f64]| x.iter().zip(y).map(|(a, b)| a * b).sum::<f64>();
    let observed = product(&y);
    // Centred ranks are multiples of ½, so sums of their products are exact and ties compare equal.
    let as_strong = |y: &[f64]| usize::from(product(y).abs() >= observed.abs());
    let p_value = if n <= MOST_EXACT {
        let (mut strong, mut all) = (0, 0);
        each_order(&mut y, n, &mut |y| {
            strong += as_strong(y);
            all += 1;
        });
        strong as f64 / f64::from(all)
    } else {
        let strong: usize = (0..PERMUTATIONS)
            .map(|_| {
                y.shuffle(rng);
                as_strong(&y)
            })
            .sum();
        (strong + 1) as f64 / (PERMUTATIONS + 1) as f64
    };
    Some(RankCorrelation { n, rho: observed / norm, p_value })
}

/// Returns the ranks of the values minus the mean rank; equal values share their mean rank.
fn centred_ranks(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let values: Vec<f64> = values.collect();
    let count = |of: &dyn Fn(f64) -> bool| values.iter().filter(|&&v| of(v)).count() as f64;
    // The number of smaller values minus the number of larger values is twice the centred rank.
    values.iter().map(|&v| (count(&|o| o < v) - count(&|o| o > v)) / 2.).collect()
}

/// Calls `visit` with every order of the first `k` values (algorithm of Heap 1963,
/// <https://doi.org/10.1093/comjnl/6.3.293>).
fn each_order(values: &mut [f64], k: usize, visit: &mut impl FnMut(&[f64])) {
    if k <= 1 {
        visit(values);
        return;
    }
    for i in 0..k {
        each_order(values, k - 1, visit);
        values.swap(if k.is_multiple_of(2) { i } else { 0 }, k - 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use std::collections::HashSet;

    fn of(pairs: &[(f64, f64)]) -> Option<RankCorrelation> {
        rank_correlation(pairs, &mut ChaCha8Rng::seed_from_u64(1))
    }

    #[test]
    fn perfect_order_of_five_has_two_orders_in_120_as_strong() {
        let rising: Vec<_> = (0..5).map(|i| (f64::from(i), f64::from(i * i))).collect();
        assert_eq!(of(&rising), Some(RankCorrelation { n: 5, rho: 1., p_value: 2. / 120. }));
        let falling: Vec<_> = rising.iter().map(|&(x, y)| (x, -y)).collect();
        assert_eq!(of(&falling).unwrap().rho, -1.);
    }

    #[test]
    fn ties_share_their_rank() {
        let found = of(&[(1., 2.), (2., 2.), (2., 3.), (4., 1.), (5., 5.), (6., 6.)]).unwrap();
        assert!((found.rho - 41. / 68.).abs() < 1e-12, "{}", found.rho);
    }

    #[test]
    fn sampled_orders_agree_with_all_orders() {
        let pairs: Vec<_> = (0..8).map(|i| (f64::from(i), f64::from((i * 5) % 8))).collect();
        let exact = of(&pairs).unwrap().p_value;
        let longer: Vec<_> = (0..200).map(|i| (f64::from(i), f64::from((i * 77) % 200))).collect();
        assert!(of(&longer).unwrap().p_value > 0.05);
        assert!(exact > 0.05 && exact < 1.);
    }

    #[test]
    fn every_order_comes_once() {
        let mut seen = HashSet::new();
        each_order(&mut [1., 2., 3., 4., 5.], 5, &mut |y| {
            assert!(seen.insert(y.iter().map(|v| *v as u8).collect::<Vec<_>>()));
        });
        assert_eq!(seen.len(), 120);
    }

    #[test]
    fn what_has_no_correlation_is_none() {
        assert_eq!(of(&[(1., 1.); 4]), None);
        assert_eq!(of(&[(1., 1.), (1., 2.), (1., 3.), (1., 4.), (1., 5.)]), None);
        assert_eq!(of(&[(1., f64::NAN), (1., 2.), (3., 3.), (2., 4.), (5., 5.)]), None);
    }
}
