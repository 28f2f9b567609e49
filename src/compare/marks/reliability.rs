use crate::compare::Interval;
use serde::Serialize;

/// Bins of equal width between 0 and 1.
const BINS: usize = 10;
const Z: f64 = 1.96;

/// Detections of about the same score.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReliabilityBin {
    /// Least score of the bin.
    pub from: f64,
    /// Its upper end; it belongs to the next bin, but 1 to the last.
    pub to: f64,
    /// Detections in it.
    pub n: usize,
    /// Their mean score.
    pub mean_score: Option<f64>,
    /// How many of them, of 1, are hits.
    pub hits: Option<f64>,
    /// Its 95 % interval (Wilson 1927), taking detections as independent.
    pub hits_interval: Option<Interval>,
}

/// Whether scores between 0 and 1 are the probabilities of being right.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reliability {
    /// Detections judged.
    pub n: usize,
    /// Ten bins of equal width.
    pub bins: Vec<ReliabilityBin>,
    /// Expected calibration error (Guo et al. 2017, eq. 3): mean over detections of |hits − mean score| of their bin.
    pub expected_calibration_error: f64,
    /// Brier score (1950): mean over detections of (score − hit)², hit being 1 or 0.
    pub brier: f64,
}

/// Reliability of scores, each with whether its detection is a hit; `None` without any, or if one is not between 0 and 1.
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

/// Score interval of a proportion `p` of `n`.
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
        // the last bin: 2 of 3 hit, mean score 2.86 / 3; the third: none of 1, 0.2
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

    /// Brown, Cai & DasGupta 2001 and every statistics program: 10 of 10 has a Wilson interval from 0.7225.
    #[test]
    fn wilson_intervals_end_where_others_do() {
        assert!((wilson(1., 10.)[0] - 0.7225).abs() < 1e-4);
        assert_eq!(wilson(1., 10.)[1], 1.);
        assert!((wilson(0.5, 20.)[0] - 0.2993).abs() < 1e-4);
    }
}
