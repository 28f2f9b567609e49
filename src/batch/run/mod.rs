//! The main job: detects or reads the cones of every image, analyses them, and writes the results
//! into one folder.

mod cones;
mod done;
mod given;
mod image;
mod pairs;
mod record;
mod resume;

pub use cones::ConeSource;
pub use given::GivenCones;

use super::analysis::{Plan, write_landmarks, write_rois, write_verdicts};
use super::output::{Ending, OutputFolder, ResultFolder, Worked, for_each, write_failures};
use super::window::ImageWindows;
use super::{BatchError, ChannelPatterns, Crop, Failure, ImageWindow, Input, Progress};
use crate::compare::References;
use crate::detect::DetectOptions;
use crate::report::tables::{ChannelPair, RoiRow};
use crate::report::{ImageRecord, LandmarkRecord, Subject, SummaryKind, page};
use done::Done;
use image::one_image;
use std::fs;
use std::path::Path;
use std::time::Instant;

/// Name of the folder, inside the result folder, that contains one folder per image.
const IMAGES: &str = "images";
/// Name of the note that is put into the folder of an image if the image failed in the latest run,
/// so that the results there come from an earlier run.
const FAILED: &str = "FAILED.txt";

/// Options of the main job, [`run_files`].
#[derive(Clone)]
pub struct RunOptions {
    /// The plan: what is computed and written for each mosaic.
    pub plan: Plan,
    /// Source of the cones.
    pub cones: ConeSource,
    /// The window: the area of each image whose cones count.
    pub window: ImageWindow,
    /// A rectangle to which the window of each image is cut. `None` if the entire window counts.
    pub crop: Option<Crop>,
    /// Names of the images of two channels of the same field, which are compared; `None` if the
    /// names say nothing. Its modality overrules that of the manifest and of the image.
    pub pairs: Option<ChannelPatterns>,
    /// `true` to compute everything anew. `false` to keep the results of an earlier run for every
    /// image if neither the image nor the options nor the program have changed.
    pub fresh: bool,
    /// `true` to replace cones that a person has corrected; the corrected files are kept in the
    /// folder of earlier results.
    pub replace_corrections: bool,
    /// The command line, which is recorded in `run.json`.
    pub command: Vec<String>,
}

impl Default for RunOptions {
    /// Returns options with which the default detector finds the cones in the imaged part of each
    /// image, and valid results of an earlier run are kept.
    fn default() -> Self {
        Self {
            plan: Plan::default(),
            cones: ConeSource::Detector(DetectOptions::default()),
            window: ImageWindow::default(),
            crop: None,
            pairs: None,
            fresh: false,
            replace_corrections: false,
            command: Vec::new(),
        }
    }
}

/// Results of the main job, [`run_files`].
#[derive(Clone, Debug)]
pub struct RunOutcome {
    /// Records of the images with results, in the order of the inputs.
    pub records: Vec<ImageRecord>,
    /// Images without results, each with the reason.
    pub failures: Vec<Failure>,
    /// Pairs of images of the same field; empty unless asked for.
    pub pairs: Vec<ChannelPair>,
    /// Remarks on images without a partner, each a sentence.
    pub remarks: Vec<String>,
    /// Number of images for which the results of an earlier run were kept.
    pub reused: usize,
    /// End of the run: complete, or stopped early.
    pub ending: Ending,
}

/// Data that the work on all images shares.
struct Job<'a> {
    options: &'a RunOptions,
    windows: ImageWindows<'a>,
    references: References,
    out: ResultFolder,
    /// The folder `images/` inside `out`.
    images: OutputFolder,
}

/// Detects or reads the cones of every image, analyses them and writes the results into `out`.
///
/// Writes one folder per image, `images/NAME/`, with `points.csv`, `overlay.png`, `metrics.json`,
/// `pcf.csv`, `figure.svg` and what the plan asks for. Also writes `summary.csv`, `index.html` and
/// `run.json`; as the plan asks, `groups.csv`, `verdicts.csv`, `landmarks.csv` and `rois.csv`; and,
/// if an image failed, `failures.csv`. The folder of an image is replaced when its new content is
/// complete.
///
/// # Errors
/// Fails if an option is out of range, a window is to be read from a file and that file cannot be
/// read, an image lies among the results, another run is writing into `out`, or that folder cannot
/// be written to. Images that fail are listed in the outcome and in `failures.csv`.
pub fn run_files(
    inputs: &[Input],
    options: &RunOptions,
    out: &Path,
    progress: &dyn Progress,
) -> Result<RunOutcome, BatchError> {
    let started = Instant::now();
    options.plan.validate()?;
    options.plan.rois.iter().try_for_each(|request| request.refuse_overlap(out))?;
    refuse_overlap(inputs, &out.join(IMAGES))?;
    let windows = ImageWindows::new(&options.window, options.crop.as_ref())?;
    let out = ResultFolder::open(out)?;
    let images = out.folder(IMAGES)?;
    images.sweep();
    let job = Job { options, windows, references: options.plan.references(), out, images };
    let mut worked = for_each(inputs, progress, |input| {
        one_image(input, &job).or_else(|error| job.keep_earlier(input, error, progress))
    });
    pairs::warn_of_odd_ones(&mut worked.done, |path| job.modality_given(path));
    let (pairs, remarks) = job.write_pairs(&worked.done)?;
    job.write_tables(&worked, started)?;
    let outcome = job.finish(inputs, worked)?;
    Ok(RunOutcome { pairs, remarks, ..outcome })
}

