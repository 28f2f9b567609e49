use anyhow::{Result, bail};
use clap::Args;
use conemosaic::batch::ScaleSource;
use conemosaic::mosaic::io::ScaleTable;
use conemosaic::mosaic::{MICROMETRES_PER_DEGREE, Scale, micrometres_per_degree};
use std::path::PathBuf;

/// Options for the size of a pixel on the retina; without any, results stay in pixels.
#[derive(Args)]
#[command(next_help_heading = "Scale (give at most one; without any, results are in px)")]
pub struct ScaleArgs {
    /// Micrometres on the retina per pixel, the same for all images
    #[arg(long, value_name = "UM", group = "scale")]
    um_per_px: Option<f64>,
    /// Width of the image on the retina in micrometres, the same for all images
    #[arg(long, value_name = "UM", group = "scale")]
    field_um: Option<f64>,
    /// Width of the image in degrees of visual angle, the same for all images
    #[arg(long, value_name = "DEG", group = "scale")]
    field_degrees: Option<f64>,
    /// Pixels per degree of visual angle, the same for all images
    #[arg(long, value_name = "PX", group = "scale")]
    px_per_degree: Option<f64>,
    /// CSV file with the scale of each image
    ///
    /// Columns: identifier,um_per_px or identifier,axial_length_mm,pixels_per_degree. A row belongs
    /// to the images whose file name contains its identifier; of several such rows the one with the
    /// longest identifier counts.
    #[arg(long, value_name = "FILE", group = "scale")]
    scale_table: Option<PathBuf>,
    /// Measure images without a row in --scale-table in pixels; without this option they fail
    #[arg(long, requires = "scale_table")]
    unscaled: bool,
    /// Micrometres on the retina per degree of visual angle [default: 288]
    ///
    /// The default is that of an average eye (Drasdo & Fowler 1974).
    #[arg(long, value_name = "UM", requires = "scale", conflicts_with = "axial_length")]
    um_per_degree: Option<f64>,
    /// Axial length of the eye in mm, to compute the micrometres per degree
    ///
    /// µm per degree = 291 × length / 24 mm, so 24 mm gives 291 (without this option: 288). This is
    /// the rule of the Metricks package.
    #[arg(long, value_name = "MM", requires = "scale")]
    axial_length: Option<f64>,
    /// Linear shrinkage of post-mortem tissue, as a fraction of its living length (0–0.9)
    ///
    /// 0.1 means that 10 µm of living retina are 9 µm on the slide. The scale is that of the slide.
    /// Results in micrometres are then those of the living retina: lengths are divided by 1 − F,
    /// densities multiplied by (1 − F)². [default: no shrinkage]
    #[arg(long, value_name = "F")]
    shrinkage: Option<f64>,
}

impl ScaleArgs {
    /// Returns the source of the scales.
    ///
    /// # Errors
    /// Fails if a value is out of its range or the table cannot be read.
    pub fn source(&self) -> Result<ScaleSource> {
        let slide = self.slide()?;
        match self.shrinkage {
            None => Ok(slide),
            Some(shrinkage) if (0. ..=0.9).contains(&shrinkage) => {
                Ok(ScaleSource::Shrunk { slide: Box::new(slide), shrinkage })
            }
            Some(shrinkage) => {
                bail!("--shrinkage is {shrinkage}: it must be a fraction of the living length, 0 to 0.9")
            }
        }
    }

    /// Returns the source of the scales before shrinkage is taken into account.
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
                bail!("the width of the image (--field-um, --field-degrees) must be a positive number");
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
