//! Modal spacing from the spectrum of images, of known truth and of hand-marked ones from `../shared/data/aoslo`, and from points.

use conemosaic::detect::{FourierMapOptions, FourierSpacing, Modality, fourier_map, fourier_spacing};
use conemosaic::geometry::{Point, Window};
use conemosaic::image::{Plane, read};
use conemosaic::mosaic::hexagonal_spacing;
use conemosaic::mosaic::io::{Origin, ReadOptions, read_coordinates};
use conemosaic::render::{MosaicOptions, RenderOptions, simulate};
use conemosaic::stats::modal_spacing;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::path::Path;

/// Logarithms of what was found over what is there.
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

    /// Those within 15 %, and their share.
    fn near(&self) -> (Self, f64) {
        let near: Vec<f64> = self.0.iter().copied().filter(|v| v.abs() < 0.15).collect();
        let share = near.len() as f64 / self.0.len() as f64;
        (Self(near), share)
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
    for (modality, most) in [(Modality::Confocal, 0.), (Modality::Split, 0.), (Modality::Histology, 0.)] {
        let all: Vec<(f64, f64)> = (0..33u64)
            .into_par_iter()
            .map(|k| {
                let (image, cones) = simulated(modality, (5 + k % 11) as f64, 240, k);
                let truth = density_spacing(cones.len(), image.dim());
                let (height, width) = image.dim();
                let ring = modal_spacing(&cones, &Window::of_image(width, height).unwrap()).unwrap().unwrap();
                (off(fourier_spacing(&image).unwrap().all, truth), (ring.spacing / truth).ln())
            })
            .collect();
        let (image, points): (Vec<f64>, Vec<f64>) = all.into_iter().unzip();
        let (image, points) = (Off(image), Off(points));
        println!(
            "{modality}: image {:+.3} ± {:.3}, at most {:.3}; points {:+.3} ± {:.3}, at most {:.3}",
            image.mean(),
            image.deviation(),
            image.largest(),
            points.mean(),
            points.deviation(),
            points.largest()
        );
        let _ = most;
    }
}

#[test]
fn spacings_of_marked_images_are_near_those_of_the_marks() {
    for modality in [Modality::Confocal, Modality::Split] {
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
        let all: Vec<[f64; 5]> = paths
            .par_iter()
            .map(|path| {
                let coordinates = format!("{}_coords.csv", path.to_string_lossy().trim_end_matches(".png"));
                let options = ReadOptions { origin: Some(Origin::One), ..ReadOptions::default() };
                let marks = read_coordinates(Path::new(&coordinates), &options).unwrap().points;
                let image = read(path).unwrap();
                let (height, width) = image.dim();
                let truth = density_spacing(marks.len(), image.dim());
                let found = fourier_spacing(&image).unwrap();
                let window = Window::of_image(width, height).unwrap();
                let inside: Vec<Point> = marks.into_iter().filter(|&p| window.contains(p)).collect();
                let points = modal_spacing(&inside, &window)
                    .unwrap()
                    .map_or(f64::INFINITY, |m| (m.spacing / truth).ln());
                let map = fourier_map(&image, &FourierMapOptions::default());
                let mapped = map.map_or(f64::INFINITY, |m| (m.spacing.typical() / truth).ln());
                [off(found.all, truth), off(found.row, truth), off(found.cell, truth), points, mapped]
            })
            .collect();
        for (k, name) in ["all", "row", "cell", "points", "map"].into_iter().enumerate() {
            let off = Off(all.iter().map(|v| v[k]).collect());
            let (near, share) = off.near();
            println!(
                "{modality} {name}: {} images, {:.1} % within 15 %, of these {:+.4} ± {:.4}",
                all.len(),
                100. * share,
                near.mean(),
                near.deviation()
            );
        }
    }
}
