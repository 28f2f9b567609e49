use super::RenderOptions;
use super::field::{SlowField, normal, smooth, texture};
use super::spacing::CellSizes;
use crate::geometry::Point;
use crate::image::Plane;
use rand::{Rng, RngExt};
use std::f64::consts::TAU;

/// Part of the light of neighbouring cones that interferes; the rest adds up.
const COHERENCE: f64 = 0.35;
/// Full width at half maximum of a Gaussian over its standard deviation.
const WIDTH_PER_SIGMA: f64 = 2.354_820_045;
/// Where a spot is cut off, in standard deviations of its intensity.
const CUT: f64 = 4.;

/// Cones as waveguides that send light back through a point-spread function: Gaussian spots whose centre is the cone and
/// whose mean height is 1. Light of neighbours interferes in part, with random phases, which joins or parts their spots.
pub(super) fn signal(
    points: &[Point],
    cells: &CellSizes,
    options: &RenderOptions,
    rng: &mut dyn Rng,
) -> Plane {
    let (width, height) = (options.width, options.height);
    let heights = spot_heights(points, cells, options, rng);
    let mut intensity = Plane::zeros((height, width));
    let mut real = Plane::zeros((height, width));
    let mut imaginary = Plane::zeros((height, width));
    for ((&p, &spacing), peak) in points.iter().zip(&cells.spacing).zip(heights) {
        let sigma = options.diameter * spacing / WIDTH_PER_SIGMA * (1. + 0.06 * normal(rng)).clamp(0.7, 1.3);
        let (sin, cos) = rng.random_range(0. ..TAU).sin_cos();
        let amplitude = peak.sqrt();
        let (Some(columns), Some(rows)) = (span(p.x, CUT * sigma, width), span(p.y, CUT * sigma, height))
        else {
            continue;
        };
        // The amplitude of a spot is the square root of its intensity: twice its variance.
        let profile = |range: std::ops::Range<usize>, centre: f64| -> Vec<f64> {
            range.map(|i| (-((i as f64 - centre) / sigma).powi(2) / 4.).exp()).collect()
        };
        let (across, down) = (profile(columns.clone(), p.x), profile(rows.clone(), p.y));
        for (y, v) in rows.zip(&down) {
            for (x, u) in columns.clone().zip(&across) {
                let a = amplitude * u * v;
                intensity[[y, x]] += (a * a) as f32;
                real[[y, x]] += (a * cos) as f32;
                imaginary[[y, x]] += (a * sin) as f32;
            }
        }
    }
    let coherence = COHERENCE as f32;
    ndarray::Zip::from(&mut intensity).and(&real).and(&imaginary).for_each(|sum, &re, &im| {
        *sum = (1. - coherence) * *sum + coherence * (re * re + im * im);
    });
    if options.texture > 0. {
        let haze = texture(width, height, 0.2 * cells.typical, rng);
        let haze = smooth(&haze.mapv(|v| v * v), 0.15 * cells.typical);
        let strength = options.texture as f32;
        intensity.zip_mut_with(&haze, |sum, &v| *sum += strength * v);
    }
    intensity
}

/// Log-normal, mean 1. Of the variance of the logarithm three quarters are the cone's own, one its neighbours share.
pub(super) fn spot_heights(
    points: &[Point],
    cells: &CellSizes,
    options: &RenderOptions,
    rng: &mut dyn Rng,
) -> Vec<f64> {
    let sd = (1. + options.scatter * options.scatter).ln().sqrt();
    let shared = SlowField::new(options.width, options.height, 2. * cells.typical, rng);
    points
        .iter()
        .map(|p| {
            let log = sd * (0.75f64.sqrt() * normal(rng) + 0.5 * shared.at(p.x, p.y)) - sd * sd / 2.;
            let dim = if rng.random::<f64>() < options.dim { rng.random_range(0. ..0.3) } else { 1. };
            dim * log.exp()
        })
        .collect()
}

/// Pixels of a side within `reach` of `centre`; `None` if there are none.
pub(super) fn span(centre: f64, reach: f64, side: usize) -> Option<std::ops::Range<usize>> {
    let first = (centre - reach).ceil().max(0.);
    let last = (centre + reach).floor().min(side as f64 - 1.);
    (first <= last).then(|| first as usize..last as usize + 1)
}
