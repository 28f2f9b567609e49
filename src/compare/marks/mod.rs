//! Comparison of detections with reference marks: pairs, error rates, FROC curves, reliability of
//! scores, and summaries over groups of images.

mod assignment;
mod comparison;
mod froc;
mod groups;
mod matching;
mod registration;
mod reliability;
mod summary;
mod turned;
mod validation;

pub use comparison::{Difference, compare_scores};
pub use froc::{Froc, FrocPoint, Judged, JudgedImage, Verdict, froc, judge};
pub use groups::{GroupSummary, MeanOverGroups, by_group, mean_over_groups};
pub use matching::{Assignment, MatchError, MatchOptions, Matching, Pair, match_points};
pub use registration::{LARGEST_SHIFT, Registration, register};
pub use reliability::{Reliability, ReliabilityBin, reliability};
pub use summary::{Summary, intervals, summarise};
pub use turned::{Turned, turned};
pub use validation::{Rates, STRICT_REACH, Score, validate};
