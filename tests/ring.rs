//! The spacing by the spectrum alone: Yellott's ring, read by a small network.

use conemosaic::detect::{RingEstimate, RingProfile, flatten};
use conemosaic::image::{Plane, read};
use conemosaic::mosaic::hexagonal_spacing;
use conemosaic::render::{PRESETS, simulate};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::path::Path;

fn ring(image: &Plane) -> RingEstimate {
    RingProfile::of(&flatten(image)).spacing()
}

fn off(spacing: f64, true_spacing: f64) -> f64 {
    (spacing / true_spacing).ln().abs()
}

/// Of a preset, 300 px wide and with this additional blur, in spacings.
fn simulated_rings_are_read(preset: &str, blur: f64, noise: f64) {
    let preset = PRESETS.iter().find(|p| p.name == preset).unwrap();
    for seed in 100..106 {
        let (mosaic, mut options) = preset.options();
        (options.width, options.height, options.blur, options.noise) = (300, 300, blur, noise);
        let simulated = simulate(&mosaic, &options, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
        let true_spacing = hexagonal_spacing(simulated.cones.len(), 300. * 300.).unwrap();
        let found = ring(&simulated.image);
        println!("{}, seed {seed}: {found:?}, true {true_spacing:.2} px", preset.name);
        assert!(off(found.spacing, true_spacing) < 1.15f64.ln(), "{}, seed {seed}: {found:?}", preset.name);
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

/// Its training has seen them: subjects left out are judged by scripts/train-ring.
#[test]
fn rings_of_hand_marked_images_are_read_and_their_confidence_is_deserved() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/aoslo");
    if !root.exists() {
        println!("SKIPPED: no {}", root.display());
        return;
    }
    for (modality, most_wrong) in [("confocal", 0.), ("split", 0.13)] {
        let (mut count, mut wrong, mut doubt) = (0., 0., 0.);
        for entry in std::fs::read_dir(root.join(modality)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|e| e != "png") {
                continue;
            }
            let image = read(&path).unwrap();
            let marks =
                std::fs::read_to_string(path.to_string_lossy().replace(".png", "_coords.csv")).unwrap();
            let (height, width) = image.dim();
            // the marks leave out a frame
            let inside = |line: &&str| {
                let mut xy = line.split(',').map(|v| v.trim().parse::<f64>().unwrap_or(f64::NAN) - 1.);
                let (x, y) = (xy.next().unwrap(), xy.next().unwrap());
                x > 6.5 && y > 6.5 && x < width as f64 - 7.5 && y < height as f64 - 7.5
            };
            let n = marks.lines().filter(inside).count();
            let true_spacing = hexagonal_spacing(n, ((width - 14) * (height - 14)) as f64).unwrap();
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
