//! Quantiles by the definitions that are in use, so that each caller names the one it means.

/// Quantile of values in rising order, interpolated linearly between two of them: type 7 of Hyndman & Fan (1996),
/// doi:10.2307/2684934. `share` is held to 0–1; `None` without values.
pub(crate) fn linear_quantile(rising: &[f64], share: f64) -> Option<f64> {
    let place = share.clamp(0., 1.) * rising.len().checked_sub(1)? as f64;
    let (low, high) = (rising.get(place.floor() as usize)?, rising.get(place.ceil() as usize)?);
    Some(low + (high - low) * place.fract())
}

/// Smallest of values in rising order that a share of them does not exceed: the inverse of their distribution function,
/// type 1 of Hyndman & Fan (1996). NaN without values.
pub(crate) fn stepped_quantile(rising: &[f64], share: f64) -> f64 {
    let index = (share * rising.len() as f64).ceil() as usize;
    rising.get(index.saturating_sub(1)).copied().unwrap_or(f64::NAN)
}

/// Value of values in rising order whose rank is nearest to the share, 0–1, of the highest rank; `None` without values.
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
