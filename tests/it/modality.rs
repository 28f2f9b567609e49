//! The modality and the polarity that detection finds are the true ones, on simulated images of
//! every kind and on all hand-marked ones.

use crate::common;
use conemosaic::detect::{DetectOptions, Detector, Modality, Polarity, detect};
use conemosaic::image::{Plane, crop, gaussian, read};
use conemosaic::render::{
    GradientShape, MosaicOptions, PRESETS, PointSpread, Preset, RenderOptions, simulate,
};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::path::Path;
use strum::VariantArray;

/// Number of simulated images of each modality and polarity whose properties are all drawn at
/// random.
const EACH: u64 = 60;
/// Fraction of the [`EACH`] images that must be recognised. It is below 1 because some combinations
/// of gamma, noise, vessels and few cones look like another kind of image.
const RIGHT: f64 = 0.97;
/// Number of random densities for each preset, polarity and degradation.
const DENSITIES: u64 = 4;

/// Way in which a simulated image is degraded.
#[derive(Clone, Copy, Debug)]
enum Degraded {
    Not,
    Noise,
    Blur,
    LowContrast,
    BrightGamma,
    DarkGamma,
    Small,
    OverExposed,
    UnderExposed,
}

/// All ways in which images are degraded.
const DEGRADED: [Degraded; 9] = [
    Degraded::Not,
    Degraded::Noise,
    Degraded::Blur,
    Degraded::LowContrast,
    Degraded::BrightGamma,
    Degraded::DarkGamma,
    Degraded::Small,
    Degraded::OverExposed,
    Degraded::UnderExposed,
];
/// Fraction of the pixels that are made white in an overexposed image.
const WHITE: f64 = 0.1;
/// Fraction of the pixels that are made black in an underexposed image.
const BLACK: f64 = 0.1;

struct Case {
    name: String,
    image: Plane,
    modality: Modality,
    polarity: Polarity,
}

fn between(rng: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    rng.random_range(low..high)
}

/// Renders an image of a preset with a random density, degraded in one way.
fn degraded(preset: &Preset, polarity: Polarity, what: Degraded, k: u64) -> Case {
    let mut rng = ChaCha8Rng::seed_from_u64(10_000 + k);
    let (mut mosaic, mut image) = preset.options();
    mosaic.spacing *= between(&mut rng, 0.8, 1.3);
    image.polarity = polarity;
    let mut gamma = 1.;
    match what {
        Degraded::Not | Degraded::OverExposed | Degraded::UnderExposed => {}
        Degraded::Noise => image.noise = 0.3 * image.contrast,
        Degraded::Blur => image.blur = 0.15,
        Degraded::LowContrast => image.contrast *= 0.4,
        Degraded::BrightGamma => gamma = 0.5,
        Degraded::DarkGamma => gamma = 2.,
        Degraded::Small => {
            image.width = (9. * mosaic.spacing).max(60.) as usize;
            image.height = (8. * mosaic.spacing).max(56.) as usize;
        }
    }
    let modality = image.modality;
    let made = simulate(&mosaic, &image, &mut rng).unwrap().image;
    let image = match what {
        Degraded::OverExposed => common::exposed(&made, 0., WHITE),
        Degraded::UnderExposed => common::exposed(&made, BLACK, 0.),
        _ => made.mapv(|v| v.max(1. / 255.).powf(gamma)),
    };
    Case { name: format!("{} {} {what:?} {k}", preset.name, polarity.name()), image, modality, polarity }
}

