//! Detection on images of two simulators that share nothing with `render`.
//!
//! - `scripts/simulate_coherent.py` adds up fields of coherent light.
//! - `scripts/simulate_cut_cells.py` divides a plane among cut cells.
//!
//! No weights, thresholds or constants were fitted to these images. But the images influenced some
//! decisions. The first simulator was one of the reasons to give up two ways of training the
//! confocal network. The second showed that histology needed a network, which kinds of images its
//! training lacked, and that the results of a single network for the modality depend on its seed.

use crate::common;
use conemosaic::detect::{DetectOptions, Modality, detect};
use conemosaic::image::{Plane, read};
use conemosaic::mosaic::hexagonal_spacing;
use conemosaic::mosaic::io::{Origin, ReadOptions, read_coordinates};
use rayon::prelude::*;
use std::ffi::OsStr;
use std::path::Path;

/// Number of images in each set.
const COUNT: usize = 4;
/// Fraction of the pixels that are made white in an overexposed image.
const WHITE: f64 = 0.1;
/// Largest ratio, either way, between the spacing found in a clear image and the true one.
const TOLERANCE: f64 = 1.15;

struct Set {
    /// Name of the set, as the script knows it.
    name: &'static str,
    /// `true` if the spacing of every image must be right, within [`TOLERANCE`].
    clear: bool,
    /// Modality that the program must find in every image; `None` if any modality is accepted.
    modality: Option<Modality>,
    /// Lowest mean Dice coefficient.
    dice: f64,
    /// Lowest mean Dice coefficient after the images are overexposed; `None` if they are not. The
    /// other requirements stay the same.
    overexposed: Option<f64>,
}

const fn set(name: &'static str, clear: bool, modality: Option<Modality>, dice: f64) -> Set {
    Set { name, clear, modality, dice, overexposed: None }
}

/// Results for one image with default options.
#[derive(Debug)]
struct Judged {
    dice: f64,
    /// Ratio of the spacing found to the true one.
    spacing: f64,
    modality: Modality,
}

fn judged(folder: &Path, name: &str, change: impl Fn(Plane) -> Plane) -> Judged {
    let image = change(read(&folder.join(format!("{name}.png"))).unwrap());
    let options = ReadOptions { origin: Some(Origin::Zero), ..ReadOptions::default() };
    let cones = read_coordinates(&folder.join(format!("{name}.csv")), &options).unwrap().points;
    let found = detect(&image, &DetectOptions::default()).unwrap();
    Judged {
        dice: common::dice(&found, &cones, &image),
        spacing: found.spacing / hexagonal_spacing(cones.len(), image.len() as f64).unwrap(),
        modality: found.modality,
    }
}

fn check(script: &str, sets: &[Set]) {
    let Some(python) = common::python() else {
        println!("SKIPPED images of {script}: no Python with OpenCV here, run scripts/test");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let count = COUNT.to_string();
    let mut arguments = vec![folder.path().as_os_str(), "--count".as_ref(), count.as_ref(), "--set".as_ref()];
    arguments.extend(sets.iter().map(|s| OsStr::new(s.name)));
    common::run_script(&python, script, &arguments);

    for Set { name, clear, modality, dice, overexposed } in sets {
        let check = |what: &str, least: f64, change: fn(Plane) -> Plane| {
            let name = |k: usize| format!("{name}_{k:02}");
            let images: Vec<Judged> =
                (0..COUNT).into_par_iter().map(|k| judged(folder.path(), &name(k), change)).collect();
            let mean = images.iter().map(|i| i.dice).sum::<f64>() / COUNT as f64;
            println!("{what}: mean Dice {mean:.4}, {images:.3?}");
            assert!(mean >= least, "{what}: mean Dice {mean:.4}, expected {least}");
            if *clear {
                assert!(images.iter().all(|i| i.spacing.ln().abs() < TOLERANCE.ln()), "{what}: {images:.3?}");
            }
            if let Some(modality) = modality {
                assert!(images.iter().all(|i| i.modality == *modality), "{what}: {images:.3?}");
            }
        };
        check(name, *dice, |image| image);
        if let Some(least) = overexposed {
            check(&format!("{name}, overexposed"), *least, |image| common::exposed(&image, 0., WHITE));
        }
    }
}

#[test]
fn cones_in_coherent_light_are_found() {
    // the hardest set, `parafovea-hard`, is left out
    check(
        "simulate_coherent.py",
        &[
            Set { overexposed: Some(0.98), ..set("fovea", true, Some(Modality::Confocal), 0.99) },
            set("fovea-noisy", false, None, 0.95),
            set("fovea-medium", false, None, 0.97),
            set("parafovea", true, Some(Modality::Confocal), 0.995),
            set("parafovea-medium", false, None, 0.965),
            Set { overexposed: Some(0.98), ..set("periphery", true, Some(Modality::Confocal), 0.993) },
        ],
    );
}

#[test]
fn cut_cells_are_found() {
    // the sets with rods are not `clear`: one image of four shows the ring of the rods
    check(
        "simulate_cut_cells.py",
        &[
            set("packed", true, Some(Modality::Histology), 0.98),
            Set { overexposed: Some(0.98), ..set("dark", true, Some(Modality::Histology), 0.995) },
            set("dark-wall", true, Some(Modality::Histology), 0.92),
            set("bright-wall", true, Some(Modality::Histology), 0.93),
            set("interference", true, Some(Modality::Histology), 0.995),
            set("rods", false, Some(Modality::Histology), 0.9),
            set("rods-dark", false, Some(Modality::Histology), 0.94),
        ],
    );
}
