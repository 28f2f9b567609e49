use super::draw::Draw;
use crate::cli::args::CoordinateArgs;
use anyhow::{Result, bail};
use clap::Args;
use conemosaic::mosaic::LengthUnit;
use conemosaic::mosaic::io::read_coordinates;
use conemosaic::render::{
    GradientShape, MosaicOptions, Pattern, RenderOptions, Simulation, picture, simulate,
};
use conemosaic::sample::sampler;
use rand::Rng;
use std::path::PathBuf;

/// Options for the positions of the cones.
#[derive(Args)]
#[command(next_help_heading = "Mosaic (N, or a range A..B from which each image draws; s: cone spacing)")]
pub struct MosaicSource {
    /// Hexagonal spacing of the cones in px (2–1000) [default: 9]
    ///
    /// It is the spacing at the mean density, or, with a radial gradient, in the middle. [default
    /// with --points: measured around each cone]
    #[arg(long, value_name = "PX")]
    spacing: Option<Draw>,
    /// Ratio of the densities at the two ends of the gradient (0.05–20) [default: 1]
    ///
    /// linear: density at the left edge divided by that at the right edge; radial: density in the
    /// middle divided by that at half the longer side from the middle. Below 1 the gradient runs
    /// the other way.
    #[arg(long, value_name = "RATIO", conflicts_with = "points")]
    gradient: Option<Draw>,
    /// Direction in which the density changes [default: linear]
    ///
    /// linear  along x
    /// radial  from the middle outwards, as around the fovea
    #[arg(long, verbatim_doc_comment, value_name = "SHAPE", value_parser = ["linear", "radial"], conflicts_with = "points")]
    gradient_shape: Option<String>,
    /// Spacing along y divided by spacing along x (0.5–2) [default: 1]
    #[arg(long, value_name = "RATIO", conflicts_with = "points")]
    anisotropy: Option<Draw>,
    /// Standard deviation of a random displacement of each cone in x and y, in cone spacings
    /// (0–0.5)
    ///
    /// [default: 0.085, which gives the regularity index of real mosaics; with --mosaic: 0]
    #[arg(long, value_name = "S", conflicts_with = "points")]
    jitter: Option<Draw>,
    /// Sampler that places the cones, instead of the built-in model of a mosaic
    ///
    /// `conemosaic sample --list` shows the samplers. The pattern is deformed to follow the
    /// gradient.
    #[arg(long, value_name = "SAMPLER", conflicts_with = "points")]
    mosaic: Option<String>,
    /// File of coordinates of the cones, in px, instead of the built-in model of a mosaic
    ///
    /// Any format that `conemosaic measure` reads.
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,
    #[command(flatten)]
    coordinates: CoordinateArgs,
}

impl MosaicSource {
    /// Returns the options of the mosaic of one image: the values set by the user, and otherwise
    /// those of `defaults`.
    ///
    /// An option that is a range draws its value for this image from `rng`.
    pub fn options(
        &self,
        defaults: MosaicOptions,
        image: &RenderOptions,
        rng: &mut dyn Rng,
    ) -> MosaicOptions {
        let mut o = MosaicOptions { width: image.width, height: image.height, ..defaults };
        if self.mosaic.is_some() {
            o.jitter = 0.;
        }
        for (given, field) in [
            (self.spacing, &mut o.spacing),
            (self.gradient, &mut o.gradient),
            (self.anisotropy, &mut o.anisotropy),
            (self.jitter, &mut o.jitter),
        ] {
            if let Some(draw) = given {
                *field = draw.value(rng);
            }
        }
        if let Some(shape) = &self.gradient_shape {
            o.shape = if shape == "radial" { GradientShape::Radial } else { GradientShape::Linear };
        }
        o
    }

    /// Returns the spacing that the user set for cones read from a file.
    ///
    /// The cones may be too few to measure their spacing. `None` if the cones are not read from a
    /// file or no spacing is set; `mosaic` has the spacing drawn for this image.
    pub fn given_spacing(&self, mosaic: &MosaicOptions) -> Option<f64> {
        self.points.as_ref().and(self.spacing).map(|_| mosaic.spacing)
    }

    /// Makes the image of one mosaic, from a file of cones, a sampler or the built-in model.
    ///
    /// # Errors
    /// Fails if the file of cones cannot be read, or the sampler or an option does not allow the
    /// image.
    pub fn picture(
        &self,
        mosaic: &MosaicOptions,
        image: &RenderOptions,
        rng: &mut dyn Rng,
    ) -> Result<Simulation> {
        if let Some(path) = &self.points {
            let file = read_coordinates(path, &self.coordinates.options()?)?;
            if file.unit.is_some_and(|unit| unit != LengthUnit::Pixel) {
                bail!("{}: the coordinates are not in px", path.display());
            }
            return Ok(picture(&file.points, image, rng)?);
        }
        let Some(name) = &self.mosaic else { return Ok(simulate(mosaic, image, rng)?) };
        let pattern = Pattern::new(mosaic)?;
        let points = sampler(name)?.sample(pattern.count(), pattern.window(), rng)?;
        let points = pattern.bent(&points, rng);
        Ok(picture(&points, image, rng)?)
    }

    /// Returns the source of the cones, for the manifest.
    pub fn name(&self) -> String {
        match (&self.points, &self.mosaic) {
            (Some(path), _) => path.display().to_string(),
            (None, Some(sampler)) => sampler.clone(),
            (None, None) => "lattice patches".to_owned(),
        }
    }
}
