//! Reliability of scores as probabilities: detections that score .8 should be right in 80 % of
//! cases.
//!
//! 1. Sort the detections into ten bins of the score.
//! 2. Compare the mean score of each bin with its fraction of hits.
//! 3. Summarise by the expected calibration error and the Brier score.

use crate::compare::Interval;
use serde::Serialize;

/// Number of bins of equal width into which the scores between 0 and 1 are divided.
const BINS: usize = 10;
/// Half-width of a two-sided 95 % interval, in standard deviations of a normal distribution.
const Z: f64 = 1.96;

/// Detections with scores in one interval (bin), compared with the marks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReliabilityBin {
    /// Lower end of the bin; a score of exactly `from` belongs to the bin.
    pub from: f64,
    /// Upper end of the bin; a score of exactly `to` belongs to the next bin, except that the last
    /// bin includes 1.
    pub to: f64,
    /// Number of detections in the bin.
    pub n: usize,
    /// Mean score of the detections in the bin; `None` for an empty bin.
    pub mean_score: Option<f64>,
    /// Fraction of the detections in the bin that are hits; `None` for an empty bin.
    pub hits: Option<f64>,
    /// 95 % interval of `hits` (Wilson 1927, <https://doi.org/10.1080/01621459.1927.10502953>),
    /// with detections taken as independent; `None` for an empty bin.
    pub hits_interval: Option<Interval>,
}

/// Comparison of the scores of detections, read as probabilities of a hit, with the hits observed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reliability {
    /// Number of detections judged.
    pub n: usize,
    /// Ten bins of equal width that divide the scores from 0 to 1, the lowest scores first.
    pub bins: Vec<ReliabilityBin>,
    /// Expected calibration error: mean over the bins of |fraction of hits − mean score|, weighted
    /// by the number of detections in the bin (Guo et al. 2017, eq. 3,
    /// <https://doi.org/10.48550/arXiv.1706.04599>).
    pub expected_calibration_error: f64,
    /// Brier score (1950): mean over the detections of (score − hit)², where hit is 1 or 0.
    pub brier: f64,
}

/// Computes the reliability of scores. Each score comes with a flag that is `true` if the detection
/// is a hit.
///
/// Returns `None` without detections, or if a score is not between 0 and 1.
pub fn reliability(scored: &[(f64, bool)]) -> Option<Reliability> {
    if scored.is_empty() || !scored.iter().all(|(score, _)| (0. ..=1.).contains(score)) {
        return None;
    }
    let mut members = vec![Vec::new(); BINS];
    for &(score, hit) in scored {
        members[((score * BINS as f64) as usize).min(BINS - 1)].push((score, hit));
    }
    let bins: Vec<_> = members.iter().enumerate().map(|(k, members)| bin(k, members)).collect();
    let n = scored.len() as f64;
    let off = |b: &ReliabilityBin| Some(b.n as f64 * (b.hits? - b.mean_score?).abs());
    let squares = scored.iter().map(|(score, hit)| (score - f64::from(*hit)).powi(2));
    Some(Reliability {
        n: scored.len(),
        expected_calibration_error: bins.iter().filter_map(off).sum::<f64>() / n,
        brier: squares.sum::<f64>() / n,
        bins,
    })
}

/// Summarises the detections `members` of bin number `k`.
fn bin(k: usize, members: &[(f64, bool)]) -> ReliabilityBin {
    let edge = |k: usize| k as f64 / BINS as f64;
    let n = members.len() as f64;
    let some = |value: f64| (!members.is_empty()).then_some(value);
    let hits = members.iter().filter(|m| m.1).count() as f64 / n;
    ReliabilityBin {
        from: edge(k),
        to: edge(k + 1),
        n: members.len(),
        mean_score: some(members.iter().map(|m| m.0).sum::<f64>() / n),
        hits: some(hits),
        hits_interval: (!members.is_empty()).then(|| wilson(hits, n)),
    }
}

/// Returns the 95 % Wilson score interval of a fraction `p` observed in `n` trials.
fn wilson(p: f64, n: f64) -> Interval {
    let squared = Z * Z / n;
    let centre = (p + squared / 2.) / (1. + squared);
    let reach = Z / (1. + squared) * (p * (1. - p) / n + squared / (4. * n)).sqrt();
    [(centre - reach).max(0.), (centre + reach).min(1.)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_four_detections_are_those_computed_by_hand() {
        let found = reliability(&[(0.95, true), (0.91, false), (0.2, false), (1., true)]).unwrap();
        let brier = (0.05f64.powi(2) + 0.91f64.powi(2) + 0.2f64.powi(2)) / 4.;
        assert!((found.brier - brier).abs() < 1e-15);
        // in the last bin 2 of 3 detections are hits, with a mean score of 2.86/3; in the third bin
        // the only detection, with a score of 0.2, is no hit
        let ece = ((2. - 2.86f64).abs() + 0.2) / 4.;
        assert!((found.expected_calibration_error - ece).abs() < 1e-15);
        assert_eq!(found.bins.iter().map(|b| b.n).collect::<Vec<_>>(), [0, 0, 1, 0, 0, 0, 0, 0, 0, 3]);
    }

    #[test]
    fn perfectly_calibrated_scores_have_no_calibration_error() {
        let scored: Vec<_> = (0..1000).map(|i| (0.75, i % 4 != 0)).collect();
        let found = reliability(&scored).unwrap();
        assert!(found.expected_calibration_error < 1e-12);
        assert!((found.brier - 0.1875).abs() < 1e-12, "p (1 − p)");
    }

    #[test]
    fn scores_that_are_no_probabilities_are_not_judged_as_such() {
        assert_eq!(reliability(&[(0.5, true), (1.5, true)]), None);
        assert_eq!(reliability(&[(f64::NAN, true)]), None);
        assert_eq!(reliability(&[]), None);
    }

    /// A Wilson interval of 10 hits of 10 begins at 0.7225, as in Brown, Cai & DasGupta 2001
    /// (<https://doi.org/10.1214/ss/1009213286>) and every statistics program.
    #[test]
    fn wilson_intervals_end_where_others_do() {
        assert!((wilson(1., 10.)[0] - 0.7225).abs() < 1e-4);
        assert_eq!(wilson(1., 10.)[1], 1.);
        assert!((wilson(0.5, 20.)[0] - 0.2993).abs() < 1e-4);
    }
}
