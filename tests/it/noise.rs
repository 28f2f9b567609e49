//! The ring of the spectrum keeps noise from being counted.
//!
//! Noise has maxima of its own, which give more cones, so a smaller spacing, and so still more
//! cones.

use crate::common;
use conemosaic::detect::{DetectOptions, Detector, detect};
use conemosaic::image::Plane;
use conemosaic::mosaic::hexagonal_spacing;
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};

/// Number of images of each kind.
const EACH: u64 = 4;
/// Range of the spacing of the cones found over the true one. Without the bound by the ring it
/// falls to .5.
const OFF: std::ops::Range<f64> = 0.8..1.12;

/// Checks the spacing in images of a preset with noise of this standard deviation, in grey values,
/// correlated over `grain` px.
fn spacings_hold(preset: &str, noise: f64, grain: f64) {
    for seed in 0..EACH {
        let (image, true_spacing) = common::of_preset(preset, seed, |options| {
            (options.width, options.height) = (options.width.max(200), options.height.max(200));
            (options.noise, options.grain) = (noise, grain);
        });
        for detector in [Detector::Classical, Detector::Auto] {
            let found = detect(&image, &DetectOptions { detector, ..DetectOptions::default() }).unwrap();
            let off = hexagonal_spacing(found.cones.len(), image.len() as f64).unwrap() / true_spacing;
            println!("{preset}, seed {seed}, {detector:?}: spacing × {off:.3}");
            assert!(OFF.contains(&off), "{preset}, seed {seed}, {detector:?}: {off:.3}");
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

#[test]
fn no_spacing_of_small_images_of_white_noise_is_believed() {
    white_noise_is_not_believed(0..3);
}

#[test]
#[ignore = "slow: images up to 485 px a side"]
fn no_spacing_of_white_noise_is_believed() {
    white_noise_is_not_believed(3..12);
}

/// Checks that a low confidence is given to white noise, whose maxima are about equally far apart
/// and whose spectrum has a ring by chance.
fn white_noise_is_not_believed(seeds: std::ops::Range<u64>) {
    for seed in seeds {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let grey = Normal::new(128f32, 40.).unwrap();
        let side = 100 + 35 * seed as usize;
        let image = Plane::from_shape_simple_fn((side, side), || {
            grey.sample(&mut rng).round().clamp(0., 255.) / 255.
        });
        for detector in [Detector::Classical, Detector::Auto] {
            let found = detect(&image, &DetectOptions { detector, ..DetectOptions::default() }).unwrap();
            let confidence = found.spacing_confidence;
            println!("seed {seed}, {detector:?}: ring {:.2}, spacing {confidence:.3}", found.ring_confidence);
            assert!(confidence < 0.5, "seed {seed}, {detector:?}: {confidence:.2}");
        }
    }
}
