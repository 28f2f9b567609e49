use super::first_at_least;

/// Distribution function of the distance to the first point, with several rules for the border, at given distances r.
///
/// Distances d fall into bins (r_{k−1}, r_k]; b is the distance to the border, beyond which a nearer point may be hidden.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FirstDistance {
    /// No correction: #{d ≤ r}/n.
    pub none: Vec<f64>,
    /// Reduced sample (border correction): #{d ≤ b, d ≤ r_k, b > r_{k−1}} / #{b > r_{k−1}}.
    pub reduced_sample: Vec<f64>,
    /// Kaplan–Meier (Baddeley & Gill 1997): 1 − Π (1 − #{d ≤ b, d in bin k} / #{min(d, b) > r_{k−1}}).
    pub kaplan_meier: Vec<f64>,
    /// Hanisch (1984), for F Chiu & Stoyan (1998): Σ #{d ≤ b, d in bin k} / |W eroded by r_k|, over its last value.
    pub hanisch: Vec<f64>,
}

impl FirstDistance {
    /// `eroded(r)`: area of the window without a margin of width r, in any unit.
    pub(in crate::stats) fn new(
        distances: &[f64],
        borders: &[f64],
        r: &[f64],
        eroded: impl Fn(f64) -> f64,
    ) -> Self {
        let rows = r.len();
        // Counts by the first row that reaches them; what is beyond the last row stands behind.
        let count = || vec![0usize; rows + 2];
        let (mut all, mut seen, mut observed, mut border) = (count(), count(), count(), count());
        // Those seen, by the first row that is beyond their border distance.
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
