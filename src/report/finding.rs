use super::{counted, significant};
use crate::stats::{FEWEST_PAIRS, RankCorrelation, rank_correlation};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// The correlation of the regularity of mosaics with their distance to one sampler.
///
/// The main finding of Lanaro et al. (2020, <https://doi.org/10.1088/2399-6528/ab8064>) is that the
/// more regular mosaics are nearer to BNOT and farther from dart throwing.
#[derive(Clone, Debug, PartialEq)]
pub struct FindingRecord {
    /// Name of the sampler.
    pub sampler: String,
    /// Number of mosaics that have a regularity index and a distance to the sampler.
    pub mosaics: usize,
    /// Spearman's ρ between regularity index and l-infinity, with its permutation p-value; `None`
    /// if it is not defined.
    pub correlation: Option<RankCorrelation>,
}

impl FindingRecord {
    /// Computes the correlation between the regularity index and the distance to a sampler.
    ///
    /// `pairs` has both numbers for each mosaic. `seed` is the seed of the permutations from which
    /// the p-value comes.
    pub fn of(sampler: &str, pairs: &[(f64, f64)], seed: u64) -> Self {
        let correlation = rank_correlation(pairs, &mut ChaCha8Rng::seed_from_u64(seed));
        Self { sampler: sampler.to_owned(), mosaics: pairs.len(), correlation }
    }

    /// Returns the reason why there is no correlation; meaningless if there is one.
    pub fn reason(&self) -> String {
        if self.mosaics < FEWEST_PAIRS {
            let found = counted(self.mosaics, "mosaic");
            format!("not tested ({found} with a regularity index, at least {FEWEST_PAIRS} are needed)")
        } else {
            "not tested (the mosaics do not differ in regularity or in distance)".to_owned()
        }
    }

    /// Returns the finding in one sentence, or the reason why there is none.
    pub fn words(&self) -> String {
        let sampler = &self.sampler;
        let Some(c) = self.correlation else { return format!("{sampler}: {}", self.reason()) };
        let direction = if c.rho < 0. { "nearer to" } else { "farther from" };
        let numbers =
            format!("ρ = {:.2}, p = {}, {}", c.rho, significant(c.p_value, 2), counted(c.n, "mosaic"));
        if c.p_value <= 0.05 {
            format!("more regular mosaics are {direction} {sampler}: {numbers}")
        } else {
            format!("no significant correlation between regularity and the distance to {sampler}: {numbers}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_say_which_way_or_why_not() {
        let record = |mosaics, correlation| FindingRecord { sampler: "bnot".into(), mosaics, correlation };
        let strong = RankCorrelation { n: 19, rho: -0.7, p_value: 0.001 };
        assert_eq!(
            record(19, Some(strong)).words(),
            "more regular mosaics are nearer to bnot: ρ = -0.70, p = 0.0010, 19 mosaics"
        );
        assert!(record(3, None).words().contains("3 mosaics"));
        assert!(record(9, None).words().contains("do not differ"));
    }
}
