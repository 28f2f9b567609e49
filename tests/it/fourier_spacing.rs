//! Modal spacing from the spectrum of images, both simulated ones and the hand-marked ones in
//! `../shared/data/aoslo`, and from the spectrum of points.

use conemosaic::detect::{FourierMapOptions, FourierSpacing, Modality, fourier_map, fourier_spacing};
use conemosaic::geometry::{Point, Window};
use conemosaic::image::{Plane, read};
use conemosaic::mosaic::hexagonal_spacing;
use conemosaic::mosaic::io::{Origin, ReadOptions, read_coordinates};
use conemosaic::render::{MosaicOptions, RenderOptions, simulate};
use conemosaic::stats::{interior, modal_spacing, nearest_neighbours, orientation, voronoi};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::fmt::{Display, Formatter};
use std::path::Path;

/// Errors of spacings: logarithms of spacing found / true spacing.
struct Off(Vec<f64>);

impl Off {
    fn mean(&self) -> f64 {
        self.0.iter().sum::<f64>() / self.0.len() as f64
    }

    fn deviation(&self) -> f64 {
        let mean = self.mean();
        let squares: f64 = self.0.iter().map(|v| (v - mean).powi(2)).sum();
        (squares / (self.0.len() - 1) as f64).sqrt()
    }

    fn largest(&self) -> f64 {
        self.0.iter().fold(0., |a, v| a.max(v.abs()))
    }

    /// Returns the errors below 15 %, and their fraction of all.
    fn near(&self) -> (Self, f64) {
        let near: Vec<f64> = self.0.iter().copied().filter(|v| v.abs() < 0.15).collect();
        let share = near.len() as f64 / self.0.len() as f64;
        (Self(near), share)
    }
}

impl Display for Off {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:+.4} ± {:.4}, at most {:.3}", self.mean(), self.deviation(), self.largest())
    }
}

fn density_spacing(points: usize, (height, width): (usize, usize)) -> f64 {
    hexagonal_spacing(points, (height * width) as f64).unwrap()
}

fn off(found: Option<FourierSpacing>, spacing: f64) -> f64 {
    found.map_or(f64::INFINITY, |f| (f.spacing / spacing).ln())
}

