//! Estimators of the distribution of the distance to the nearest point, under censoring by the
//! border.
//!
//! Distances d fall into bins (r_{k−1}, r_k]. The distance d of a point is censored if it exceeds
//! b, the distance from the point to the border: a nearer point may then be hidden beyond the
//! border.
//!
//! 1. Count the distances d, and likewise the border distances b, by the first row k with d ≤ r_k.
//! 2. Go through the rows once and update the numbers of points in the estimates, such as #{d ≤ r}
//!    and #{min(d, b) > r_{k−1}}.

use super::first_at_least;

/// Distribution function of the distance to the nearest point, at a series of distances r_k, with
/// several corrections for the border.
///
/// Distances d fall into bins (r_{k−1}, r_k]. The distance to the border is b; if d > b, a nearer
/// point may be hidden beyond the border. #{…} is the number of points that satisfy a condition.
/// (For F, it is the number of test locations.)
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FirstDistance {
    /// Estimate without correction: #{d ≤ r_k}/n, for n points.
    pub none: Vec<f64>,
    /// Reduced sample (border correction): #{d ≤ b, d ≤ r_k, b > r_{k−1}} / #{b > r_{k−1}}; NaN if
    /// the denominator is 0.
    pub reduced_sample: Vec<f64>,
    /// Kaplan–Meier estimate: 1 − Π (1 − #{d ≤ b, d in bin k} / #{min(d, b) > r_{k−1}}).
    ///
    /// Source: Baddeley & Gill (1997), <https://doi.org/10.1214/aos/1034276629>.
    pub kaplan_meier: Vec<f64>,
    /// Hanisch's estimate: Σ #{d ≤ b, d in bin k} / |W eroded by r_k|, divided by its last value,
    /// where |W eroded by r| is the area of the part of the window that is at least r from the
    /// border. NaN if the sum is 0 or not finite.
    ///
    /// Sources: Hanisch (1984), <https://doi.org/10.1080/02331888408801788>; for F, Chiu & Stoyan
    /// (1998).
    pub hanisch: Vec<f64>,
}

impl FirstDistance {
    /// Estimates the distribution at the distances `r`.
    ///
    /// `distances` contains the distance d of every point, and `borders` its distance b to the
    /// border. `eroded(r)` is the area of the part of the window that is at least r from the
    /// border, in any unit.
    pub(in crate::stats) fn new(
        distances: &[f64],
        borders: &[f64],
        r: &[f64],
        eroded: impl Fn(f64) -> f64,
    ) -> Self {
        let rows = r.len();
        // A value is counted in the first row whose r is not below it. Values beyond the last row
        // are counted in a further row after it.
        //
        // `all` counts d, `border` counts b, `observed` counts min(d, b), and `seen` counts d if d
        // ≤ b.
        let count = || vec![0usize; rows + 2];
        let (mut all, mut seen, mut observed, mut border) = (count(), count(), count(), count());
        // Uncensored distances, counted in the first row k with b ≤ r_{k−1}, from which on they
        // drop out of the numerator of the reduced sample.
        let mut seen_ends = count();
        for (&d, &b) in distances.iter().zip(borders) {
            let (at_d, at_b) = (first_at_least(r, d), first_at_least(r, b));
            all[at_d] += 1;
            border[at_b] += 1;
            observed[at_d.min(at_b)] += 1;
            if d <= b {
                seen[at_d] += 1;
                seen_ends[at_b + 1] += 1;
            }
        }
        let n = distances.len();
        let (mut reached, mut numerator, mut beyond, mut at_risk) = (0, 0, n, n);
        let (mut survival, mut sum) = (1., 0.);
        let mut of = Self::default();
        for k in 0..rows {
            reached += all[k];
            numerator += seen[k];
            numerator -= seen_ends[k];
            if k > 0 {
                beyond -= border[k - 1];
                at_risk -= observed[k - 1];
            }
            of.none.push(reached as f64 / n as f64);
            of.reduced_sample.push(if beyond > 0 { numerator as f64 / beyond as f64 } else { f64::NAN });
            if at_risk > 0 {
                survival *= 1. - seen[k] as f64 / at_risk as f64;
            }
            of.kaplan_meier.push(1. - survival);
            if seen[k] > 0 {
                sum += seen[k] as f64 / eroded(r[k]);
            }
            of.hanisch.push(sum);
        }
        for h in &mut of.hanisch {
            *h = if sum > 0. && sum.is_finite() { *h / sum } else { f64::NAN };
        }
        of
    }
}
