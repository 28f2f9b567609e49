//! Detections against reference marks: pairs, rates, curves and what groups of images have in common.

mod assignment;
mod comparison;
mod froc;
mod groups;
mod matching;
mod reliability;
mod summary;
mod validation;

pub use comparison::{Difference, compare_scores};
pub use froc::{Froc, FrocPoint, Judged, JudgedImage, Verdict, froc, judge};
pub use groups::{GroupSummary, MeanOverGroups, by_group, mean_over_groups};
pub use matching::{Assignment, MatchError, MatchOptions, Matching, Pair, match_points};
pub use reliability::{Reliability, ReliabilityBin, reliability};
pub use summary::{Summary, intervals, summarise};
pub use validation::{Rates, Score, validate};
