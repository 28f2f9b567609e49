//! Size of the variation of density, with its confidence interval and significance.
//!
//! The strength of the trend's waves, divided by what chance adds, follows a non-central F
//! distribution, which is approximated by a normal one (see [`Size::deviate`]).

use super::{TREND_LEVEL, TREND_WAVES};
use statrs::distribution::{ContinuousCDF, Normal};

/// Degrees of freedom of the noise, 17.6 rounded down: 2/(2·(4/5)²/12 + 2·(1/5)²/12).
///
/// The noise is 4/5 of the mean square of 12 waves plus 1/5 of the mean square of 12 other waves.
/// The formula gives the chi-squared distribution with the same relative variance.
///
/// Source: Satterthwaite (1946), <https://doi.org/10.2307/3002019>.
const NOISE_FREEDOM: f64 = 17.;

/// Size of the variation of density relative to the mean density, computed from two sets of cosine
/// waves: those of the trend and those of the noise.
pub(super) struct Size {
    /// Root mean square of the variation of density that the waves of the trend show, including the
    /// contribution of chance.
    observed: f64,
    /// Contribution of chance to the square of `observed`: five times the mean square of a noise
    /// wave, because there are five waves of the trend.
    chance: f64,
}

impl Size {
    /// Number of waves of the trend, as a float.
    const WAVES: f64 = TREND_WAVES.len() as f64;

    /// Computes the size from sums of waves over `n` points.
    ///
    /// `strength` is the mean square of these sums over the waves of the trend, `scatter` the mean
    /// square over the waves of the noise.
    pub(super) fn new(strength: f64, scatter: f64, n: usize) -> Self {
        let per_square = Self::WAVES / (n as f64).powi(2);
        Self { observed: (per_square * strength).sqrt(), chance: per_square * scatter }
    }

    /// Returns the variation without the contribution of chance: √12 times its root mean square, or
    /// 0 if chance contributes more than was observed.
    ///
    /// A linear gradient that changes by X from side to side has the root mean square X/√12, hence
    /// the factor √12.
    pub(super) fn estimate(&self) -> f64 {
        (12. * (self.observed.powi(2) - self.chance)).max(0.).sqrt()
    }

    /// Returns the standard normal deviate of the observed strength of the trend if the density
    /// varies by `variation`.
    ///
    /// - In units of the noise of one wave, the sum of squares over the five waves of the trend has
    ///   mean 5 + λ and variance 10 + 4λ, where λ = 5 · (variation²/12) / `chance`. The sum is
    ///   treated as a gamma variable with the same mean and variance (Patnaik 1949,
    ///   <https://doi.org/10.1093/biomet/36.1-2.202>).
    /// - The sum is divided by its expectation. In units of `observed`², the expectation is
    ///   variation²/12 + `chance`. The first term is known exactly, and the second is estimated
    ///   from the noise, so their sum has 17(1 + λ/5)² degrees of freedom (Satterthwaite 1946,
    ///   <https://doi.org/10.2307/3002019>).
    /// - The ratio of the two is treated as an F variable. The formula of Paulson (1942,
    ///   <https://doi.org/10.1214/aoms/1177731608>) converts it to a normal deviate; for the 1 %
    ///   point of F(5, 17), the formula gives 1.01 %.
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

    /// Returns the probability that a pattern whose density varies by `variation` shows a trend at
    /// least as strong as the observed one.
    pub(super) fn chance_of_more(&self, variation: f64) -> f64 {
        Normal::standard().sf(self.deviate(variation))
    }

    /// Returns the confidence interval of the variation: all variations for which the observed
    /// trend is neither too strong nor too weak.
    ///
    /// The probability of error is [`TREND_LEVEL`] at each end.
    pub(super) fn interval(&self) -> (f64, f64) {
        let limit = -Normal::standard().inverse_cdf(TREND_LEVEL);
        // At this variation the deviate is always below −40, so both ends of the interval are
        // smaller.
        let most = 12f64.sqrt() * (self.observed + 20. * self.chance.sqrt());
        (self.variation_at(limit, most), self.variation_at(-limit, most))
    }

    /// Returns the variation, from 0 to `most`, at which the deviate is `value`.
    ///
    /// The deviate falls as the variation grows, so the variation is found by bisection. If the
    /// deviate is below `value` everywhere, the result is 0.
    fn variation_at(&self, value: f64, most: f64) -> f64 {
        let (mut low, mut high) = (0., most);
        // 60 halvings bring the range below the precision of an f64.
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.deviate(middle) > value { low = middle } else { high = middle }
        }
        low
    }
}
