//! The command `render`, which makes simulated images whose cones are known.

mod appearance;
mod draw;
mod manifest;
mod mosaic;

use super::Done;
use super::args::Common;
use anyhow::{Context, Result, bail};
use appearance::Appearance;
use clap::Args;
use clap::builder::PossibleValuesParser;
use conemosaic::detect::{Modality, Polarity};
use conemosaic::files::write_atomically;
use conemosaic::image::{BitDepth, write_grey};
use conemosaic::mosaic::{MICROMETRES_PER_DEGREE, Scale};
use conemosaic::render::{ConeClass, MosaicOptions, PRESETS, Preset, RenderOptions, Simulation};
use conemosaic::report::counted;
use mosaic::MosaicSource;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Makes simulated images whose cones are known
///
/// The images show cones as a confocal or split-detector adaptive-optics ophthalmoscope or a
/// histological micrograph shows them. With --truth the positions of all cones are written too, so
/// that detectors can be tested and trained. It needs no files.
#[derive(Args)]
#[command(after_help = help())]
pub struct Render {
    /// Image file to write: .png, .tif or .tiff
    ///
    /// With --count N the files are NAME_001.png, NAME_002.png, …
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// CSV file for the true cones
    ///
    /// Columns: x_px,y_px,contrast,class. With --count the files are numbered like the images.
    #[arg(long, value_name = "FILE")]
    truth: Option<PathBuf>,
    /// Cones that --truth lists: all, or seen (those of class cone, without dim and missing ones)
    #[arg(long, value_name = "WHICH", default_value = "all", value_parser = ["all", "seen"], requires = "truth")]
    truth_of: String,
    /// CSV file for the parameters of the images, one row per image
    #[arg(long, value_name = "FILE")]
    manifest: Option<PathBuf>,
    /// Number of images (1–10000)
    ///
    /// Image k has the seed --seed + k − 1, and can be made alone with that seed.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    count: u32,
    /// Preset: a typical image, which the other options change
    ///
    /// The presets are described at the end of this help.
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(PRESETS.map(|p| p.name)))]
    preset: Option<String>,
    /// Type of image: confocal, split or histology [default: that of the preset, otherwise
    /// confocal]
    #[arg(long, value_name = "M", conflicts_with = "preset")]
    modality: Option<Modality>,
    /// Contrast of the cones: positive or negative
    ///
    /// positive  cones are brighter than their surround; in split-detector
    ///           images they are dark on the left and bright on the right
    /// negative  the reverse
    #[arg(long, verbatim_doc_comment, value_name = "P", default_value = "positive")]
    polarity: Polarity,
    /// Width of the image in px (1–16384) [default: that of the preset, otherwise 150]
    #[arg(long, value_name = "PX")]
    width: Option<usize>,
    /// Height of the image in px (1–16384) [default: that of the preset, otherwise 150]
    #[arg(long, value_name = "PX")]
    height: Option<usize>,
    /// Bits per pixel of the image file
    #[arg(long, value_name = "BITS", default_value = "8", value_parser = ["8", "16"])]
    bits: String,
    /// Micrometres per pixel; --truth then has the columns x_um,y_um as well
    #[arg(long, value_name = "UM", requires = "truth")]
    um_per_px: Option<f64>,

    #[command(flatten)]
    mosaic: MosaicSource,
    #[command(flatten)]
    appearance: Appearance,
}

/// Examples and the meaning of terms, for the end of the help.
const HELP: &str = include_str!("../help/render.txt").trim_ascii_end();

/// Returns the presets with their descriptions, followed by the examples.
fn help() -> String {
    let presets: Vec<String> = PRESETS.iter().map(|p| format!("  {}\n      {}", p.name, p.about)).collect();
    format!("Presets (lengths in px are the spacing of the cones):\n{}\n\n{HELP}", presets.join("\n"))
}

