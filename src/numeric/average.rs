/// Returns the median: the middle value, or the mean of the two middle values. Returns `None` if
/// there are no values.
///
/// The values are sorted in place.
pub(crate) fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let middle = values.len() / 2;
    let upper = values.get(middle)?;
    let lower = if values.len().is_multiple_of(2) { values.get(middle - 1)? } else { upper };
    Some((lower + upper) / 2.)
}

/// Returns the arithmetic mean; `None` if `values` is empty.
pub(crate) fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}
