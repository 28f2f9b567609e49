//! Folders of files: finds them, names them, gives them their scale, works through them on all cores, keeps
//! failures apart. Knows nothing of mathematics.

mod agreement;
mod comparison;
mod coordinates;
mod crop;
mod detection;
mod error;
mod failures;
mod figures;
mod image_figure;
mod image_window;
mod inputs;
mod labels;
mod length;
mod maps;
mod measured;
mod outputs;
mod pairing;
mod paper;
mod progress;
mod readings;
mod region;
mod rois;
mod run;
mod scales;
mod validation;
mod verdicts;
mod work;

pub use agreement::{AgreementOptions, AgreementOutcome, ColumnAgreement, agree_files};
pub use comparison::{CompareOptions, compare_files};
pub use coordinates::{CoordinatesOptions, CoordinatesOutcome, measure_files};
pub use crop::Crop;
pub use detection::{DetectionExtras, DetectionOutcome, detect_files};
pub use error::BatchError;
pub use failures::Failure;
pub use image_window::ImageWindow;
pub use inputs::{Input, coordinate_files, image_files};
pub use labels::{GroupBy, Labels};
pub use length::Length;
pub use maps::{MapRequest, MapWindow};
pub use paper::remake_paper;
pub use progress::{Progress, Silent};
pub use region::Region;
pub use rois::{RoiRequest, RoiSource};
pub use run::{RunOptions, RunOutcome, run_files};
pub use scales::ScaleSource;
pub use validation::{
    Analysis, Comparison, Detected, Grouping, ValidationOptions, ValidationOutcome, ValidationRow, VersusRow,
    validate_files,
};