/// Renders an image of random density, size, contrast, noise, blur and look, with a random gamma.
fn drawn(modality: Modality, polarity: Polarity, k: u64) -> Case {
    let mut rng = ChaCha8Rng::seed_from_u64(1000 * k + 10 * modality as u64 + polarity as u64);
    let r = &mut rng;
    let spacing = match modality {
        Modality::Confocal => between(r, 5., 17.),
        Modality::Split => between(r, 9., 24.),
        Modality::Histology => between(r, 6.5, 24.),
    };
    let side = (spacing * between(r, 8., 22.)).clamp(64., 320.);
    let mosaic = MosaicOptions {
        spacing,
        gradient: *pick(r, &[1., 1., 1., 2., 3.]),
        shape: *pick(r, &[GradientShape::Linear, GradientShape::Linear, GradientShape::Radial]),
        jitter: between(r, 0.06, 0.13),
        ..MosaicOptions::default()
    };
    let defaults = RenderOptions::new(modality);
    let common = RenderOptions {
        polarity,
        width: side as usize,
        height: ((side * between(r, 0.75, 1.2)) as usize).max(56),
        scatter: defaults.scatter * between(r, 0.7, 1.3),
        dim: between(r, 0., 0.08),
        missing: *pick(r, &[0., 0., 0.03]),
        drift: between(r, 0., 0.22),
        vessels: *pick(r, &[0, 0, 0, 1]),
        blur: between(r, 0., 0.14),
        noise: between(r, 0.005, 0.05),
        grain: between(r, 0., 1.),
        ..defaults
    };
    let options = match modality {
        Modality::Confocal => RenderOptions {
            psf: *pick(r, &[PointSpread::Gaussian, PointSpread::Airy]),
            diameter: between(r, 0.42, 0.66),
            contrast: between(r, 0.14, 0.4),
            texture: between(r, 0.02, 0.14),
            multimodal: *pick(r, &[0., 0., 0.1]),
            ..common
        },
        Modality::Split => RenderOptions {
            diameter: between(r, 0.65, 1.1),
            contrast: between(r, 0.1, 0.28),
            texture: between(r, 0.08, 0.35),
            lean: *pick(r, &[0., 0., 0.4]),
            elongation: between(r, 0.97, 1.18),
            ..common
        },
        Modality::Histology => {
            let (shading, outline, granules) =
                *pick(r, &[(0.12, 0.45, 0.), (0.1, 0.2, 0.), (0.4, 0.8, 0.), (0., 1.5, 0.4)]);
            RenderOptions {
                diameter: between(r, 0.58, 0.92),
                contrast: between(r, 0.14, 0.5),
                texture: between(r, 0.03, 0.25),
                size_scatter: between(r, 0.03, 0.18),
                section: *pick(r, &[0., 0., 0.3]),
                orientation: between(r, 0., 360.),
                shading,
                outline,
                granules,
                ..common
            }
        }
    };
    let gamma: f32 = *pick(r, &[0.5, 1., 1., 2.]);
    let image = simulate(&mosaic, &options, r).unwrap().image.mapv(|v| v.max(1. / 255.).powf(gamma));
    Case { name: format!("{} {} {k}", modality.name(), polarity.name()), image, modality, polarity }
}

fn pick<'a, T>(rng: &mut ChaCha8Rng, all: &'a [T]) -> &'a T {
    &all[rng.random_range(0..all.len())]
}

/// Returns a table of how often each kind of image was taken for each kind, and the names of the
/// images that were taken for a wrong kind.
fn confusion(cases: impl IntoParallelIterator<Item = Case>) -> (String, Vec<String>) {
    let classical = DetectOptions { detector: Detector::Classical, ..DetectOptions::default() };
    let kind = |m: Modality, p: Polarity| 2 * m as usize + p as usize;
    let taken: Vec<(usize, usize, String)> = cases
        .into_par_iter()
        .map(|case| {
            let found = detect(&case.image, &classical).unwrap();
            (kind(case.modality, case.polarity), kind(found.modality, found.polarity), case.name)
        })
        .collect();
    let mut counts = [[0; 6]; 6];
    taken.iter().for_each(|(is, as_, _)| counts[*is][*as_] += 1);
    let mut text = String::from("is \\ taken for     confocal + −   split + −   histology + −\n");
    for (row, count) in counts.iter().enumerate().filter(|(_, c)| c.iter().any(|n| *n > 0)) {
        let (modality, polarity) = (Modality::VARIANTS[row / 2], Polarity::VARIANTS[row % 2]);
        text += &format!("{:<10}{:<9}{count:?}\n", modality.name(), polarity.name());
    }
    let wrong = taken.into_iter().filter(|(is, as_, _)| is != as_).map(|(_, as_, name)| {
        format!(
            "{name} taken for {} {}",
            Modality::VARIANTS[as_ / 2].name(),
            Polarity::VARIANTS[as_ % 2].name()
        )
    });
    (text, wrong.collect())
}

