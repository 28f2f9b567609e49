//! Batches of files: finds them, names them, gives them their scale, works through them on all cores,
//! keeps failures apart and results whole. Knows nothing of mathematics.
//!
//! Every command that measures mosaics is the same pipeline: [`run_files`] gets cones from images,
//! [`measure_files`] and [`compare_files`] from coordinate files; what is computed of them and
//! written is one [`Plan`].

mod agree;
mod analysis;
mod detect;
mod error;
mod input;
mod measure;
mod output;
mod paper;
mod run;
mod validate;
mod window;

pub use agree::{AgreementOptions, AgreementOutcome, ColumnAgreement, agree_files};
pub use analysis::{MapRequest, MapWindow, Plan, RoiRequest, RoiSource};
pub use detect::{DetectionExtras, DetectionOutcome, detect_files};
pub use error::BatchError;
pub use input::{GroupBy, Input, Labels, ScaleSource, coordinate_files, image_files};
pub use measure::{CoordinatesOptions, CoordinatesOutcome, compare_files, measure_files};
pub use output::{Ending, Failure, Leftovers, Progress, Silent};
pub use paper::remake_paper;
pub use run::{ConeSource, GivenCones, RunOptions, RunOutcome, run_files};
pub use validate::{
    Analysis, Comparison, Detected, Grouping, ValidationOptions, ValidationOutcome, ValidationRow, VersusRow,
    validate_files,
};
pub use window::{Crop, ImageWindow, Length, Region};
