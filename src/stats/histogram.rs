use crate::numeric::nearest_rank;
use serde::{Deserialize, Serialize};

/// Smallest and largest number of bins: fewer bins hide the shape, more show only noise.
const BINS: (usize, usize) = (5, 60);

/// Histogram: the number of values in each of several bins.
///
/// A bin includes its lower edge; the last bin includes both edges.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Histogram {
    /// Edges of the bins in rising order, one edge more than there are bins; empty without values.
    pub edges: Vec<f64>,
    /// Number of values in each bin.
    pub counts: Vec<usize>,
}

impl Histogram {
    /// Counts the values in bins of equal width from the smallest to the largest value.
    ///
    /// Values that are not finite are left out. The width is 2 × interquartile range / ∛n, with the
    /// number of bins bounded to 5–60 (Freedman & Diaconis 1981,
    /// <https://doi.org/10.1007/BF01025868>). If all values are equal, there is a single bin.
    pub fn new(values: &[f64]) -> Self {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let (Some(&low), Some(&high)) = (sorted.first(), sorted.last()) else {
            return Self { edges: Vec::new(), counts: Vec::new() };
        };
        let range = high - low;
        if !(range > f64::EPSILON * high.abs().max(low.abs()) && range.is_finite()) {
            // If all values are equal, the bin is 1 % of the value wide, because a bin needs a
            // width.
            let half = (low.abs() * 0.005).max(f64::MIN_POSITIVE);
            return Self { edges: vec![low - half, low + half], counts: vec![sorted.len()] };
        }
        let quantile = |q: f64| nearest_rank(&sorted, q).unwrap_or(low);
        let width = 2. * (quantile(0.75) - quantile(0.25)) / (sorted.len() as f64).cbrt();
        // If the middle half of the values is equal, the width is 0; then 1 + log₂ n bins are used
        // (Sturges 1926, <https://doi.org/10.1080/01621459.1926.10502161>).
        let ideal =
            if width > 0. { (range / width).ceil() } else { 1. + (sorted.len() as f64).log2().ceil() };
        let bins = (ideal.min(BINS.1 as f64) as usize).max(BINS.0);
        let edges: Vec<f64> = (0..=bins).map(|i| low + range * i as f64 / bins as f64).collect();
        let mut counts = vec![0; bins];
        for v in sorted {
            // Bins are searched by the stored edges: a division could round to the neighbouring
            // bin.
            let bin = edges[1..bins].partition_point(|&e| e <= v);
            counts[bin] += 1;
        }
        Self { edges, counts }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn bins_follow_freedman_and_diaconis() {
        // 1000 evenly spaced values on 0..1: interquartile range just below ½, width just below
        // 1/10.
        let values: Vec<f64> = (0..1000).map(|i| f64::from(i) / 999.).collect();
        assert_eq!(Histogram::new(&values).counts.len(), 11);
        assert_eq!(Histogram::new(&values[..2]).counts.len(), 5);
    }

    #[test]
    fn no_values_no_bins_and_equal_values_one() {
        assert!(Histogram::new(&[f64::NAN]).counts.is_empty());
        assert_eq!(Histogram::new(&[3.; 7]).counts, [7]);
        assert_eq!(Histogram::new(&[0.; 2]).counts, [2]);
    }

    proptest! {
        #[test]
        fn every_finite_value_is_counted_once_between_rising_edges(
            values in prop::collection::vec(prop_oneof![-1e3..1e3f64, Just(f64::NAN), Just(1.)], 0..80),
        ) {
            let histogram = Histogram::new(&values);
            let finite = values.iter().filter(|v| v.is_finite()).count();
            prop_assert_eq!(histogram.counts.iter().sum::<usize>(), finite);
            prop_assert!(histogram.edges.windows(2).all(|e| e[0] < e[1]));
            prop_assert!(histogram.counts.len() <= BINS.1);
        }
    }
}
