//! A mosaic against samplers; detections against reference marks.

mod agreement;
mod assignment;
mod bootstrap;
mod clustered;
mod comparison;
mod curve_class;
mod curves;
mod froc;
mod groups;
mod intraclass;
mod l_infinity;
mod matching;
pub mod paper;
mod realisation;
mod reference;
mod reliability;
mod shared_work;
mod shipped;
mod shipped_codec;
mod sign_flip;
mod subjects;
mod summary;
mod target_fit;
mod validation;
mod verdict;

pub use agreement::{Agreement, agreement};
pub use bootstrap::{Interval, RESAMPLES, bootstrap};
pub use clustered::{ClusteredAgreement, agreement_of_clusters};
pub use comparison::{Difference, compare_scores};
pub use curves::mean_curve;
pub(crate) use curves::{curve, draw, of_sampler};
pub use froc::{Froc, FrocPoint, Judged, JudgedImage, Verdict, froc, judge};
pub use groups::{GroupSummary, MeanOverGroups, by_group, clusters, mean_over_groups};
pub use intraclass::{Intraclass, intraclass};
pub use l_infinity::{CompareError, l_infinity};
pub use matching::{Assignment, MatchError, MatchOptions, Matching, Pair, match_points};
pub use reference::{NotCompared, ReferenceCurve, References, SamplerCurves};
pub use reliability::{Reliability, ReliabilityBin, reliability};
#[doc(hidden)]
pub use shipped::make_table;
pub use sign_flip::{least_p, sign_flip_test};
pub use subjects::{SubjectMean, mean_over_subjects};
pub use summary::{Summary, intervals, summarise};
pub use target_fit::{POOR_FIT, TargetFit, target_fit};
pub use validation::{Rates, Score, validate};
pub use verdict::{Envelope, SamplerVerdict, VerdictOptions, verdict};

/// The middle value, or the mean of the two middle ones; `None` without values.
fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let middle = values.len() / 2;
    let upper = values.get(middle)?;
    let lower = if values.len().is_multiple_of(2) { values.get(middle - 1)? } else { upper };
    Some((lower + upper) / 2.)
}

fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}
