//! A mosaic against samplers; detections against reference marks.

mod agreement;
mod marks;
pub mod paper;
mod samplers;

pub use agreement::{
    Agreement, ClusteredAgreement, Interval, Intraclass, RESAMPLES, SubjectMean, agreement,
    agreement_of_clusters, bootstrap, clusters, intraclass, least_p, mean_over_subjects, sign_flip_test,
};
pub use marks::{
    Assignment, Difference, Froc, FrocPoint, GroupSummary, Judged, JudgedImage, MatchError, MatchOptions,
    Matching, MeanOverGroups, Pair, Rates, Reliability, ReliabilityBin, Score, Summary, Verdict, by_group,
    compare_scores, froc, intervals, judge, match_points, mean_over_groups, reliability, summarise, validate,
};
#[doc(hidden)]
pub use samplers::make_table;
#[cfg(feature = "report")]
pub(crate) use samplers::of_sampler;
pub use samplers::{
    CompareError, Envelope, NotCompared, POOR_FIT, ReferenceCurve, References, SamplerCurves, SamplerVerdict,
    TargetFit, VerdictOptions, l_infinity, mean_curve, target_fit, verdict,
};
pub(crate) use samplers::{curve, draw};

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
