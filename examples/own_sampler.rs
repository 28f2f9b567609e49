//! Compares mosaics with a sampler of one's own.
//!
//!     cargo run --release --example own_sampler
//!
//! A type that implements [`Sampler`] can be used in every comparison: curves, l-infinity
//! distances, verdicts. The sampler here is a hard-core process made by removal: points are drawn
//! at random, and of any two points that are too near each other, the later one is removed
//! (Matérn's second process).

use conemosaic::compare::{References, l_infinity};
use conemosaic::prelude::*;
use conemosaic::sample::{Frame, SampleError, sampler};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Random points, thinned so that no two are nearer than the fraction `least` of the spacing.
///
/// Matérn, *Spatial Variation*, 2nd ed. (1986), <https://doi.org/10.1007/978-1-4615-7892-5>.
#[derive(Debug)]
struct Matern {
    /// Smallest distance allowed between two points, in hexagonal spacings of the points that stay.
    least: f64,
}

impl Sampler for Matern {
    fn name(&self) -> &'static str {
        "matern"
    }

    fn about(&self) -> &'static str {
        "independent points; of two that are too near, the later one is removed; about n"
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        let radius = self.least * frame.spacing(n);
        // a point stays if no earlier point lies within `radius`; of λ points per unit of area,
        // that is the fraction (1 − e^−λc) / λc, where c is the area of a disk of that radius;
        // solved for the λ at which n points stay
        let area = frame.width * frame.height;
        let disk = std::f64::consts::PI * radius * radius;
        let drawn = -(1. - n as f64 * disk / area).ln() / disk * area;
        let points: Vec<Point> = (0..drawn.round() as usize)
            .map(|_| {
                let (u, v): (f64, f64) = (rng.random(), rng.random());
                frame.place(u * frame.width, v * frame.height)
            })
            .collect();
        let stays = |&i: &usize| points[..i].iter().all(|p| distance(*p, points[i], frame) >= radius);
        Ok((0..points.len()).filter(stays).map(|i| points[i]).collect())
    }
}

/// Returns the distance between two points, around the edges if the frame is a torus.
fn distance(a: Point, b: Point, frame: &Frame) -> f64 {
    let along = |d: f64, side: f64| if frame.torus { d.abs().min(side - d.abs()) } else { d.abs() };
    along(a.x - b.x, frame.width).hypot(along(a.y - b.y, frame.height))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    static MATERN: Matern = Matern { least: 0.5 };
    let options = PcfOptions::default();
    let references = References::new(vec![&MATERN, sampler("uniform")?], options, 1);

    println!("mosaic          RI     l∞ to matern   l∞ to uniform");
    let window = Window::rectangle(0., 0., 200., 200.)?;
    let others = ["uniform", "jittered", "dart-throwing", "triangular"];
    for source in others.map(sampler).into_iter().collect::<Result<Vec<_>, _>>()? {
        let points = source.sample(400, &window, &mut ChaCha8Rng::seed_from_u64(7))?;
        let (mosaic, _) = Mosaic::new(points, window.clone(), LengthUnit::Unit, None)?;
        let measures = measure(&mosaic, &MeasureOptions::default());
        let g = pcf(mosaic.points(), &window, &options)?;
        let distances: Vec<f64> = references
            .curves(mosaic.len(), &window)
            .curves
            .iter()
            .map(|curve| l_infinity(&g, &curve.pcf))
            .collect::<Result<_, _>>()?;
        // a lattice has no regularity index: all nearest-neighbour distances are equal
        let ri = measures.summary.nearest.ri.map_or("–".to_owned(), |ri| format!("{ri:.2}"));
        println!("{:<14}  {ri:<5}  {:<13.2}  {:.2}", source.name(), distances[0], distances[1]);
    }
    Ok(())
}
