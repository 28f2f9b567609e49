//! Spectrum-shaped noise against the mean curves of a reference program in `../shared/oracle/samplers`.

use conemosaic::compare::l_infinity;
use conemosaic::geometry::Window;
use conemosaic::sample::sampler;
use conemosaic::stats::{Deviation, Pcf, PcfOptions, moments, nearest_neighbours, pcf};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::path::PathBuf;

/// A column of a table, by the name in its header.
fn column(table: &str, name: &str) -> Option<Vec<f64>> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/oracle/samplers").join(table);
    if !path.exists() {
        println!("SKIPPED {table}: ../shared is not here");
        return None;
    }
    let mut reader = csv::Reader::from_path(path).unwrap();
    let index = reader.headers().unwrap().iter().position(|c| c == name).unwrap();
    Some(reader.records().map(|row| row.unwrap()[index].parse().unwrap()).collect())
}

/// Mean curve and mean regularity index (all points, population deviation) over ten seeds in the unit square.
fn mean(name: &str, n: usize) -> (Pcf, f64) {
    let window = Window::unit_square();
    let seeds = 10;
    let (mut sum, mut ri) = (None::<Pcf>, 0.);
    for seed in 0..seeds {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let points = sampler(name).unwrap().sample(n, &window, &mut rng).unwrap();
        assert_eq!(points.len(), n);
        ri += moments(&nearest_neighbours(&points, &window).distances, Deviation::Population).ri.unwrap();
        let curve = pcf(&points, &window, &PcfOptions::default()).unwrap();
        match &mut sum {
            None => sum = Some(curve),
            Some(sum) => sum.g.iter_mut().zip(&curve.g).for_each(|(s, g)| *s += g),
        }
    }
    let mut sum = sum.unwrap();
    sum.g.iter_mut().for_each(|g| *g /= seeds as f64);
    (sum, ri / seeds as f64)
}

#[test]
fn shaped_noise_has_the_pair_correlation_of_the_reference() {
    for (name, n, most) in [
        ("green", 512, 0.08),
        ("green", 1024, 0.06),
        ("pink", 512, 0.1),
        ("pink", 1024, 0.1),
        ("step", 1024, 0.05),
    ] {
        let Some(theirs) = column("pcf_mean.csv", &format!("{name}_{n}")) else { return };
        let (ours, ri) = mean(name, n);
        let theirs = Pcf { g: theirs, ..ours.clone() };
        let distance = l_infinity(&ours, &theirs).unwrap();
        println!("{name} {n}: l-infinity {distance:.4}, regularity index {ri:.4}");
        assert!(distance <= most, "{name} {n}: {distance}");
    }
}

/// The published indexes: green 1.3081 (n = 512) and 1.3849 (1024), pink 1.4197 and 1.4367.
#[test]
fn regularity_index_of_green_and_pink_is_near_the_published_one() {
    for (name, range) in [("green", 1.31..=1.40), ("pink", 1.34..=1.46)] {
        for n in [512, 1024] {
            let ri = mean(name, n).1;
            assert!(range.contains(&ri), "{name} {n}: {ri}");
        }
    }
}
