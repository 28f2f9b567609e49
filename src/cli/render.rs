use super::Done;
use super::common::Common;
use anyhow::{Context, Result, bail};
use clap::Args;
use conemosaic::detect::{Modality, Polarity};
use conemosaic::geometry::{Point, Window};
use conemosaic::image::{BitDepth, write_grey};
use conemosaic::mosaic::hexagonal_spacing;
use conemosaic::mosaic::io::{ReadOptions, read_coordinates, write_points};
use conemosaic::render::{MosaicOptions, RenderOptions, Simulation, render, simulate};
use conemosaic::report::counted;
use conemosaic::sample::sampler;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::path::PathBuf;

/// Makes a simulated image whose cones are known, to test detectors with
#[derive(Args)]
#[command(after_help = "\
Example:
  conemosaic render --modality split --spacing 16 --out sim.png --truth sim.csv

The unit s is the local distance of the cones. Without --points or --mosaic the cones form a mosaic like a real one: patches of triangular lattice with defects between, jittered. --truth gets the cones' centres as x_px,y_px.")]
pub struct Render {
    /// Image to write: .png, .tif or .tiff
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// File for the cones' centres
    #[arg(long, value_name = "FILE")]
    truth: Option<PathBuf>,
    /// What kind of image: confocal, split or histology
    #[arg(long, value_name = "M", default_value = "confocal")]
    modality: Modality,
    /// positive: bright cones, in split detection dark left and bright right; negative: the reverse
    #[arg(long, value_name = "P", default_value = "positive")]
    polarity: Polarity,
    /// Width in px (1–16384)
    #[arg(long, value_name = "PX", default_value_t = 150)]
    width: usize,
    /// Height in px (1–16384)
    #[arg(long, value_name = "PX", default_value_t = 150)]
    height: usize,
    /// Bits per pixel: 8 or 16
    #[arg(long, value_name = "BITS", default_value = "8", value_parser = ["8", "16"])]
    bits: String,

    /// Hexagonal spacing of the cones in px (2–1000) [default: 9; with --points each cone's own]
    #[arg(long, value_name = "PX", help_heading = "Mosaic")]
    spacing: Option<f64>,
    /// Density at the left edge over that at the right edge (0.05–20)
    #[arg(long, value_name = "RATIO", default_value_t = 1., help_heading = "Mosaic")]
    gradient: f64,
    /// Displacement of each cone in x and y, standard deviation in s (0–0.5)
    #[arg(long, value_name = "S", default_value_t = MosaicOptions::default().jitter, help_heading = "Mosaic")]
    jitter: f64,
    /// Take the cones from a sampler, at the density of --spacing
    #[arg(long, value_name = "SAMPLER", conflicts_with_all = ["points", "gradient", "jitter"], help_heading = "Mosaic")]
    mosaic: Option<String>,
    /// Take the cones from a coordinate file in px
    #[arg(long, value_name = "FILE", conflicts_with_all = ["gradient", "jitter"], help_heading = "Mosaic")]
    points: Option<PathBuf>,

    /// Size of a cone in s (0.1–1.5): width of its spot at half maximum, or diameter of its inner segment
    #[arg(long, value_name = "S", help_heading = "Appearance (defaults depend on the modality)")]
    diameter: Option<f64>,
    /// Grey value where there is no cone (0–1)
    #[arg(long, value_name = "GREY", help_heading = "Appearance (defaults depend on the modality)")]
    brightness: Option<f64>,
    /// How far the average cone rises above that (0–1)
    #[arg(long, value_name = "GREY", help_heading = "Appearance (defaults depend on the modality)")]
    contrast: Option<f64>,
    /// Coefficient of variation of the cones' contrast (0–2)
    #[arg(long, value_name = "CV", help_heading = "Appearance (defaults depend on the modality)")]
    scatter: Option<f64>,
    /// Fraction of cones that are nearly invisible (0–1)
    #[arg(long, value_name = "F", help_heading = "Appearance (defaults depend on the modality)")]
    dim: Option<f64>,
    /// Structure that is not a cone, standard deviation in contrasts (0–2)
    #[arg(long, value_name = "F", help_heading = "Appearance (defaults depend on the modality)")]
    texture: Option<f64>,
    /// Uneven illumination, standard deviation relative to its mean (0–1)
    #[arg(long, value_name = "F", help_heading = "Appearance (defaults depend on the modality)")]
    drift: Option<f64>,
    /// Additional Gaussian blur, standard deviation in s (0–1)
    #[arg(long, value_name = "S", help_heading = "Appearance (defaults depend on the modality)")]
    blur: Option<f64>,
    /// Noise of a pixel at mid-grey, half of photons and half of the detector (0–0.5)
    #[arg(long, value_name = "GREY", help_heading = "Appearance (defaults depend on the modality)")]
    noise: Option<f64>,
    /// Correlation of the noise of neighbouring pixels, standard deviation in px (0–4; 0: white)
    #[arg(long, value_name = "PX", help_heading = "Appearance (defaults depend on the modality)")]
    grain: Option<f64>,
}

