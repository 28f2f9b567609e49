//! A mosaic against samplers; detections against reference marks.

mod assignment;
mod l_infinity;
mod matching;
mod reference;
mod validation;

pub use l_infinity::{CompareError, l_infinity};
pub use matching::{Assignment, MatchError, MatchOptions, Matching, Pair, match_points};
pub use reference::{ReferenceCurve, References};
pub use validation::{Rates, Score, Summary, summarise, validate};

/// The middle value, or the mean of the two middle ones; `None` without values.
fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let middle = values.len() / 2;
    let upper = values.get(middle)?;
    let lower = if values.len().is_multiple_of(2) { values.get(middle - 1)? } else { upper };
    Some((lower + upper) / 2.)
}
