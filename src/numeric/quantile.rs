//! Quantiles by three different definitions, each a separate function, so that every caller names
//! the definition that it uses.
//!
//! The types named below are those of Hyndman and Fan (1996), <https://doi.org/10.2307/2684934>.

/// Returns the quantile `share`, interpolated linearly between two neighbouring values: type 7 of
/// Hyndman and Fan (1996).
///
/// `rising` must be in rising order, and `share` is clamped to 0–1. Returns `None` if there are no
/// values.
pub(crate) fn linear_quantile(rising: &[f64], share: f64) -> Option<f64> {
    let place = share.clamp(0., 1.) * rising.len().checked_sub(1)? as f64;
    let (low, high) = (rising.get(place.floor() as usize)?, rising.get(place.ceil() as usize)?);
    Some(low + (high - low) * place.fract())
}

/// Returns the smallest value v such that at least the fraction `share` (0–1) of all values is at
/// most v: type 1 of Hyndman and Fan (1996).
///
/// This is the inverse of the empirical distribution function. `rising` must be in rising order.
/// The result is NaN if `rising` is empty.
pub(crate) fn stepped_quantile(rising: &[f64], share: f64) -> f64 {
    let index = (share * rising.len() as f64).ceil() as usize;
    rising.get(index.saturating_sub(1)).copied().unwrap_or(f64::NAN)
}

/// Returns the value whose index is nearest to `share` (0–1) times the highest index.
///
/// `rising` must be in rising order. Returns `None` if `rising` is empty.
pub(crate) fn nearest_rank(rising: &[f64], share: f64) -> Option<f64> {
    let highest = rising.len().checked_sub(1)?;
    rising.get((highest as f64 * share).round() as usize).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_quantiles_lie_between_the_values() {
        let values = [1., 2., 4., 8.];
        assert_eq!([0., 0.5, 1.].map(|q| linear_quantile(&values, q)), [Some(1.), Some(3.), Some(8.)]);
        assert_eq!(linear_quantile(&[], 0.5), None);
    }

    #[test]
    fn the_other_definitions_give_values_that_occur() {
        let values = [1., 2., 4., 8.];
        assert_eq!([0., 0.5, 0.51, 1.].map(|q| stepped_quantile(&values, q)), [1., 2., 4., 8.]);
        assert!(stepped_quantile(&[], 0.5).is_nan());
        assert_eq!([0., 0.4, 1.].map(|q| nearest_rank(&values, q)), [Some(1.), Some(2.), Some(8.)]);
        assert_eq!(nearest_rank(&[], 0.5), None);
    }
}
