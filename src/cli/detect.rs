use super::Done;
use super::common::Common;
use super::scale::ScaleArgs;
use anyhow::Result;
use clap::Args;
use conemosaic::batch::{detect_files, image_files};
use conemosaic::detect::{DetectOptions, Detector, Modality, Polarity};
use std::path::PathBuf;

/// What may be fixed about detection; the defaults decide everything from the image.
#[derive(Args)]
pub struct DetectArgs {
    /// How the images were taken
    #[arg(long, value_name = "M", default_value = "auto", value_parser = ["auto", "confocal", "split", "histology"])]
    modality: String,
    /// Contrast: positive is bright cones, in split detection dark left and bright right
    #[arg(long, value_name = "P", default_value = "auto", value_parser = ["auto", "positive", "negative"])]
    polarity: String,
    /// Filters that find the cones
    #[arg(long, value_name = "D", default_value = "auto", value_parser = ["auto", "classical", "learned"])]
    detector: String,
    /// Cone spacing in px (4–40) to start from [default: from Yellott's ring]
    #[arg(long, value_name = "PX")]
    spacing: Option<f64>,
}

impl DetectArgs {
    /// Validated options.
    pub fn options(&self) -> Result<DetectOptions> {
        let given = |text: &str| (text != "auto").then(|| text.to_owned());
        let options = DetectOptions {
            modality: given(&self.modality)
                .map(|m| m.parse::<Modality>())
                .transpose()
                .map_err(anyhow::Error::msg)?,
            polarity: given(&self.polarity)
                .map(|p| p.parse::<Polarity>())
                .transpose()
                .map_err(anyhow::Error::msg)?,
            detector: self.detector.parse::<Detector>().map_err(anyhow::Error::msg)?,
            spacing: self.spacing,
        };
        options.validate()?;
        Ok(options)
    }
}

/// Finds cones: images → coordinate CSVs
#[derive(Args)]
#[command(after_help = "\
Example:
  conemosaic detect images --out cones --overlay

Writes to cones/: NAME.csv with x_px,y_px,score (px from 0 at the centre of the top-left pixel, best first; also
x_um,y_um if a scale is given), NAME.overlay.png with --overlay, failures.csv if an image failed (exit code 2).")]
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
    #[command(flatten)]
    scale: ScaleArgs,
}

impl Detect {
    pub fn execute(self, common: &Common) -> Result<Done> {
        let options = self.detect.options()?;
        let scales = self.scale.source()?;
        let inputs = image_files(&self.paths, Some(&self.out))?;
        let outcome = detect_files(&inputs, &options, &scales, self.overlay, &self.out, &*common.progress())?;
        let out = self.out.display();
        common.say(&format!("{} cones in {} images: {out}/NAME.csv", outcome.cones, outcome.images));
        if !outcome.failures.is_empty() {
            common.say(&format!("{} images failed: {out}/failures.csv", outcome.failures.len()));
        }
        Ok(Done::with(&outcome.failures))
    }
}
