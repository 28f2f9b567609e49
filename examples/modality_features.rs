//! Prints the features by which modality and polarity are decided, for `scripts/train-modality`.
//!
//!     cargo run --release --example modality_features < images.txt
//!
//! Each line of the input is the path of an image. Each line of the output has the features of one
//! image, separated by commas: first those by which the modality is decided, then those by which it
//! is decided on which side a split detector shows cones dark.

use conemosaic::detect::modality_features;
use conemosaic::image::{decode, read_bytes};
use std::error::Error;
use std::io::stdin;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    for path in stdin().lines() {
        let path = path?;
        let features = modality_features(&decode(&read_bytes(Path::new(&path))?, &path)?)?;
        let numbers: Vec<String> =
            features.modality.iter().chain(&features.direction).map(f64::to_string).collect();
        println!("{}", numbers.join(","));
    }
    Ok(())
}
