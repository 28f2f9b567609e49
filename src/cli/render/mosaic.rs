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

/// Where the cones are.
#[derive(Args)]
#[command(next_help_heading = "Mosaic (A..B: drawn anew for every image)")]
pub struct MosaicSource {
    /// Hexagonal spacing of the cones in px (2–1000): of the mean density; in the middle of a radial gradient [default: 9; with
    /// --points each cone's own]
    #[arg(long, value_name = "PX")]
    spacing: Option<Draw>,
    /// Density at the left edge over that at the right edge, or in the middle over that half the longer side away (0.05–20)
    /// [default: 1]
    #[arg(long, value_name = "RATIO", conflicts_with = "points")]
    gradient: Option<Draw>,
    /// linear: along x; radial: spacing grows from the middle outwards, as around the fovea [default: linear]
    #[arg(long, value_name = "SHAPE", value_parser = ["linear", "radial"], conflicts_with = "points")]
    gradient_shape: Option<String>,
    /// Spacing along y over spacing along x (0.5–2) [default: 1]
    #[arg(long, value_name = "RATIO", conflicts_with = "points")]
    anisotropy: Option<Draw>,
    /// Displacement of each cone in x and y, standard deviation in s (0–0.5) [default: 0.085; with --mosaic 0]
    #[arg(long, value_name = "S", conflicts_with = "points")]
    jitter: Option<Draw>,
    /// Take the cones from a sampler (`conemosaic sample --list`), bent to the gradient
    #[arg(long, value_name = "SAMPLER", conflicts_with = "points")]
    mosaic: Option<String>,
    /// Take the cones from a coordinate file in px, of any dialect that `measure` reads
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,
    #[command(flatten)]
    coordinates: CoordinateArgs,
}

impl MosaicSource {
    /// The mosaic of one image: what is given over what `defaults` say.
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

    /// The spacing to draw the cones of a file with: they may be too few to tell it.
    pub fn given_spacing(&self, mosaic: &MosaicOptions) -> Option<f64> {
        self.points.as_ref().and(self.spacing).map(|_| mosaic.spacing)
    }

    /// The picture of these cones.
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

    /// Where the cones come from, for the manifest.
    pub fn name(&self) -> String {
        match (&self.points, &self.mosaic) {
            (Some(path), _) => path.display().to_string(),
            (None, Some(sampler)) => sampler.clone(),
            (None, None) => "lattice patches".to_owned(),
        }
    }
}
