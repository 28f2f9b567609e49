//! Size of the variation of density, with its confidence interval and significance.
//!
//! The strength of the trend's waves, divided by what chance adds, follows a non-central F
//! distribution, which is approximated by a normal one (see [`Size::deviate`]).

use super::{TREND_LEVEL, TREND_WAVES};
use statrs::distribution::{ContinuousCDF, Normal};

/// Degrees of freedom of the scatter: 2/(2·(4/5)²/12 + 2·(1/5)²/12), rounded down.
///
/// Source: Satterthwaite (1946), <https://doi.org/10.2307/3002019>.
const NOISE_FREEDOM: f64 = 17.;

/// Variation of density from the trend's waves and those of the noise, as shares of the mean
/// density.
pub(super) struct Size {
    /// Root mean square of the variation shown by the sums over the trend's waves, chance included.
    observed: f64,
    /// Contribution of chance to its square: five times the noise of a single wave.
    chance: f64,
}

impl Size {
    /// Number of waves of the trend.
    const WAVES: f64 = TREND_WAVES.len() as f64;

    /// Computes the variation from the mean squares of the sums of `n` points over the trend's and
    /// the noise's waves.
    pub(super) fn new(strength: f64, scatter: f64, n: usize) -> Self {
        let per_square = Self::WAVES / (n as f64).powi(2);
        Self { observed: (per_square * strength).sqrt(), chance: per_square * scatter }
    }

    /// Returns the variation without the contribution of chance: √12 times its root mean square.
    pub(super) fn estimate(&self) -> f64 {
        (12. * (self.observed.powi(2) - self.chance)).max(0.).sqrt()
    }

    /// Returns the standard normal deviate of the observation if density varies by `variation`.
    ///
    /// - The sum of squares over the trend's waves is 5 + λ noises on average, with variance
    ///   10 + 4λ, where λ measures the variation. It is treated as a gamma variable with the same
    ///   two moments (Patnaik 1949, <https://doi.org/10.1093/biomet/36.1-2.202>).
    /// - It is compared with λ, which is known, plus 5 noises, which are estimated. This has
    ///   17(1 + λ/5)² degrees of freedom (Satterthwaite 1946,
    ///   <https://doi.org/10.2307/3002019>).
    /// - The F of their ratio is made normal by the formula of Paulson (1942,
    ///   <https://doi.org/10.1214/aoms/1177731608>); at 1 %, F(5, 17) comes out at 1.01 %.
    pub(super) fn deviate(&self, variation: f64) -> f64 {
        let square = variation.powi(2) / 12.;
        // A lattice that fits its window leaves no noise except rounding, hence the lower bounds.
        let chance = self.chance.max(1e-9 * square).max(1e-24);
        let ratio = (self.observed.powi(2) / (square + chance)).cbrt();
        let excess = square / chance;
        let above = 2. / 9. * (1. + 2. * excess) / (Self::WAVES * (1. + excess).powi(2));
        let below = 2. / 9. / (NOISE_FREEDOM * (1. + excess).powi(2));
        ((1. - below) * ratio - (1. - above)) / (below * ratio.powi(2) + above).sqrt()
    }

    /// Returns the probability of an observation at least as strong in a pattern whose density
    /// varies by `variation`.
    pub(super) fn chance_of_more(&self, variation: f64) -> f64 {
        Normal::standard().sf(self.deviate(variation))
    }

    /// Returns the interval of variations for which the observation is neither too strong nor too
    /// weak.
    ///
    /// Each end is at the level [`TREND_LEVEL`].
    pub(super) fn interval(&self) -> (f64, f64) {
        let limit = -Normal::standard().inverse_cdf(TREND_LEVEL);
        let most = 12f64.sqrt() * (self.observed + 20. * self.chance.sqrt());
        (self.variation_at(limit, most), self.variation_at(-limit, most))
    }

    /// Returns the variation, at most `most`, at which the deviate is `value`.
    ///
    /// The deviate falls with the variation. If it is below `value` everywhere, the result is 0.
    fn variation_at(&self, value: f64, most: f64) -> f64 {
        let (mut low, mut high) = (0., most);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.deviate(middle) > value { low = middle } else { high = middle }
        }
        low
    }
}
