//! Work on batches of files: finding the files, naming their results, giving them scales, analysing
//! them on all cores and writing the results.
//!
//! A file that fails is reported and does not stop the others. A result file appears only when it
//! is complete. The module itself contains no mathematics, only calls to the modules that do.
//!
//! Every command that measures mosaics runs the same pipeline: [`run_files`] takes the cones from
//! images, [`measure_files`] and [`compare_files`] take points from coordinate files. A [`Plan`]
//! states what is computed and written for each mosaic.
//!
//! # Examples
//! ```
//! use conemosaic::batch::{Plan, RunOptions, Silent, image_files, run_files};
//! use conemosaic::sample::sampler;
//!
//! let images = image_files(&["fixtures/images/split_sparse.png".into()], None)?;
//! let plan = Plan { samplers: vec![sampler("uniform")?], ..Plan::default() };
//! let options = RunOptions { plan, ..RunOptions::default() };
//! let out = tempfile::tempdir()?;
//! let outcome = run_files(&images, &options, out.path(), &Silent)?;
//!
//! assert_eq!((outcome.records.len(), outcome.failures.len()), (1, 0));
//! assert!(out.path().join("summary.csv").exists() && out.path().join("index.html").exists());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod agree;
mod analysis;
mod detect;
mod error;
mod input;
mod measure;
mod output;
mod pairs;
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
pub use pairs::ChannelPatterns;
pub use paper::remake_paper;
pub use run::{ConeSource, GivenCones, RunOptions, RunOutcome, run_files};
pub use validate::{
    Analysis, Comparison, Detected, Grouping, ValidationOptions, ValidationOutcome, ValidationRow, VersusRow,
    validate_files,
};
pub use window::{Crop, ImageWindow, Length, Region};
