use anyhow::{Context, Result};
use conemosaic::files::write_atomically;
use conemosaic::render::{ConeClass, MosaicOptions, RenderOptions, Simulation};
use serde::Serialize;
use std::io::Write;
use std::path::Path;

/// Description of one image: its files, seed, numbers of cones and source of the mosaic.
#[derive(Serialize)]
pub struct Entry {
    image: String,
    /// Path of the table of true cones; empty if it is not written.
    truth: String,
    seed: u64,
    /// Number of all cones of the truth.
    cones: usize,
    /// Number of cones of class dim.
    dim_cones: usize,
    /// Number of cones of class missing.
    missing_cones: usize,
    um_per_px: Option<f64>,
    /// Source of the cones: a sampler, a file or “lattice patches”, the built-in model.
    mosaic: String,
}

impl Entry {
    /// Returns the entry of an image.
    ///
    /// `truth` is the table of true cones if it is written, and `mosaic` the source of the cones.
    pub fn new(
        (image, truth): (&Path, Option<&Path>),
        seed: u64,
        made: &Simulation,
        um_per_px: Option<f64>,
        mosaic: String,
    ) -> Self {
        let of = |class| made.visibility.iter().filter(|v| v.class == class).count();
        Self {
            image: image.display().to_string(),
            truth: truth.map(|t| t.display().to_string()).unwrap_or_default(),
            seed,
            cones: made.cones.len(),
            dim_cones: of(ConeClass::Dim),
            missing_cones: of(ConeClass::Missing),
            um_per_px,
            mosaic,
        }
    }
}

/// One row per image: its description, its mosaic and its appearance.
pub type Row = (Entry, MosaicOptions, RenderOptions);

/// Writes the manifest as CSV; the file appears complete or not at all.
///
/// # Errors
/// Fails if the file cannot be written.
pub fn write(path: &Path, rows: &[Row]) -> Result<()> {
    let mut table = csv::Writer::from_writer(Vec::new());
    for row in rows {
        table.serialize(row).context("the manifest cannot be written")?;
    }
    let bytes = table.into_inner().context("the manifest cannot be written")?;
    write_atomically(path, |writer| writer.write_all(&bytes)).with_context(|| format!("{}", path.display()))
}

/// Returns the table of the true cones: position in px, contrast and class.
///
/// If the scale is known, positions are written in µm as well.
pub fn truth(made: &Simulation, um_per_px: Option<f64>) -> String {
    let mut text = String::from("x_px,y_px,contrast,class");
    text.push_str(if um_per_px.is_some() { ",x_um,y_um\n" } else { "\n" });
    for (p, v) in made.cones.iter().zip(&made.visibility) {
        text.push_str(&format!("{},{},{:.3},{}", p.x, p.y, v.contrast, v.class.name()));
        if let Some(um) = um_per_px {
            text.push_str(&format!(",{},{}", p.x * um, p.y * um));
        }
        text.push('\n');
    }
    text
}
