//! Detections against hand marks, for folders or single files: pairs the files, scores every image, writes what follows of all.

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

/// Where detections come from.
#[derive(Clone, Debug)]
pub enum Detected {
    /// Coordinate files NAME.csv of any program, with or without a column `score`.
    Files {
        /// Their folder, or the only one.
        path: PathBuf,
        /// How its files are to be understood.
        read: ReadOptions,
    },
    /// This program, on the images.
    Detector(DetectOptions),
}

impl Detected {
    /// In a word or two.
    fn label(&self) -> String {
        match self {
            Self::Files { path, .. } => path.display().to_string(),
            Self::Detector(options) => format!("detector {}", options.detector),
        }
    }
}

/// How detections are held against hand marks.
#[derive(Clone, Debug)]
pub struct ValidationOptions {
    /// How the marks are to be understood.
    pub read: ReadOptions,
    /// Where detections come from.
    pub detected: Detected,
    /// Detections, or marks of another grader, to compare them with.
    pub versus: Option<Detected>,
    /// Folder of images NAME.png or .tif; `None`: they are beside the marks.
    pub images: Option<PathBuf>,
    /// Width and height of all images in px; `None`: from the images.
    pub size: Option<(usize, usize)>,
    /// Which detection belongs to which mark.
    pub matching: MatchOptions,
    /// Which images belong together; `None`: every image stands alone.
    pub grouping: Option<Grouping>,
    /// Where scales come from.
    pub scales: ScaleSource,
    /// Whether hits, misses and false alarms are drawn on the images.
    pub overlays: bool,
    /// Resamples of the bootstrap.
    pub resamples: usize,
    /// Seed of the bootstrap and of permutation tests.
    pub seed: u64,
}

/// What came of a validation.
#[derive(Clone, Debug)]
pub struct ValidationOutcome {
    /// One row an image, in order of the files of marks.
    pub rows: Vec<ValidationRow>,
    /// What follows of all of them; `None` without an image.
    pub analysis: Option<Analysis>,
    /// Marks that could not be scored.
    pub failures: Vec<Failure>,
    /// Files beside the marks that belong to no image: tables of scales and the like.
    pub ignored: Vec<PathBuf>,
    /// How the batch ended.
    pub ending: Ending,
}

/// Scores every file of marks in `reference` (`NAME_coords.csv` or `NAME.csv`, or one such file) and writes `validation.csv` (a row an
/// image), `validation.json` (everything), `index.html`, `bland_altman.svg`; `groups.csv` with groups; `froc.csv` and
/// `froc.svg` where detections have scores, `reliability.csv` and `reliability.svg` where these lie between 0 and 1;
/// `comparison.csv` and `comparison.svg` where two are compared; `NAME.overlay.png` if asked for.
///
/// # Errors
/// If there are no marks or `out` cannot be written to. Marks that fail are in the outcome and in `failures.csv`.
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
