//! Noise has maxima of its own: more cones, a smaller spacing, and so still more. The ring of the spectrum holds against that.

use conemosaic::detect::{DetectOptions, Detector, detect};
use conemosaic::mosaic::hexagonal_spacing;
use conemosaic::render::{PRESETS, simulate};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Images of each kind.
const EACH: u64 = 4;
/// The spacing by what was found over the true one; without the bound it falls to .5.
const OFF: std::ops::Range<f64> = 0.8..1.12;

/// Of a preset with this noise, correlated over `grain` px, in grey values.
fn spacings_hold(preset: &str, noise: f64, grain: f64) {
    let preset = PRESETS.iter().find(|p| p.name == preset).unwrap();
    for seed in 0..EACH {
        let (mosaic, mut options) = preset.options();
        (options.width, options.height) = (options.width.max(200), options.height.max(200));
        (options.noise, options.grain) = (noise, grain);
        let simulated = simulate(&mosaic, &options, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
        let area = (options.width * options.height) as f64;
        let true_spacing = hexagonal_spacing(simulated.cones.len(), area).unwrap();
        for detector in [Detector::Classical, Detector::Auto] {
            let found =
                detect(&simulated.image, &DetectOptions { detector, ..DetectOptions::default() }).unwrap();
            let off = hexagonal_spacing(found.cones.len(), area).unwrap() / true_spacing;
            println!("{}, seed {seed}, {detector:?}: spacing × {off:.3}", preset.name);
            assert!(OFF.contains(&off), "{}, seed {seed}, {detector:?}: {off:.3}", preset.name);
        }
    }
}

#[test]
fn white_noise_at_the_parafovea() {
    spacings_hold("parafovea", 0.12, 0.);
}

#[test]
fn grainy_noise_at_the_fovea() {
    spacings_hold("fovea", 0.06, 0.8);
}

#[test]
fn noise_of_a_split_detector() {
    spacings_hold("split", 0.1, 0.8);
}
