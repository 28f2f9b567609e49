//! Comparison of a mosaic with point-process models (samplers), of detections with reference marks,
//! and of graders with each other.

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
