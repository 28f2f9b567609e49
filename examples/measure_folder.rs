//! Finds the cones of every image in a folder and prints the numbers of each mosaic.
//!
//!     cargo run --release --example measure_folder -- fixtures/images [µm per pixel]
//!
//! This is `conemosaic run` in its simplest form: image → cones → mosaic → numbers → comparison
//! with a sampler. An image that fails is reported and does not stop the others.
//! `conemosaic::batch::run_files` does the whole job, with tables, figures and a page.

use conemosaic::batch::{Input, image_files};
use conemosaic::compare::{References, l_infinity};
use conemosaic::prelude::*;
use conemosaic::sample::sampler;
use std::path::PathBuf;

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> Outcome<()> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("usage: measure_folder FOLDER [µm per pixel]")?;
    let scale = match arguments.next() {
        Some(um_per_px) => Some(Scale::new(um_per_px.parse()?, conemosaic::mosaic::MICROMETRES_PER_DEGREE)?),
        None => None,
    };
    let images = image_files(&[PathBuf::from(folder)], None)?;
    // one `References` for the entire folder, so that mosaics of about the same number of points
    // share a curve
    let references = References::new(vec![sampler("dart-throwing")?], MeasureOptions::default().pcf, 1);

    println!(
        "image                 modality     cones  density      spacing px   RI     l∞ to dart throwing"
    );
    for image in &images {
        if let Err(error) = measure_one(image, scale, &references) {
            eprintln!("{}: {error}", image.name);
        }
    }
    Ok(())
}

/// Measures one image and prints its row of the table.
fn measure_one(image: &Input, scale: Option<Scale>, references: &References) -> Outcome<()> {
    let plane = read(&image.path)?;
    let found = detect(&plane, &DetectOptions::default())?;
    let mosaic = found.mosaic(&plane, scale)?;
    let measures = measure(&mosaic, &MeasureOptions::default());

    let density = match mosaic.micrometres_per_unit() {
        Some(um) => format!("{:.0}/mm²", mosaic.density() / (um * um) * 1e6),
        None => format!("{:.4}/px²", mosaic.density()),
    };
    let spacing = mosaic.hexagonal_spacing().unwrap_or(f64::NAN);
    let regularity = measures.summary.nearest.ri.unwrap_or(f64::NAN);
    let curves = references.curves(mosaic.len(), mosaic.window()).curves;
    let distance = match (&measures.pcf, curves.first()) {
        (Ok(g), Some(curve)) => l_infinity(g, &curve.pcf)?,
        _ => f64::NAN,
    };
    println!(
        "{:<20}  {:<10}  {:>6}  {density:<11}  {spacing:<10.2}  {regularity:<5.2}  {distance:.2}",
        image.name,
        found.modality.to_string(),
        mosaic.len(),
    );
    Ok(())
}