#[test]
#[ignore = "slow: every preset, polarity and degradation"]
fn simulated_images_of_every_look_are_taken_for_what_they_are() {
    let mut all = Vec::new();
    for preset in &PRESETS {
        for &polarity in Polarity::VARIANTS {
            for what in DEGRADED {
                all.extend((0..DENSITIES).map(|k| (preset, polarity, what, k)));
            }
        }
    }
    let count = all.len();
    let (text, wrong) = confusion(all.into_par_iter().map(|(p, q, what, k)| degraded(p, q, what, k)));
    println!("{count} images\n{text}{}", wrong.join("\n"));
    assert!(wrong.is_empty(), "{} of {count}: {wrong:#?}", wrong.len());
}

#[test]
#[ignore = "slow: hundreds of simulated images"]
fn nearly_all_images_are_taken_for_what_they_are_however_much_is_wrong_with_them() {
    let kinds = Modality::VARIANTS.iter().flat_map(|&m| Polarity::VARIANTS.iter().map(move |&p| (m, p)));
    let cases: Vec<(Modality, Polarity, u64)> =
        kinds.flat_map(|(m, p)| (0..EACH).map(move |k| (m, p, k))).collect();
    let count = cases.len();
    let (text, wrong) = confusion(cases.into_par_iter().map(|(m, p, k)| drawn(m, p, k)));
    println!("{count} images\n{text}{}", wrong.join("\n"));
    assert!(wrong.len() as f64 <= (1. - RIGHT) * count as f64, "{} of {count}: {wrong:#?}", wrong.len());
}

/// Every image is tested as it is. Every fifth image is also tested with gamma ½ and 2, with noise
/// of .3 times its standard deviation, blurred by 1 px, as a negative, over- and underexposed, and
/// cropped. The crop has 80 × 80 px for confocal images and 112 × 112 px for split-detector images,
/// whose spacings go up to 22 px: reading a ring takes five spacings.
#[test]
#[ignore = "slow: hundreds of images"]
fn hand_marked_images_are_taken_for_what_they_are() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/aoslo");
    if !root.exists() {
        println!("SKIPPED: no {}", root.display());
        return;
    }
    let mut cases = Vec::new();
    for modality in [Modality::Confocal, Modality::Split] {
        let mut files: Vec<_> = std::fs::read_dir(root.join(modality.name()))
            .unwrap()
            .map(|e| e.unwrap().path())
            .filter(|p| p.extension().is_some_and(|e| e == "png"))
            .collect();
        files.sort();
        for (k, file) in files.iter().enumerate() {
            let image = read(file).unwrap();
            let name = file.file_stem().unwrap().to_string_lossy();
            let mut add = |what: &str, image: Plane, polarity| {
                cases.push(Case { name: format!("{name} {what}"), image, modality, polarity });
            };
            if k % 5 == 0 {
                let lifted = image.mapv(|v| v.max(1. / 255.));
                let mut rng = ChaCha8Rng::seed_from_u64(k as u64);
                add("gamma .5", lifted.mapv(f32::sqrt), Polarity::Positive);
                add("gamma 2", lifted.mapv(|v| v * v), Polarity::Positive);
                add("noise", noisy(&lifted, 0.3, &mut rng), Polarity::Positive);
                add("blur", gaussian(&lifted, 1.), Polarity::Positive);
                add("negative", lifted.mapv(|v| 1. - v), Polarity::Negative);
                add("white", common::exposed(&image, 0., WHITE), Polarity::Positive);
                add("black", common::exposed(&image, BLACK, 0.), Polarity::Positive);
                let side = if modality == Modality::Split { 112 } else { 80 };
                let (y, x) = ((image.nrows() - side) / 2, (image.ncols() - side) / 2);
                add("crop", crop(&lifted, y, x, side, side), Polarity::Positive);
            }
            add("", image, Polarity::Positive);
        }
    }
    let (text, wrong) = confusion(cases);
    println!("{text}{}", wrong.join("\n"));
    assert!(wrong.is_empty(), "{wrong:#?}");
}

fn noisy(image: &Plane, part: f32, rng: &mut dyn Rng) -> Plane {
    use rand_distr::{Distribution, StandardNormal};
    let sd = part * image.std(0.);
    image.mapv(|v| {
        let deviate: f32 = StandardNormal.sample(rng);
        (v + sd * deviate).max(1. / 255.)
    })
}
