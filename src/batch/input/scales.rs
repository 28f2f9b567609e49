use crate::batch::BatchError;
use crate::mosaic::Scale;
use crate::mosaic::io::ScaleTable;
use std::path::Path;

/// The source of the scale of images.
#[derive(Clone, Debug)]
pub enum ScaleSource {
    /// No source: results stay in pixels.
    Unknown,
    /// The same scale for every image.
    Given(Scale),
    /// A field width shared by all images, from which the scale follows by their width in px.
    FieldWidth {
        /// Width of the field in µm.
        um: f64,
        /// Length on the retina per degree of visual angle, in µm.
        um_per_degree: f64,
    },
    /// A table with one row per image, matched by the image's name.
    Table {
        /// The table of scales.
        table: ScaleTable,
        /// Allows images without a row; they stay in pixels.
        optional: bool,
    },
    /// The scale that another source gives for a slide, corrected for tissue that shrank in
    /// preparation.
    Shrunk {
        /// The scale of the slide.
        slide: Box<Self>,
        /// Lost share of the living length, 0 to 0.9.
        shrinkage: f64,
    },
}

impl ScaleSource {
    /// Returns the source in words, for the record of a run.
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

    /// Returns whether no image is given a scale.
    pub fn is_unknown(&self) -> bool {
        match self {
            Self::Unknown => true,
            Self::Shrunk { slide, .. } => slide.is_unknown(),
            Self::Given(_) | Self::FieldWidth { .. } | Self::Table { .. } => false,
        }
    }

    /// Returns the living length over the length on the slide: 1 unless the tissue shrank.
    pub fn expansion(&self) -> f64 {
        match self {
            Self::Shrunk { shrinkage, .. } => 1. / (1. - shrinkage),
            _ => 1.,
        }
    }

    /// Returns the scale of an image that is `width` px wide, in µm of living tissue per px; `None`
    /// where it is not known.
    ///
    /// # Errors
    /// If a table has several rows for the image, or none where it must have one; if a scale is out
    /// of range; or if a shrinkage is given without a scale.
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
