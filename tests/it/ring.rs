//! The spacing from the spectrum alone: Yellott's ring, read by a small network.

use crate::common;
use conemosaic::detect::{BORDER, RingEstimate, RingProfile, flatten};
use conemosaic::image::{Plane, read};
use conemosaic::mosaic::hexagonal_spacing;
use conemosaic::mosaic::io::{Origin, ReadOptions, read_coordinates};
use std::path::Path;

fn ring(image: &Plane) -> RingEstimate {
    RingProfile::of(&flatten(image)).spacing()
}

fn off(spacing: f64, true_spacing: f64) -> f64 {
    (spacing / true_spacing).ln().abs()
}

/// Checks the spacings that are read from the rings of simulated images. The images have 300 × 300
/// px, the options of a preset, this `blur` (in spacings) and this `noise` (standard deviation as a
/// fraction of the range of grey).
fn simulated_rings_are_read(preset: &str, blur: f64, noise: f64) {
    for seed in 100..106 {
        let (image, true_spacing) = common::of_preset(preset, seed, |options| {
            (options.width, options.height, options.blur, options.noise) = (300, 300, blur, noise);
        });
        let found = ring(&image);
        println!("{preset}, seed {seed}: {found:?}, true {true_spacing:.2} px");
        assert!(off(found.spacing, true_spacing) < 1.15f64.ln(), "{preset}, seed {seed}: {found:?}");
        assert!(found.least <= 1.1 * found.spacing);
    }
}

#[test]
fn blur_does_not_double_the_spacing() {
    simulated_rings_are_read("parafovea", 0.22, 0.02);
}

#[test]
fn rods_are_not_taken_for_the_mosaic_of_cones() {
    simulated_rings_are_read("periphery", 0.05, 0.04);
}

/// The network was trained on these images; `scripts/train-ring` judges it on subjects left out.
#[test]
fn rings_of_hand_marked_images_are_read_and_their_confidence_is_deserved() {
    let Some(root) = common::shared("data/aoslo", "rings of hand-marked images") else { return };
    let options = ReadOptions { origin: Some(Origin::One), ..ReadOptions::default() };
    for (modality, most_wrong) in [("confocal", 0.), ("split", 0.13)] {
        let (mut count, mut wrong, mut doubt) = (0., 0., 0.);
        for entry in std::fs::read_dir(root.join(modality)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|e| e != "png") {
                continue;
            }
            let image = read(&path).unwrap();
            let coordinates = path.to_string_lossy().replace(".png", "_coords.csv");
            let marks = read_coordinates(Path::new(&coordinates), &options).unwrap().points;
            // the marks leave out a frame along the border
            let (right, lower) = (image.ncols() as f64 - 0.5 - BORDER, image.nrows() as f64 - 0.5 - BORDER);
            let near = BORDER - 0.5;
            let n = marks.iter().filter(|p| p.x > near && p.y > near && p.x < right && p.y < lower).count();
            let true_spacing = hexagonal_spacing(n, (right - near) * (lower - near)).unwrap();
            let found = ring(&image);
            count += 1.;
            wrong += f64::from(u8::from(off(found.spacing, true_spacing) > 1.15f64.ln()));
            doubt += 1. - found.confidence;
        }
        println!("{modality}: {wrong} of {count} wrong, {doubt:.1} expected");
        assert!(wrong <= most_wrong * count, "{modality}: {wrong} of {count}");
        assert!((doubt - wrong).abs() < 0.05 * count, "{modality}: {doubt} expected, {wrong} wrong");
    }
}
