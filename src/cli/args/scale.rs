use anyhow::{Result, bail};
use clap::Args;
use conemosaic::batch::ScaleSource;
use conemosaic::mosaic::io::ScaleTable;
use conemosaic::mosaic::{MICROMETRES_PER_DEGREE, Scale, micrometres_per_degree};
use std::path::PathBuf;

/// How large a pixel is; without any of these, results stay in pixels.
#[derive(Args)]
#[command(next_help_heading = "Scale (at most one source; none: results in px)")]
pub struct ScaleArgs {
    /// Micrometres on the retina per pixel, the same for all images
    #[arg(long, value_name = "UM", group = "scale")]
    um_per_px: Option<f64>,
    /// Width of the imaged field in micrometres, the same for all images
    #[arg(long, value_name = "UM", group = "scale")]
    field_um: Option<f64>,
    /// Width of the imaged field in degrees of visual angle
    #[arg(long, value_name = "DEG", group = "scale")]
    field_degrees: Option<f64>,
    /// Pixels per degree of visual angle
    #[arg(long, value_name = "PX", group = "scale")]
    px_per_degree: Option<f64>,
    /// CSV of identifier,um_per_px or identifier,axial_length_mm,pixels_per_degree: the row whose identifier is the
    /// longest part of the file name counts
    #[arg(long, value_name = "FILE", group = "scale")]
    scale_table: Option<PathBuf>,
    /// Images missing from the scale table stay in pixels instead of failing
    #[arg(long, requires = "scale_table")]
    unscaled: bool,
    /// Micrometres per degree [default: 288, Drasdo & Fowler 1974]
    #[arg(long, value_name = "UM", requires = "scale", conflicts_with = "axial_length")]
    um_per_degree: Option<f64>,
    /// Axial length of the eye in mm: 291 µm per degree × length / 24 mm
    #[arg(long, value_name = "MM", requires = "scale")]
    axial_length: Option<f64>,
    /// Linear shrinkage of post-mortem tissue, as a share of its living length (0–0.9): 0.1 if 10 µm alive are 9 µm on the
    /// slide. Micrometres are then those of the living retina: lengths divided by 1 − F, densities multiplied by (1 − F)²
    #[arg(long, value_name = "F")]
    shrinkage: Option<f64>,
}

impl ScaleArgs {
    /// Where scales come from.
    pub fn source(&self) -> Result<ScaleSource> {
        let slide = self.slide()?;
        match self.shrinkage {
            None => Ok(slide),
            Some(shrinkage) if (0. ..=0.9).contains(&shrinkage) => {
                Ok(ScaleSource::Shrunk { slide: Box::new(slide), shrinkage })
            }
            Some(shrinkage) => {
                bail!("--shrinkage is {shrinkage}: it must be a share of the length, 0 to 0.9")
            }
        }
    }

    fn slide(&self) -> Result<ScaleSource> {
        let per_degree = match (self.um_per_degree, self.axial_length) {
            (Some(um), _) => Scale::new(1., um)?.micrometres_per_degree(),
            (None, Some(mm)) => micrometres_per_degree(mm)?,
            (None, None) => MICROMETRES_PER_DEGREE,
        };
        if let Some(um) = self.um_per_px {
            return Ok(ScaleSource::Given(Scale::new(um, per_degree)?));
        }
        if let Some(px) = self.px_per_degree {
            return Ok(ScaleSource::Given(Scale::from_pixels_per_degree(px, per_degree)?));
        }
        if let Some(um) = self.field_um.or_else(|| self.field_degrees.map(|d| d * per_degree)) {
            if !(um.is_finite() && um > 0.) {
                bail!("the width of the field must be a positive number");
            }
            return Ok(ScaleSource::FieldWidth { um, um_per_degree: per_degree });
        }
        if let Some(path) = &self.scale_table {
            let table = ScaleTable::read(path, per_degree)?;
            return Ok(ScaleSource::Table { table, optional: self.unscaled });
        }
        Ok(ScaleSource::Unknown)
    }
}
