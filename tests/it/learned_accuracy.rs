//! The shipped networks on hand-marked images.
//!
//! The networks were trained on these images; MODEL_CARD.md says how well they generalise. The
//! tests check that the program reaches the accuracy that the training script measured, and that
//! changes of gamma, noise and scale lower the accuracy little.

use crate::common;
use conemosaic::detect::{DetectOptions, Detector, Modality, detect};
use conemosaic::geometry::Point;
use conemosaic::image::{Plane, gaussian, read};
use conemosaic::mosaic::io::{Origin, ReadOptions, read_coordinates};
use rand::RngExt;
use rand::SeedableRng;
use rayon::prelude::*;
use std::path::{Path, PathBuf};

struct Marked {
    image: Plane,
    marks: Vec<Point>,
}

/// Reads `count` images, spread evenly over the sorted files and so over the subjects. The list is
/// empty if the data are not there.
fn marked(modality: Modality, count: usize) -> Vec<Marked> {
    let folder = format!("data/aoslo/{modality}");
    let Some(folder) = common::shared(&folder, "accuracy of the learned detector") else { return Vec::new() };
    let entries = std::fs::read_dir(&folder).unwrap().map(|e| e.unwrap().path());
    let mut paths: Vec<PathBuf> = entries.filter(|p| p.extension().is_some_and(|e| e == "png")).collect();
    paths.sort();
    let load = |k: usize| {
        let path = &paths[(2 * k + 1) * paths.len() / (2 * count)];
        let coordinates = format!("{}_coords.csv", path.to_string_lossy().trim_end_matches(".png"));
        let options = ReadOptions { origin: Some(Origin::One), ..ReadOptions::default() };
        let marks = read_coordinates(Path::new(&coordinates), &options).unwrap().points;
        Marked { image: read(path).unwrap(), marks }
    };
    (0..count).map(load).collect()
}

/// Returns the mean Dice coefficient of images after `change`.
fn dice(images: &[Marked], modality: Modality, change: impl Fn(&Marked) -> Marked + Sync) -> f64 {
    let options =
        DetectOptions { modality: Some(modality), detector: Detector::Learned, ..DetectOptions::default() };
    let one = |marked: &Marked| {
        let Marked { image, marks } = change(marked);
        let found = detect(&image, &options).unwrap();
        assert!(found.cones.iter().all(|c| c.score > 0. && c.score < 1.));
        common::dice(&found, &marks, &image)
    };
    images.par_iter().map(one).collect::<Vec<_>>().iter().sum::<f64>() / images.len() as f64
}

fn as_it_is(m: &Marked) -> Marked {
    Marked { image: m.image.clone(), marks: m.marks.clone() }
}

fn with_gamma(gamma: f32) -> impl Fn(&Marked) -> Marked {
    move |m| Marked { image: m.image.mapv(|v| v.max(0.).powf(gamma)), marks: m.marks.clone() }
}

/// Applies gamma 2 and rounds to 256 grey levels. Few levels are left for the dark ground between
/// cones.
fn in_8_bits(m: &Marked) -> Marked {
    let Marked { image, marks } = with_gamma(2.)(m);
    Marked { image: image.mapv(|v| (255. * v).round() / 255.), marks }
}

/// Adds uniform noise with .3 times the standard deviation of the image.
fn with_noise(m: &Marked) -> Marked {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
    let amplitude = 0.3 * m.image.std(0.) * 12f32.sqrt();
    let image = m.image.mapv(|v| v + amplitude * (rng.random::<f32>() - 0.5));
    Marked { image, marks: m.marks.clone() }
}

/// Scales by linear interpolation, after a little blur if the image shrinks.
fn scaled(factor: f64) -> impl Fn(&Marked) -> Marked {
    move |m| {
        let source = if factor < 1. { gaussian(&m.image, 0.5 * (1. / factor - 1.)) } else { m.image.clone() };
        let (h, w) = source.dim();
        let side = |n: usize| (n as f64 * factor).round() as usize;
        let back = |k: usize, n: usize| ((k as f64 + 0.5) / factor - 0.5).clamp(0., (n - 1) as f64);
        let image = Plane::from_shape_fn((side(h), side(w)), |(y, x)| {
            let (y, x) = (back(y, h), back(x, w));
            let (j, i) = ((y as usize).min(h - 2), (x as usize).min(w - 2));
            let (v, u) = ((y - j as f64) as f32, (x - i as f64) as f32);
            (1. - v) * ((1. - u) * source[[j, i]] + u * source[[j, i + 1]])
                + v * ((1. - u) * source[[j + 1, i]] + u * source[[j + 1, i + 1]])
        });
        let place = |p: &Point| Point::new((p.x + 0.5) * factor - 0.5, (p.y + 0.5) * factor - 0.5);
        Marked { image, marks: m.marks.iter().map(place).collect() }
    }
}

/// Shrinks the image so that the hexagonal spacing of the marks is 5.5 px, as at the foveal centre.
fn with_fewer_pixels(m: &Marked) -> Marked {
    let area = (m.image.ncols() as f64 - 14.) * (m.image.nrows() as f64 - 14.);
    let inside = |v: f64, n: usize| v > 6.5 && v < n as f64 - 7.5;
    let count =
        m.marks.iter().filter(|p| inside(p.x, m.image.ncols()) && inside(p.y, m.image.nrows())).count();
    scaled(5.5 / conemosaic::mosaic::hexagonal_spacing(count, area).unwrap())(m)
}

/// Checks that the mean Dice coefficient is at least `bar` for the images as they are, and that no
/// change of the images lowers it by more than `loss`.
fn holds(modality: Modality, bar: f64, loss: f64) {
    let images = marked(modality, 20);
    if images.is_empty() {
        return;
    }
    let plain = dice(&images, modality, as_it_is);
    println!("{modality}: {plain:.4}");
    assert!(plain >= bar, "{modality}: Dice {plain:.4}, expected {bar}");
    let check = |name: &str, changed: f64| {
        println!("{modality}, {name}: {changed:.4}");
        assert!(
            changed >= plain - loss,
            "{modality}, {name}: Dice {changed:.4}, expected {plain:.4} − {loss}"
        );
    };
    check("gamma 0.5", dice(&images, modality, with_gamma(0.5)));
    check("gamma 2", dice(&images, modality, with_gamma(2.)));
    check("gamma 2, 8 bits", dice(&images, modality, in_8_bits));
    check("noise", dice(&images, modality, with_noise));
    check("× 0.7", dice(&images, modality, scaled(0.7)));
    check("× 1.5", dice(&images, modality, scaled(1.5)));
    if modality == Modality::Confocal {
        check("5.5 px between cones", dice(&images, modality, with_fewer_pixels));
    }
}

#[test]
#[ignore = "slow: seven changes of 20 images"]
fn confocal_cones_are_found_through_gamma_noise_and_scale() {
    holds(Modality::Confocal, 0.992, 0.004);
}

#[test]
#[ignore = "slow: six changes of 20 images"]
fn split_cones_are_found_through_gamma_noise_and_scale() {
    holds(Modality::Split, 0.972, 0.01);
}
