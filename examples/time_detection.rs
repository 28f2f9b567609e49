//! Times detection on one core, without reading and writing. The images of a list are processed one
//! after another.
//!
//!     cargo run --release --example time_detection -- ROUNDS < LIST
//!
//! A line of LIST is `PATH<TAB>SPACING<TAB>MODALITY<TAB>POLARITY`, with the spacing in px. Prints
//! `stage,round,seconds` for three stages, which `scripts/bench-detect` uses:
//!
//! - `filter`: the classical filter, its maxima and their suppression, at the spacing in LIST;
//! - `classical`: complete classical detection with default options;
//! - `auto`: complete detection with default options, by a network where that is better.

use conemosaic::detect::{
    DetectOptions, Detector, Modality, Polarity, detect, local_maxima, response, suppress,
};
use conemosaic::image::{Plane, decode, read_bytes};
use std::error::Error;
use std::hint::black_box;
use std::io::stdin;
use std::path::Path;
use std::time::Instant;

struct Item {
    image: Plane,
    spacing: f64,
    modality: Modality,
    polarity: Polarity,
}

fn item(line: &str) -> Result<Item, Box<dyn Error>> {
    let [path, spacing, modality, polarity] = line.split('\t').collect::<Vec<_>>()[..] else {
        return Err(format!("“{line}”: expected four fields").into());
    };
    let image = decode(&read_bytes(Path::new(path))?, path)?;
    Ok(Item { image, spacing: spacing.parse()?, modality: modality.parse()?, polarity: polarity.parse()? })
}

fn main() -> Result<(), Box<dyn Error>> {
    let rounds: usize = std::env::args().nth(1).ok_or("expected the number of rounds")?.parse()?;
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    let items = stdin().lines().map(|line| item(&line?)).collect::<Result<Vec<_>, _>>()?;
    let whole = |item: &Item, detector| {
        let options = DetectOptions { detector, ..DetectOptions::default() };
        black_box(detect(&item.image, &options).map(|found| found.cones.len()).ok());
    };
    let filter = |item: &Item| {
        let (response, criterion) =
            response(&item.image, item.modality, item.polarity, item.spacing, f64::INFINITY);
        let maxima = local_maxima(&response, criterion.threshold);
        black_box(criterion.select(suppress(maxima, criterion.suppression * item.spacing)));
    };
    println!("stage,round,seconds");
    for round in 0..rounds {
        let time = |stage: &str, work: &dyn Fn(&Item)| {
            let started = Instant::now();
            items.iter().for_each(work);
            println!("{stage},{round},{}", started.elapsed().as_secs_f64());
        };
        time("filter", &filter);
        time("classical", &|item| whole(item, Detector::Classical));
        time("auto", &|item| whole(item, Detector::Auto));
    }
    Ok(())
}
