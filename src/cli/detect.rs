use super::args::{Common, DetectArgs, MODELS, ScaleArgs};
use super::{Done, ending_words};
use anyhow::Result;
use clap::Args;
use conemosaic::batch::{DetectionExtras, detect_files, image_files};
use conemosaic::report::counted;
use std::path::PathBuf;

/// Finds cones: images → coordinate CSVs
#[derive(Args)]
#[command(after_help = format!("\
Example:
  conemosaic detect images --out cones --overlay

Writes to cones/:
  NAME.csv           x_px,y_px,score, best first (and x_um,y_um where a scale is known);
                     px from 0 at the centre of the top-left pixel; score is the
                     probability, 0–1, that a person would mark a cone there
  NAME.overlay.png   with --overlay: the image with its cones marked
  NAME.rejected.csv  with --rejected: the same for candidates that were too faint
  failures.csv       images that failed, if any; then the exit code is 2

{MODELS}"))]
pub struct Detect {
    /// Images (PNG, TIFF; 8 or 16 bit, grey or colour) and folders of them
    #[arg(required = true)]
    paths: Vec<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    detect: DetectArgs,
    /// Also draw the cones on the image
    #[arg(long)]
    overlay: bool,
    /// Also write the candidates that were not taken for cones, with their scores
    #[arg(long)]
    rejected: bool,
    /// Replace coordinates that a person has made or corrected; the earlier files are put away
    #[arg(long)]
    replace_corrections: bool,
    #[command(flatten)]
    scale: ScaleArgs,
}

impl Detect {
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