impl Render {
    /// Makes the images and writes them with their truth and manifest.
    ///
    /// # Errors
    /// Fails if an option is wrong or a file cannot be written.
    pub fn execute(self, common: &Common) -> Result<Done> {
        if self.truth.as_ref() == Some(&self.out) {
            bail!("--out and --truth name the same file: give each a file of its own");
        }
        if self.manifest.is_some()
            && (self.manifest == self.truth || self.manifest.as_ref() == Some(&self.out))
        {
            bail!("--manifest names the file of --out or --truth: give it a file of its own");
        }
        let um_per_px = self.um_per_px.map(|um| Scale::new(um, MICROMETRES_PER_DEGREE)).transpose()?;
        let um_per_px = um_per_px.map(|scale| scale.micrometres_per_pixel());
        let mut rows = Vec::new();
        for k in 0..self.count {
            let Some(seed) = common.seed.checked_add(u64::from(k)) else {
                bail!("--seed {} is too large for {} images", common.seed, self.count);
            };
            let (image, truth) =
                (self.numbered(&self.out, k), self.truth.as_ref().map(|t| self.numbered(t, k)));
            let (mosaic, options) = self.options(seed)?;
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut made = self.mosaic.picture(&mosaic, &options, &mut rng)?;
            if self.truth_of == "seen" {
                made = seen(made);
            }
            self.write(&made, &image, truth.as_deref(), um_per_px)?;
            common.say(&format!(
                "{}, {}: {}",
                counted(made.cones.len(), "cone"),
                options.modality,
                image.display()
            ));
            let files = (image.as_path(), truth.as_deref());
            let entry = manifest::Entry::new(files, seed, &made, um_per_px, self.mosaic.name());
            rows.push((entry, mosaic, options));
        }
        if let Some(path) = &self.manifest {
            manifest::write(path, &rows)?;
        }
        Ok(Done::Completely)
    }

    /// Returns the options of the mosaic and of the image for one seed.
    fn options(&self, seed: u64) -> Result<(MosaicOptions, RenderOptions)> {
        let preset = self.preset.as_deref().and_then(Preset::named);
        let (mosaic, mut image) = match preset {
            Some(preset) => preset.options(),
            None => {
                let modality = self.modality.unwrap_or(Modality::Confocal);
                (MosaicOptions::default(), RenderOptions::new(modality))
            }
        };
        if let Some(option) = self.appearance.foreign(image.modality) {
            bail!("{option} does not exist in {} images", image.modality);
        }
        image.width = self.width.unwrap_or(image.width);
        image.height = self.height.unwrap_or(image.height);
        // options that are ranges draw from a separate random stream, so that they leave the random
        // numbers of the image itself unchanged
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(1);
        let mut image = self.appearance.options(image, self.polarity, &mut rng);
        let mosaic = self.mosaic.options(mosaic, &image, &mut rng);
        image.spacing = self.mosaic.given_spacing(&mosaic);
        image.validate()?;
        mosaic.validate()?;
        Ok((mosaic, image))
    }

    /// Returns the path of image `k`, counted from 0: NAME_001.png for the first of several images.
    fn numbered(&self, path: &Path, k: u32) -> PathBuf {
        if self.count == 1 {
            return path.to_owned();
        }
        let digits = self.count.to_string().len().max(3);
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let ending = path.extension().map(|e| format!(".{}", e.to_string_lossy())).unwrap_or_default();
        path.with_file_name(format!("{stem}_{:0digits$}{ending}", k + 1))
    }

    /// Writes the image and, if `truth` is a path, its true cones: both files or neither.
    fn write(
        &self,
        made: &Simulation,
        image: &Path,
        truth: Option<&Path>,
        um_per_px: Option<f64>,
    ) -> Result<()> {
        if let Some(truth) = truth {
            let text = manifest::truth(made, um_per_px);
            write_atomically(truth, |writer| writer.write_all(text.as_bytes()))
                .with_context(|| truth.display().to_string())?;
        }
        let depth = if self.bits == "16" { BitDepth::Sixteen } else { BitDepth::Eight };
        if let Err(error) = write_grey(image, &made.image, depth) {
            if let Some(truth) = truth {
                // a truth without its image is useless; the error below already tells the reason
                let _ = std::fs::remove_file(truth);
            }
            return Err(error.into());
        }
        Ok(())
    }
}

/// Returns the simulation without the cones of class dim or missing, which nobody could mark.
fn seen(made: Simulation) -> Simulation {
    let all = made.cones.into_iter().zip(made.visibility);
    let (cones, visibility) = all.filter(|(_, v)| v.class == ConeClass::Cone).unzip();
    Simulation { image: made.image, cones, visibility }
}
