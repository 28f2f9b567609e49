use crate::batch::BatchError;
use crate::mosaic::Scale;
use crate::mosaic::io::ScaleTable;
use std::path::Path;

/// The source of the scale of images.
#[derive(Clone, Debug)]
pub enum ScaleSource {
    /// No image has a scale: results stay in pixels.
    Unknown,
    /// Every image has this scale.
    Given(Scale),
    /// All images show a field of the same width in µm. The scale of an image follows from its
    /// width in px.
    FieldWidth {
        /// Width of the field in µm.
        um: f64,
        /// Length on the retina per degree of visual angle, in µm.
        um_per_degree: f64,
    },
    /// Scales come from a table with one row per image, which is found by the name of the image.
    Table {
        /// The table of scales.
        table: ScaleTable,
        /// `true` to allow images without a row, which stay in pixels.
        optional: bool,
    },
    /// The tissue shrank while the slide was prepared. Another source gives the scale on the slide,
    /// and the correction for the shrinkage turns it into the scale of the living tissue.
    Shrunk {
        /// The source of the scale on the slide.
        slide: Box<Self>,
        /// Fraction by which lengths in the living tissue shrank, 0 to 0.9.
        shrinkage: f64,
    },
}

impl ScaleSource {
    /// Describes the source, for the record of a run.
    pub fn describe(&self) -> String {
        match self {
            Self::Unknown => "unknown: lengths in px".into(),
            Self::Given(scale) => format!("{} µm/px for all images", scale.micrometres_per_pixel()),
            Self::FieldWidth { um, .. } => format!("fields {um} µm wide"),
            Self::Table { table, .. } => format!("table of {} identifiers", table.len()),
            Self::Shrunk { slide, shrinkage } => {
                format!("{}; tissue shrunk by {} % of its length", slide.describe(), 100. * shrinkage)
            }
        }
    }

    /// Returns whether the source gives no image a scale.
    pub fn is_unknown(&self) -> bool {
        match self {
            Self::Unknown => true,
            Self::Shrunk { slide, .. } => slide.is_unknown(),
            Self::Given(_) | Self::FieldWidth { .. } | Self::Table { .. } => false,
        }
    }

    /// Returns the length in the living eye divided by the length on the slide: 1 unless the tissue
    /// shrank.
    pub fn expansion(&self) -> f64 {
        match self {
            Self::Shrunk { shrinkage, .. } => 1. / (1. - shrinkage),
            _ => 1.,
        }
    }

    /// Returns the scale of an image that is `width` px wide, in µm of living tissue per px; `None`
    /// if the scale is not known.
    ///
    /// # Errors
    /// Fails if a table has several rows for the image, or no row although it must have one; if a
    /// scale is out of range; or if the tissue shrank but no scale is known.
    pub fn scale_of(&self, path: &Path, width: usize) -> Result<Option<Scale>, BatchError> {
        match self {
            Self::Unknown => Ok(None),
            Self::Given(scale) => Ok(Some(*scale)),
            Self::FieldWidth { um, um_per_degree } => {
                Ok(Some(Scale::new(um / width as f64, *um_per_degree)?))
            }
            Self::Shrunk { slide, .. } if slide.is_unknown() => {
                Err(BatchError::ShrinkageWithoutScale { file: path.to_owned() })
            }
            Self::Shrunk { slide, .. } => {
                let scale = slide.scale_of(path, width)?;
                let alive = |s: Scale| {
                    Scale::new(s.micrometres_per_pixel() * self.expansion(), s.micrometres_per_degree())
                };
                Ok(scale.map(alive).transpose()?)
            }
            Self::Table { table, optional } => {
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                match table.scale_for(&name) {
                    Ok(scale) => Ok(Some(scale)),
                    Err(crate::mosaic::io::ScaleTableError::Missing { .. }) if *optional => Ok(None),
                    Err(error) => Err(error.into()),
                }
            }
        }
    }
}