impl Render {
    pub fn execute(self, common: &Common) -> Result<Done> {
        let mut rng = ChaCha8Rng::seed_from_u64(common.seed);
        let options = self.options();
        options.validate()?;
        if self.truth.as_ref() == Some(&self.out) {
            bail!("--out and --truth name the same file: give each its own");
        }
        let simulation = if let Some(points) = self.given_points(&options, &mut rng)? {
            let image = render(&points, &options, &mut rng)?;
            let window = Window::of_image(self.width, self.height)?;
            let cones = points.into_iter().filter(|&p| window.contains(p)).collect();
            Simulation { image, cones }
        } else {
            let defaults = MosaicOptions::default();
            let mosaic = MosaicOptions {
                width: self.width,
                height: self.height,
                spacing: self.spacing.unwrap_or(defaults.spacing),
                gradient: self.gradient,
                jitter: self.jitter,
            };
            simulate(&mosaic, &options, &mut rng)?
        };
        let depth = if self.bits == "16" { BitDepth::Sixteen } else { BitDepth::Eight };
        if let Some(truth) = &self.truth {
            write_points(truth, &simulation.cones, None, None)?;
        }
        if let Err(error) = write_grey(&self.out, &simulation.image, depth) {
            if let Some(truth) = &self.truth {
                // a truth without its image is worth nothing, and the reason is already on its way
                let _ = std::fs::remove_file(truth);
            }
            return Err(error.into());
        }
        common.say(&format!(
            "{}, {}: {}",
            counted(simulation.cones.len(), "cone"),
            self.modality,
            self.out.display()
        ));
        Ok(Done::Completely)
    }

    fn options(&self) -> RenderOptions {
        let defaults = RenderOptions::new(self.modality);
        RenderOptions {
            polarity: self.polarity,
            width: self.width,
            height: self.height,
            // cones of a file may be too few to tell it; a sampler's are not, and differ from place to place
            spacing: self.points.as_ref().and(self.spacing),
            diameter: self.diameter.unwrap_or(defaults.diameter),
            brightness: self.brightness.unwrap_or(defaults.brightness),
            contrast: self.contrast.unwrap_or(defaults.contrast),
            scatter: self.scatter.unwrap_or(defaults.scatter),
            dim: self.dim.unwrap_or(defaults.dim),
            texture: self.texture.unwrap_or(defaults.texture),
            drift: self.drift.unwrap_or(defaults.drift),
            blur: self.blur.unwrap_or(defaults.blur),
            noise: self.noise.unwrap_or(defaults.noise),
            grain: self.grain.unwrap_or(defaults.grain),
            ..defaults
        }
    }

    /// Cones from a file or a sampler, if either is asked for.
    fn given_points(&self, options: &RenderOptions, rng: &mut ChaCha8Rng) -> Result<Option<Vec<Point>>> {
        if let Some(path) = &self.points {
            let file = read_coordinates(path, &ReadOptions::default())?;
            if file.unit.is_some_and(|unit| unit != conemosaic::mosaic::LengthUnit::Pixel) {
                bail!("{}: the coordinates are not in px", path.display());
            }
            return Ok(Some(file.points));
        }
        let Some(name) = &self.mosaic else { return Ok(None) };
        let window = Window::of_image(options.width, options.height)?;
        let spacing = self.spacing.unwrap_or(MosaicOptions::default().spacing);
        if !(2. ..=1000.).contains(&spacing) {
            bail!("--spacing {spacing}: expected 2 to 1000 px");
        }
        let one = hexagonal_spacing(1, window.area()).context("the image has no area")?;
        let n = (one / spacing).powi(2).round() as usize;
        Ok(Some(sampler(name)?.sample(n, &window, rng)?))
    }
}
