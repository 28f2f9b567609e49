//! Noise is not counted as cones, because Yellott's ring in the spectrum limits the spacing.
//!
//! Noise has maxima of its own. Without the limit, maxima taken for cones would lower the spacing,
//! and a smaller spacing would let in still more of them.

use crate::common;
use conemosaic::detect::{DetectOptions, Detector, detect};
use conemosaic::image::Plane;
use conemosaic::mosaic::hexagonal_spacing;
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};

/// Number of images of each kind.
const EACH: u64 = 4;
/// Range in which the spacing of the cones found, divided by the true spacing, must lie. Without
/// the lower bound from the ring, the ratio falls to .5.
const OFF: std::ops::Range<f64> = 0.8..1.12;

/// Checks the spacing in images of a preset with added noise. `noise` is its standard deviation as
/// a fraction of the full range of grey, `grain` the distance in px over which it is correlated.
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

/// Checks that the confidence is low for images of white noise. Their maxima are about equally far
/// apart, and their spectrum has a ring by chance.
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
