use super::args::{Common, DetectArgs, MODELS, ScaleArgs};
use super::{Done, ending_words};
use anyhow::Result;
use clap::Args;
use conemosaic::batch::{DetectionExtras, detect_files, image_files};
use conemosaic::report::counted;
use std::path::PathBuf;

/// Examples and files written, for the end of the help.
const HELP: &str = include_str!("help/detect.txt").trim_ascii_end();

/// Finds the cones in images and writes their coordinates
///
/// Takes images of the human retina and writes one table of cone centres per image. The type of
/// image, the contrast of the cones and their spacing are estimated from each image, unless options
/// give them. `conemosaic run` does the same and also measures the mosaic.
#[derive(Args)]
#[command(after_help = format!("{HELP}\n\n{MODELS}"))]
pub struct Detect {
    /// Images, and folders of them: PNG or TIFF, 8 or 16 bit, grey or colour
    #[arg(required = true)]
    paths: Vec<PathBuf>,
    /// Folder for the results; it is created if it does not exist
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten, next_help_heading = "Detection")]
    detect: DetectArgs,
    /// Also write each image with its cones marked
    #[arg(long, help_heading = None)]
    overlay: bool,
    /// Also write the candidates that were too faint to count as cones, with their scores
    #[arg(long, help_heading = None)]
    rejected: bool,
    /// Replace tables of cones that a person has made or corrected
    ///
    /// The replaced files are moved to .conemosaic/earlier in the folder of the results. [default:
    /// such tables are kept]
    #[arg(long, help_heading = None)]
    replace_corrections: bool,
    #[command(flatten)]
    scale: ScaleArgs,
}

impl Detect {
    /// Detects the cones in all images and writes the results.
    ///
    /// # Errors
    /// Fails if an option is wrong, there are no images, or the results cannot be written.
    pub fn execute(self, common: &Common) -> Result<Done> {
        let options = self.detect.options()?;
        let scales = self.scale.source()?;
        let inputs = image_files(&self.paths, Some(&self.out))?;
        let extras = DetectionExtras {
            overlay: self.overlay,
            rejected: self.rejected,
            replace_corrections: self.replace_corrections,
        };
        let outcome = detect_files(&inputs, &options, &scales, extras, &self.out, &*common.progress())?;
        let out = self.out.display();
        common.say(&format!(
            "{} in {}: {out}/NAME.csv",
            counted(outcome.cones, "cone"),
            counted(outcome.images, "image")
        ));
        if !outcome.failures.is_empty() {
            let failed = counted(outcome.failures.len(), "image");
            common.say(&format!("{failed} failed: {out}/failures.csv"));
        }
        common.say(&ending_words(&outcome.ending, inputs.len()));
        Ok(Done::of(&outcome.failures, &outcome.ending))
    }
}
