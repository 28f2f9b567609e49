//! Scores the detector against marks that were set by hand.
//!
//! `conemosaic::batch::validate_files` does the whole job, with groups, intervals, curves and a
//! page.
//!
//!     cargo run --release --example validate_marks -- IMAGES MARKS [ORIGIN]
//!
//! Each image NAME.png or NAME.tif in the folder IMAGES needs a file NAME.csv or NAME_coords.csv in
//! the folder MARKS. ORIGIN is the coordinate of the centre of the top-left pixel in these files: 0
//! (the default), or 1 for marks made in MATLAB. Try it with
//!
//!     cargo run --release --example validate_marks -- fixtures/images fixtures/truth

use conemosaic::batch::image_files;
use conemosaic::compare::validate;
use conemosaic::mosaic::io::{ReadOptions, read_coordinates};
use conemosaic::prelude::*;
use std::path::{Path, PathBuf};

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> Outcome<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [images, marks, rest @ ..] = &arguments[..] else {
        return Err("usage: validate_marks IMAGES MARKS [ORIGIN]".into());
    };
    let origin = rest.first().map(|text| text.parse()).transpose()?;
    let options = ReadOptions { origin, ..ReadOptions::default() };

    let mut dice = Vec::new();
    println!("image                 marks  sensitivity  false discovery rate  Dice");
    for image in image_files(&[PathBuf::from(images)], None)? {
        let Some(file) = marks_of(Path::new(marks), &image.name) else {
            eprintln!("{}: no marks in {marks}", image.name);
            continue;
        };
        let reference = read_coordinates(&file, &options)?.points;
        let plane = read(&image.path)?;
        let (height, width) = plane.dim();
        let found = detect(&plane, &DetectOptions::default())?.centres();

        let (score, _pairs) = validate(&reference, &found, width, height, &MatchOptions::default())?;
        let rates = score.rates;
        println!(
            "{:<20}  {:>5}  {:<11.3}  {:<20.3}  {:.4}",
            image.name,
            reference.len(),
            rates.sensitivity,
            rates.fdr,
            rates.dice
        );
        dice.push(rates.dice);
    }
    if !dice.is_empty() {
        println!("mean Dice of {} images: {:.4}", dice.len(), dice.iter().sum::<f64>() / dice.len() as f64);
    }
    Ok(())
}

/// Returns the file of marks that belongs to an image; `None` if there is none.
fn marks_of(folder: &Path, name: &str) -> Option<PathBuf> {
    let names = [format!("{name}.csv"), format!("{name}_coords.csv")];
    names.iter().map(|file| folder.join(file)).find(|path| path.is_file())
}
