//! The main job: the cones of every image, found or given, analysed and reported into one folder.

mod cones;
mod done;
mod given;
mod image;
mod record;
mod resume;

pub use cones::ConeSource;
pub use given::GivenCones;

use super::analysis::{Plan, write_landmarks, write_rois, write_verdicts};
use super::output::{Ending, OutputFolder, ResultFolder, Worked, for_each, write_failures};
use super::window::ImageWindows;
use super::{BatchError, Crop, Failure, ImageWindow, Input, Progress};
use crate::compare::References;
use crate::report::tables::RoiRow;
use crate::report::{ImageRecord, LandmarkRecord, Subject, SummaryKind, page};
use done::Done;
use image::one_image;
use std::fs;
use std::path::Path;
use std::time::Instant;

/// Folder of the images' own folders.
const IMAGES: &str = "images";
/// Stands among an image's earlier results when the image failed in the latest run.
const FAILED: &str = "FAILED.txt";

/// Options of the main job.
#[derive(Clone)]
pub struct RunOptions {
    /// Everything that is computed and written of every mosaic.
    pub plan: Plan,
    /// Source of the cones.
    pub cones: ConeSource,
    /// The area of each image that counts.
    pub window: ImageWindow,
    /// The rectangle of that area that counts; `None`: all of it.
    pub crop: Option<Crop>,
    /// Start anew, instead of keeping the results of an earlier run for images, options and a
    /// program that did not change.
    pub fresh: bool,
    /// Replace cones that a person has corrected; the corrected files are put away.
    pub replace_corrections: bool,
    /// The command line, for `run.json`.
    pub command: Vec<String>,
}

/// The results of a run, and what stays to be said about it.
#[derive(Clone, Debug)]
pub struct RunOutcome {
    /// One record per image, in the order of the inputs.
    pub records: Vec<ImageRecord>,
    /// Images without results.
    pub failures: Vec<Failure>,
    /// Images whose earlier results were kept.
    pub reused: usize,
    /// The end of the run: complete or stopped.
    pub ending: Ending,
}

/// The state that the work on all images shares.
struct Job<'a> {
    options: &'a RunOptions,
    windows: ImageWindows<'a>,
    references: References,
    out: ResultFolder,
    /// `images/` in it.
    images: OutputFolder,
}

/// Finds, measures, compares and reports the cones of every image into `out`.
///
/// Writes `images/NAME/` (`points.csv`, `overlay.png`, `metrics.json`, `pcf.csv`, `figure.svg` and
/// what the plan asks for), `summary.csv`, `index.html`, `run.json`, and as the plan asks
/// `groups.csv`, `verdicts.csv`, `landmarks.csv`, `rois.csv`; if an image failed, `failures.csv`. An
/// image's folder is replaced when its new content is complete.
///
/// # Errors
/// If an option is out of range, the file of a window cannot be read, another run writes into `out`,
/// or that folder cannot be written to. Images that fail are in the outcome and in `failures.csv`.
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
    let worked = for_each(inputs, progress, |input| {
        one_image(input, &job).or_else(|error| job.keep_earlier(input, error, progress))
    });
    job.write_tables(&worked, started)?;
    job.finish(inputs, worked)
}

/// Refuses images that lie where the results of an image would replace them.
fn refuse_overlap(inputs: &[Input], images: &Path) -> Result<(), BatchError> {
    let Ok(results) = images.canonicalize() else { return Ok(()) };
    let within = |input: &&Input| input.path.canonicalize().is_ok_and(|path| path.starts_with(&results));
    match inputs.iter().find(within) {
        Some(input) => Err(BatchError::Overlap { file: input.path.clone(), folder: images.to_owned() }),
        None => Ok(()),
    }
}

impl Job<'_> {
    /// Keeps the earlier results of an image that fails now, and says so beside them.
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
            "The results in this folder are of an earlier run. In the latest one the image failed:\n{}\n\
             They are not part of summary.csv and the page.\n",
            progress.words(&error)
        );
        // the failure itself is reported in any case
        let _ = self.images.folder(name).and_then(|folder| folder.write(FAILED, note.as_bytes()));
        Err(BatchError::Outdated { source: Box::new(error), folder: format!("{IMAGES}/{name}") })
    }

    /// Writes the tables and the page of all images.
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

    fn finish(self, inputs: &[Input], worked: Worked<Done>) -> Result<RunOutcome, BatchError> {
        let foreign = self.foreign_folders(inputs);
        let mut ending = self.out.close(worked.left)?;
        ending.leftovers.foreign.extend(foreign);
        let reused = worked.done.iter().filter(|d| d.seconds.is_none()).count();
        let records = worked.done.into_iter().map(|d| d.record).collect();
        Ok(RunOutcome { records, failures: worked.failures, reused, ending })
    }

    /// Returns folders among those of the images that belong to no image of the run and that the
    /// program has not written.
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
