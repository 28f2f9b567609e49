//! `render`: simulated images whose cones are known.

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

/// Makes simulated images whose cones are known, to test detectors with
#[derive(Args)]
#[command(after_help = help())]
pub struct Render {
    /// Image to write: .png, .tif or .tiff; with --count NAME_001.png, NAME_002.png, …
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// CSV for the cones' centres: x_px,y_px,contrast,class; with --count numbered as the images are
    #[arg(long, value_name = "FILE")]
    truth: Option<PathBuf>,
    /// Which cones the truth lists: all, or seen (without the classes dim and missing)
    #[arg(long, value_name = "WHICH", default_value = "all", value_parser = ["all", "seen"], requires = "truth")]
    truth_of: String,
    /// CSV of what every image is and of all its parameters, a row an image
    #[arg(long, value_name = "FILE")]
    manifest: Option<PathBuf>,
    /// How many images (1–10000); image k has the seed --seed + k − 1
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    count: u32,
    /// A kind of image to start from: all that follows changes it
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(PRESETS.map(|p| p.name)))]
    preset: Option<String>,
    /// What kind of image: confocal, split or histology [default: the preset's, otherwise confocal]
    #[arg(long, value_name = "M", conflicts_with = "preset")]
    modality: Option<Modality>,
    /// positive: bright cones, in split detection dark left and bright right; negative: the reverse
    #[arg(long, value_name = "P", default_value = "positive")]
    polarity: Polarity,
    /// Width in px (1–16384) [default: the preset's, otherwise 150]
    #[arg(long, value_name = "PX")]
    width: Option<usize>,
    /// Height in px (1–16384) [default: the preset's, otherwise 150]
    #[arg(long, value_name = "PX")]
    height: Option<usize>,
    /// Bits per pixel: 8 or 16
    #[arg(long, value_name = "BITS", default_value = "8", value_parser = ["8", "16"])]
    bits: String,
    /// Micrometres per pixel: the truth gets x_um,y_um as well
    #[arg(long, value_name = "UM", requires = "truth")]
    um_per_px: Option<f64>,

    #[command(flatten)]
    mosaic: MosaicSource,
    #[command(flatten)]
    appearance: Appearance,
}

/// Examples, the presets, and what the words mean.
fn help() -> String {
    let presets: Vec<String> = PRESETS.iter().map(|p| format!("  {:<16} {}", p.name, p.about)).collect();
    format!(
        "\
Presets:
{}

Examples:
  conemosaic render --modality split --spacing 16 --out sim.png --truth sim.csv
  conemosaic render --preset fovea --gradient 6 --out fovea.png --truth fovea.csv
  mkdir set
  conemosaic render --preset parafovea --count 50 --spacing 7..12 --noise 0.005..0.05 --vessels 0..2 \\
    --out set/sim.png --truth set/sim.csv --manifest manifest.csv
  conemosaic validate --reference set --images set --out scores
  conemosaic render --width 4096 --height 4096 --spacing 6 --gradient 6 --gradient-shape radial --montage 6 --vessels 8 \\
    --out montage.tif --truth montage.csv

The unit s is the local distance of the cones. Without --points or --mosaic the cones form a mosaic like a real one: patches of triangular lattice with defects between, jittered.
The truth's contrast is relative to the average cone; its class is cone, dim (below 0.3: faint, behind a vessel, or cut near its tip) or missing (not drawn). Rods are not listed. What a montage does not image is 0 and holds no cones.",
        presets.join("\n")
    )
}

impl Render {
    pub fn execute(self, common: &Common) -> Result<Done> {
        if self.truth.as_ref() == Some(&self.out) {
            bail!("--out and --truth name the same file: give each its own");
        }
        if self.manifest.is_some()
            && (self.manifest == self.truth || self.manifest.as_ref() == Some(&self.out))
        {
            bail!("--manifest names the file of --out or --truth: give it its own");
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

    /// What the image of a seed is made from.
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
        // a stream of its own: what is drawn here does not change the image of given options
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(1);
        let mut image = self.appearance.options(image, self.polarity, &mut rng);
        let mosaic = self.mosaic.options(mosaic, &image, &mut rng);
        image.spacing = self.mosaic.given_spacing(&mosaic);
        image.validate()?;
        mosaic.validate()?;
        Ok((mosaic, image))
    }

    /// NAME_001.png for the first of several images.
    fn numbered(&self, path: &Path, k: u32) -> PathBuf {
        if self.count == 1 {
            return path.to_owned();
        }
        let digits = self.count.to_string().len().max(3);
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let ending = path.extension().map(|e| format!(".{}", e.to_string_lossy())).unwrap_or_default();
        path.with_file_name(format!("{stem}_{:0digits$}{ending}", k + 1))
    }

    /// Image and truth, both or neither.
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
                // a truth without its image is worth nothing, and the reason is already on its way
                let _ = std::fs::remove_file(truth);
            }
            return Err(error.into());
        }
        Ok(())
    }
}

/// Without the cones that nobody could mark.
fn seen(made: Simulation) -> Simulation {
    let all = made.cones.into_iter().zip(made.visibility);
    let (cones, visibility) = all.filter(|(_, v)| v.class == ConeClass::Cone).unzip();
    Simulation { image: made.image, cones, visibility }
}
