use super::significant;
use crate::compare::SamplerVerdict;
use serde::{Deserialize, Serialize};

/// The verdict on one mosaic by simulations of one sampler.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VerdictRecord {
    /// Name of the sampler.
    pub sampler: String,
    /// Outcome of the test: true if `p_envelope` is above `level`, so that the mosaic could be a
    /// realisation of the sampler.
    pub alike: bool,
    /// p-value of the global envelope test of g (extreme rank length).
    pub p_envelope: f64,
    /// p-value of `l_infinity`: the rank of the mosaic among the simulations.
    pub p_l_infinity: f64,
    /// l-infinity between the mosaic and the mean of the simulations at its own n and window.
    ///
    /// The distance in [`MosaicRecord::l_infinity`](super::MosaicRecord::l_infinity) differs: it is
    /// the distance to the mean curve for a class of similar n and window.
    pub l_infinity: f64,
    /// Median l-infinity of one simulation to the mean of all other curves.
    pub l_infinity_usual: f64,
    /// Value that the l-infinity of 95 % of the simulations does not exceed.
    pub l_infinity_most: f64,
    /// Ranges of r, from–to in hexagonal spacings, in which g is outside the envelope.
    pub outside: Vec<(f64, f64)>,
    /// Mean regularity index of the simulations, over all points and with the sample standard
    /// deviation.
    pub ri_mean: Option<f64>,
    /// Standard deviation of the regularity index over the simulations.
    pub ri_sd: Option<f64>,
    /// Number of simulations made.
    pub simulations: usize,
    /// Smallest and largest number of points of a simulation.
    pub points: (usize, usize),
    /// Level of the test and of the envelope.
    pub level: f64,
}

/// Gap, in hexagonal spacings, below which two stretches outside the envelope are reported as one.
const NEAR: f64 = 0.05;
/// Largest number of stretches outside the envelope that the words of a verdict name, the widest
/// first.
const MOST_STRETCHES: usize = 3;

impl From<&SamplerVerdict> for VerdictRecord {
    fn from(v: &SamplerVerdict) -> Self {
        Self {
            sampler: v.sampler.clone(),
            alike: v.alike(),
            p_envelope: v.p_envelope,
            p_l_infinity: v.p_l_infinity,
            l_infinity: v.l_infinity,
            l_infinity_usual: v.l_infinity_usual,
            l_infinity_most: v.l_infinity_most,
            outside: v.outside.clone(),
            ri_mean: v.ri.mean,
            ri_sd: v.ri.sd,
            simulations: v.simulations,
            points: v.points,
            level: v.level,
        }
    }
}

impl VerdictRecord {
    /// Returns the verdict in words, with the p-value and the widest stretches outside the
    /// envelope.
    pub fn words(&self) -> String {
        let p = significant(self.p_envelope, 2);
        if self.alike {
            return format!("consistent with {}: p = {p}", self.sampler);
        }
        let place = self.place();
        let place = if place.is_empty() { String::new() } else { format!(", at r = {place} spacings") };
        format!("differs from {}: p = {p}{place}", self.sampler)
    }

    /// Returns the widest stretches outside the envelope in words, in rising order, in spacings.
    fn place(&self) -> String {
        let mut stretches: Vec<(f64, f64)> = Vec::new();
        for &(from, to) in &self.outside {
            match stretches.last_mut() {
                Some((_, end)) if from - *end < NEAR => *end = to,
                _ => stretches.push((from, to)),
            }
        }
        let more = stretches.len() > MOST_STRETCHES;
        stretches.sort_by(|a, b| (b.1 - b.0).total_cmp(&(a.1 - a.0)));
        stretches.truncate(MOST_STRETCHES);
        stretches.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut words: Vec<String> = stretches
            .iter()
            .map(|(from, to)| {
                let (from, to) = (format!("{from:.2}"), format!("{to:.2}"));
                if from == to { from } else { format!("{from}–{to}") }
            })
            .collect();
        if more {
            words.push("…".to_owned());
        }
        words.join(", ")
    }

    /// Returns all stretches outside the envelope in the form in which `verdicts.csv` lists them.
    pub(super) fn outside_words(&self) -> String {
        let stretch = |(from, to): &(f64, f64)| format!("{from:.4}–{to:.4}");
        self.outside.iter().map(stretch).collect::<Vec<_>>().join(" ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(p_envelope: f64, outside: Vec<(f64, f64)>) -> VerdictRecord {
        VerdictRecord {
            sampler: "bnot".into(),
            alike: p_envelope > 0.05,
            p_envelope,
            p_l_infinity: 0.2,
            l_infinity: 0.3,
            l_infinity_usual: 0.1,
            l_infinity_most: 0.2,
            outside,
            ri_mean: Some(21.),
            ri_sd: None,
            simulations: 199,
            points: (300, 300),
            level: 0.05,
        }
    }

    #[test]
    fn words_say_how_likely_and_where() {
        assert_eq!(record(0.312, vec![]).words(), "consistent with bnot: p = 0.31");
        let near = vec![(0.9, 1.0), (1.02, 1.1), (1.7, 1.7)];
        assert_eq!(
            record(0.005, near).words(),
            "differs from bnot: p = 0.0050, at r = 0.90–1.10, 1.70 spacings"
        );
        let many = (0..6).map(|k| (f64::from(k) * 0.3, f64::from(k) * 0.31)).collect();
        assert!(record(0.01, many).words().ends_with("0.90–0.93, 1.20–1.24, 1.50–1.55, … spacings"));
    }
}