/// Fails if an input image lies in the folder `images`, whose content results will replace.
fn refuse_overlap(inputs: &[Input], images: &Path) -> Result<(), BatchError> {
    let Ok(results) = images.canonicalize() else { return Ok(()) };
    let within = |input: &&Input| input.path.canonicalize().is_ok_and(|path| path.starts_with(&results));
    match inputs.iter().find(within) {
        Some(input) => Err(BatchError::Overlap { file: input.path.clone(), folder: images.to_owned() }),
        None => Ok(()),
    }
}

impl Job<'_> {
    /// Keeps the earlier results of an image that failed in this run with `error`, and writes a
    /// note about the failure beside them. Always returns an error, which mentions the earlier
    /// results if there are any.
    fn keep_earlier<T>(
        &self,
        input: &Input,
        error: BatchError,
        progress: &dyn Progress,
    ) -> Result<T, BatchError> {
        let name = &input.name;
        if !self.images.has_results(name) {
            return Err(error);
        }
        self.out.keep(&format!("{IMAGES}/{name}/"));
        let note = format!(
            "The results in this folder come from an earlier run. In the latest run the image \
             failed:\n{}\nThese results are missing from summary.csv and index.html.\n",
            progress.words(&error)
        );
        // the failure is reported whether or not the note can be written
        let _ = self.images.folder(name).and_then(|folder| folder.write(FAILED, note.as_bytes()));
        Err(BatchError::Outdated { source: Box::new(error), folder: format!("{IMAGES}/{name}") })
    }

    /// Writes the tables and the page that cover all images.
    fn write_tables(&self, worked: &Worked<Done>, started: Instant) -> Result<(), BatchError> {
        let (plan, out, done) = (&self.options.plan, &self.out, &worked.done);
        write_failures(out, &worked.failures)?;
        let summary = plan.summary(SummaryKind::Images);
        let subjects: Vec<(&str, Subject)> =
            done.iter().map(|d| (d.record.name.as_str(), Subject::Image(&d.record))).collect();
        out.write("summary.csv", &summary.csv(subjects.iter().map(|(_, subject)| *subject))?)?;
        plan.labels.write_groups(out, &summary, &subjects)?;
        if plan.verdict.is_some() {
            let found = done.iter().map(|d| (d.record.file.as_str(), d.record.mosaic.verdicts.as_slice()));
            write_verdicts(out, found)?;
        }
        let landmarks: Vec<Option<LandmarkRecord>> = done.iter().map(|d| d.landmarks.clone()).collect();
        if plan.maps.is_some() {
            write_landmarks(out, landmarks.iter().flatten())?;
        }
        if plan.rois.is_some() {
            let rows: Vec<RoiRow> = done.iter().flat_map(|d| d.regions.iter().cloned()).collect();
            write_rois(out, &plan.summary(SummaryKind::Coordinates), &rows)?;
        }
        let records: Vec<ImageRecord> = done.iter().map(|d| d.record.clone()).collect();
        let reasons: Vec<(&str, &str)> =
            worked.failures.iter().map(|f| (f.file.as_str(), f.reason.as_str())).collect();
        let text = page(&records, &landmarks, &reasons, &plan.sampler_names());
        out.write("index.html", text.as_bytes())?;
        out.write_json("run.json", &record::run_json(self.options, worked, started))
    }

    /// Ends the run and collects its outcome.
    fn finish(self, inputs: &[Input], worked: Worked<Done>) -> Result<RunOutcome, BatchError> {
        let foreign = self.foreign_folders(inputs);
        let mut ending = self.out.close(worked.left)?;
        ending.leftovers.foreign.extend(foreign);
        let reused = worked.done.iter().filter(|d| d.seconds.is_none()).count();
        let records = worked.done.into_iter().map(|d| d.record).collect();
        let (pairs, remarks) = (Vec::new(), Vec::new());
        Ok(RunOutcome { records, failures: worked.failures, pairs, remarks, reused, ending })
    }

    /// Returns the folders in `images/` that belong to no image of the run and in which the program
    /// has written nothing.
    fn foreign_folders(&self, inputs: &[Input]) -> Vec<String> {
        let entries = fs::read_dir(self.images.join("")).into_iter().flatten().flatten();
        let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
        let foreign = |name: &String| {
            !name.starts_with('.')
                && !inputs.iter().any(|input| input.name == *name)
                && !self.images.has_results(name)
        };
        let mut found: Vec<String> = names.filter(foreign).map(|name| format!("{IMAGES}/{name}")).collect();
        found.sort_unstable();
        found
    }
}