fn simulated(modality: Modality, spacing: f64, side: usize, seed: u64) -> (Plane, Vec<Point>) {
    let image = RenderOptions { width: side, height: side, ..RenderOptions::new(modality) };
    let mosaic = MosaicOptions { spacing, ..MosaicOptions::default() };
    let made = simulate(&mosaic, &image, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
    (made.image, made.cones)
}

#[test]
fn spacings_of_simulated_images_are_found_from_5_to_15_px() {
    // measured errors: +.022 ± .013 (confocal), +.006 ± .013 (split) and +.061 ± .007 (histology)
    // from images; +.024 ± .007 from the positions of the cones
    for (modality, mean) in
        [(Modality::Confocal, 0.022), (Modality::Split, 0.006), (Modality::Histology, 0.061)]
    {
        let all: Vec<(f64, f64)> = (0..33u64)
            .into_par_iter()
            .map(|k| {
                let (image, cones) = simulated(modality, (5 + k % 11) as f64, 240, k);
                let truth = density_spacing(cones.len(), image.dim());
                let window = Window::of_image(image.ncols(), image.nrows()).unwrap();
                let ring = modal_spacing(&cones, &window).unwrap().unwrap();
                (off(fourier_spacing(&image).unwrap().all, truth), (ring.spacing / truth).ln())
            })
            .collect();
        let (image, points): (Vec<f64>, Vec<f64>) = all.into_iter().unzip();
        let (image, points) = (Off(image), Off(points));
        println!("{modality}: image {image}; points {points}");
        assert!((image.mean() - mean).abs() < 0.01 && image.deviation() < 0.02, "{modality}: {image}");
        assert!(image.largest() < mean + 0.05, "{modality}: {image}");
        assert!((points.mean() - 0.024).abs() < 0.01 && points.largest() < 0.05, "{modality}: {points}");
    }
}

#[test]
fn spacings_of_marked_images_are_near_those_of_the_marks() {
    // measured per modality: fraction of images with errors below 15 %, mean of these errors, and
    // an upper bound of their standard deviation; the five values of a list are for all waves,
    // waves along y, waves along x, the spectrum of the marks, and the map
    let measured = [
        (Modality::Confocal, [1., 1., 1., 1., 1.], [0.035, 0.004, 0.067, 0.030, 0.026], 0.025),
        (
            Modality::Split,
            [0.837, 0.766, 0.777, 0.837, 0.842],
            [-0.029, -0.023, -0.020, -0.039, -0.031],
            0.07,
        ),
    ];
    for (modality, shares, means, deviation) in measured {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/aoslo").join(modality.name());
        let Ok(entries) = std::fs::read_dir(&folder) else {
            println!("SKIPPED modal spacing of marked images: ../shared is not here");
            return;
        };
        let mut paths: Vec<_> = entries
            .map(|e| e.unwrap().path())
            .filter(|p| p.extension().is_some_and(|e| e == "png"))
            .collect();
        paths.sort();
        let all: Vec<[f64; 5]> = paths.par_iter().map(|path| marked(path)).collect();
        for (k, name) in ["all", "row", "cell", "points", "map"].into_iter().enumerate() {
            let (near, share) = Off(all.iter().map(|v| v[k]).collect()).near();
            println!("{modality} {name}: {} images, {:.1} % near, {near}", all.len(), 100. * share);
            assert!(share > shares[k] - 0.04, "{modality} {name}: {share}");
            assert!((near.mean() - means[k]).abs() < 0.01, "{modality} {name}: {near}");
            assert!(near.deviation() < deviation, "{modality} {name}: {near}");
        }
    }
}

/// Reads an image, its marks, and the window in which they lie.
fn image_and_marks(path: &Path) -> (Plane, Vec<Point>, Window) {
    let coordinates = format!("{}_coords.csv", path.to_string_lossy().trim_end_matches(".png"));
    let options = ReadOptions { origin: Some(Origin::One), ..ReadOptions::default() };
    let mut marks = read_coordinates(Path::new(&coordinates), &options).unwrap().points;
    let image = read(path).unwrap();
    let window = Window::of_image(image.ncols(), image.nrows()).unwrap();
    marks.retain(|&p| window.contains(p));
    (image, marks, window)
}

/// Returns the errors of the spacing of an image by five methods: all waves, waves along y, waves
/// along x, the spectrum of the marks, and the map. Each error is the logarithm of the spacing
/// divided by that of the marks' density.
fn marked(path: &Path) -> [f64; 5] {
    let (image, marks, window) = image_and_marks(path);
    let truth = density_spacing(marks.len(), image.dim());
    let found = fourier_spacing(&image).unwrap();
    let points = modal_spacing(&marks, &window).unwrap();
    let map = fourier_map(&image, &found, &FourierMapOptions::default());
    let log = |spacing: Option<f64>| spacing.map_or(f64::INFINITY, |s| (s / truth).ln());
    [
        off(found.all, truth),
        off(found.row, truth),
        off(found.cell, truth),
        log(points.map(|m| m.spacing)),
        log(map.ok().map(|m| m.spacing.typical())),
    ]
}

#[test]
fn marks_and_spectra_of_confocal_images_are_stretched_alike() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/aoslo/confocal");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("SKIPPED stretch of marked images: ../shared is not here");
        return;
    };
    let paths: Vec<_> =
        entries.map(|e| e.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e == "png")).collect();
    // two logarithms of the stretch along x per image: from the neighbours of the marks, and from
    // the spectrum
    let all: Vec<[f64; 2]> = paths
        .par_iter()
        .map(|path| {
            let (image, marks, window) = image_and_marks(path);
            let (nearest, cells) = (nearest_neighbours(&marks, &window), voronoi(&marks, &window));
            let ellipse =
                orientation(&marks, &window, &nearest, &interior(&marks, &window, &nearest), &cells)
                    .ellipse
                    .unwrap();
            let along_x = ellipse.direction.map_or(0., |d| (2. * d.to_radians()).cos());
            let found = fourier_spacing(&image).unwrap();
            let ratio = found.cell.unwrap().spacing / found.row.unwrap().spacing;
            [along_x * ellipse.anisotropy.ln(), ratio.ln()]
        })
        .collect();
    let [marks, image] = [0, 1].map(|k| Off(all.iter().map(|v| v[k]).collect()));
    let products: f64 = all.iter().map(|v| (v[0] - marks.mean()) * (v[1] - image.mean())).sum();
    let correlation = products / (all.len() - 1) as f64 / (marks.deviation() * image.deviation());
    println!("{} images: marks {marks}; spectrum {image}; correlation {correlation:.3}", all.len());
    // measured: +.080 (marks), +.063 (spectrum), correlation .51
    assert!((marks.mean() - 0.08).abs() < 0.01 && (image.mean() - 0.063).abs() < 0.01);
    assert!(correlation > 0.4, "{correlation}");
}
