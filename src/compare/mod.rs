//! Comparison of a mosaic with point-process models (samplers), of detections with reference marks,
//! and of graders with each other.
//!
//! # Examples
//! ```
//! use conemosaic::compare::{References, l_infinity, match_points};
//! use conemosaic::prelude::*;
//! use conemosaic::sample::sampler;
//! use rand::SeedableRng;
//!
//! // compare a mosaic with a sampler: l-infinity distance of their pair correlation functions
//! let window = Window::rectangle(0., 0., 200., 200.)?;
//! let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(3);
//! let points = sampler("jittered")?.sample(400, &window, &mut rng)?;
//! let g = pcf(&points, &window, &PcfOptions::default())?;
//! let references = References::new(vec![sampler("uniform")?], PcfOptions::default(), 1);
//! let uniform = &references.curves(points.len(), &window).curves[0];
//! assert!(l_infinity(&g, &uniform.pcf)? > 0.5);
//!
//! // compare detections with marks of the same image, here of 200 × 200 px
//! let matching = match_points(&points, &points[..390], 200, 200, &MatchOptions::default())?;
//! assert!(matching.false_positives() == 0 && matching.false_negatives() <= 10);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod agreement;
mod marks;
pub mod paper;
mod samplers;

pub use agreement::{
    Agreement, ClusteredAgreement, Interval, Intraclass, RESAMPLES, SubjectMean, agreement,
    agreement_of_clusters, bootstrap, clusters, intraclass, least_p, mean_over_subjects, sign_flip_test,
};
pub use marks::{
    Assignment, Difference, Froc, FrocPoint, GroupSummary, Judged, JudgedImage, LARGEST_SHIFT, MatchError,
    MatchOptions, Matching, MeanOverGroups, Pair, Rates, Registration, Reliability, ReliabilityBin,
    STRICT_REACH, Score, Summary, Turned, Verdict, by_group, compare_scores, froc, intervals, judge,
    match_points, mean_over_groups, register, reliability, summarise, turned, validate,
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
