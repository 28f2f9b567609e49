use crate::batch::BatchError;
use crate::mosaic::Scale;
use crate::mosaic::io::ScaleTable;
use std::path::Path;

/// Where the scale of images comes from.
#[derive(Clone, Debug)]
pub enum ScaleSource {
    /// Not known: results stay in pixels.
    Unknown,
    /// The same for all.
    Given(Scale),
    /// All images show a field of this width: µm, and µm per degree.
    FieldWidth {
        /// Width of the field in µm.
        um: f64,
        /// µm per degree of visual angle.
        um_per_degree: f64,
    },
    /// By the name of the image; `optional`: images without a row stay in pixels.
    Table {
        /// The table.
        table: ScaleTable,
        /// Whether an image may be missing from it.
        optional: bool,
    },
    /// Of tissue that has shrunk by this share of its living length, 0–.9: what another source says of the slide.
    Shrunk {
        /// The scale of the slide.
        slide: Box<Self>,
        /// Share of the living length that is lost.
        shrinkage: f64,
    },
}

impl ScaleSource {
    /// In words, for the record of a run.
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

    /// Whether no scale is given for any image.
    pub fn is_unknown(&self) -> bool {
        match self {
            Self::Unknown => true,
            Self::Shrunk { slide, .. } => slide.is_unknown(),
            Self::Given(_) | Self::FieldWidth { .. } | Self::Table { .. } => false,
        }
    }

    /// Living length over length on the slide: 1 unless tissue has shrunk.
    pub fn expansion(&self) -> f64 {
        match self {
            Self::Shrunk { shrinkage, .. } => 1. / (1. - shrinkage),
            _ => 1.,
        }
    }

    /// The scale of an image of `width` px: micrometres of living tissue.
    ///
    /// # Errors
    /// If the table has no row for it, or several.
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
