//! Validation of detections against hand marks: the files are paired, every image is scored, and
//! the results over all images are written.

mod analysis;
mod figures;
mod files;
mod grouping;
mod image;
mod pairs;

pub use crate::report::{ValidationRow, VersusRow};
pub use analysis::{Analysis, Comparison};
pub use grouping::Grouping;

use super::output::{Ending, ResultFolder, for_each, write_failures};
use super::{BatchError, Failure, Progress, ScaleSource};
use crate::compare::MatchOptions;
use crate::detect::DetectOptions;
use crate::mosaic::io::ReadOptions;
use std::path::{Path, PathBuf};

/// The source of the detections that are validated.
#[derive(Clone, Debug)]
pub enum Detected {
    /// The detections are read from coordinate files NAME.csv, written by any program, with or
    /// without a column `score`.
    Files {
        /// Folder of the coordinate files, or the only file.
        path: PathBuf,
        /// Options of reading the files.
        read: ReadOptions,
    },
    /// The detections are made by this program in the images.
    Detector(DetectOptions),
}

impl Detected {
    /// Returns the path of the files or the name of the detector, for the report.
    fn label(&self) -> String {
        match self {
            Self::Files { path, .. } => path.display().to_string(),
            Self::Detector(options) => format!("detector {}", options.detector),
        }
    }
}

/// Options of [`validate_files`], which scores detections against hand marks.
#[derive(Clone, Debug)]
pub struct ValidationOptions {
    /// Options of reading the marks.
    pub read: ReadOptions,
    /// Source of the detections.
    pub detected: Detected,
    /// Second set of detections, or marks of another grader, to compare the detections with. `None`
    /// if nothing is to be compared.
    pub versus: Option<Detected>,
    /// Folder of the images NAME.png or NAME.tif, or path of the only image. `None` if each image
    /// lies beside its marks.
    pub images: Option<PathBuf>,
    /// Width and height of every image in px. `None` if they are to be read from the images.
    pub size: Option<(usize, usize)>,
    /// Options of pairing detections with marks.
    pub matching: MatchOptions,
    /// Rule by which images form groups. `None` if every image counts as independent.
    pub grouping: Option<Grouping>,
    /// Source of the scales of the images.
    pub scales: ScaleSource,
    /// `true` to write an overlay for every image, which shows hits, misses and false alarms.
    pub overlays: bool,
    /// Number of resamples of the bootstrap.
    pub resamples: usize,
    /// Seed of the bootstrap and of permutation tests.
    pub seed: u64,
}

/// Results of a validation by [`validate_files`].
#[derive(Clone, Debug)]
pub struct ValidationOutcome {
    /// Scores of the images, one row per image, in the order of the files of marks.
    pub rows: Vec<ValidationRow>,
    /// Results over all images; `None` if no image was scored.
    pub analysis: Option<Analysis>,
    /// Files of marks that could not be scored, with the reasons.
    pub failures: Vec<Failure>,
    /// Coordinate files beside the marks that belong to no image, such as tables of scales.
    pub ignored: Vec<PathBuf>,
    /// End of the batch: complete, or stopped early.
    pub ending: Ending,
}

/// Scores the detections of every file of marks in `reference` and writes the results into `out`.
///
/// Files of marks are called `NAME_coords.csv` or `NAME.csv`; `reference` is a folder of them or a
/// single file. These files are written:
/// - `validation.csv` (one row per image), `validation.json` (everything), `index.html` and
///   `bland_altman.svg`;
/// - `groups.csv` if images form groups;
/// - `froc.csv` and `froc.svg` if all detections have scores;
/// - `reliability.csv` and `reliability.svg` if all scores lie between 0 and 1;
/// - `comparison.csv` and `comparison.svg` if two detectors or graders are compared;
/// - `NAME.overlay.png` for each image if overlays are asked for.
///
/// # Errors
/// Fails if a folder or file cannot be read, there are no marks, or `out` cannot be written to.
/// Files of marks that cannot be scored are listed in the outcome and in `failures.csv`.
pub fn validate_files(
    reference: &Path,
    options: &ValidationOptions,
    out: &Path,
    progress: &dyn Progress,
) -> Result<ValidationOutcome, BatchError> {
    let path_of = |detected: &Detected| match detected {
        Detected::Files { path, .. } => Some(path.clone()),
        Detected::Detector(_) => None,
    };
    let detections = [Some(&options.detected), options.versus.as_ref()].into_iter().flatten();
    for path in detections.filter_map(path_of).chain(options.images.clone()) {
        let readable =
            if path.is_file() { std::fs::File::open(&path).map(drop) } else { path.read_dir().map(drop) };
        readable.map_err(|source| BatchError::Unreadable { path: path.clone(), source })?;
    }
    let pairs = pairs::Pairs { reference, options };
    let (marks, ignored) = pairs.marks(out)?;
    let out = ResultFolder::open(out)?;
    let worked = for_each(&marks, progress, |input| {
        let row = image::score(input, &pairs, &out)?;
        let line = format!("Dice {:.4}", row.score.rates.dice);
        Ok((row, line))
    });
    let (rows, failures) = (worked.done, worked.failures);
    write_failures(&out, &failures)?;
    let analysis = Analysis::of(&rows, options);
    files::write(&out, &rows, analysis.as_ref(), &failures, options)?;
    let ending = out.close(worked.left)?;
    Ok(ValidationOutcome { rows, analysis, failures, ignored, ending })
}
