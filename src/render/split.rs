use super::RenderOptions;
use super::confocal::{span, spot_heights};
use super::field::{normal, smooth, texture};
use super::spacing::CellSizes;
use crate::geometry::Point;
use crate::image::Plane;
use rand::Rng;

/// Inner segments as domes (1 − ρ²)^1.5, seen by their slope along x: dark on the left, bright on the right, the
/// average cone from −1 to 1. Between them the slope of a finer relief, that of rods.
pub(super) fn signal(
    points: &[Point],
    cells: &CellSizes,
    options: &RenderOptions,
    rng: &mut dyn Rng,
) -> Plane {
    let (width, height) = (options.width, options.height);
    let heights = spot_heights(points, cells, options, rng);
    let mut plane = Plane::zeros((height, width));
    for ((&p, &spacing), peak) in points.iter().zip(&cells.spacing).zip(heights) {
        let radius = 0.5 * options.diameter * spacing * (1. + 0.08 * normal(rng)).clamp(0.7, 1.3);
        // Segments stand slightly askew: seen longer across the direction of detection, brighter or darker on the whole.
        let longer = (1.12 + 0.08 * normal(rng)).clamp(0.9, 1.4);
        let lean = 0.25 * normal(rng);
        let (Some(columns), Some(rows)) = (span(p.x, radius, width), span(p.y, radius * longer, height))
        else {
            continue;
        };
        for y in rows {
            for x in columns.clone() {
                let u = (x as f64 - p.x) / radius;
                let v = (y as f64 - p.y) / (radius * longer);
                let inside = 1. - u * u - v * v;
                if inside > 0. {
                    // √(1 − ρ²) falls off where the slope is steep: u √(1 − u²) is largest, ½, at u = 1/√2.
                    let slope = 2. * u * inside.sqrt();
                    plane[[y, x]] += (peak * (slope + lean * inside * inside)) as f32;
                }
            }
        }
    }
    if options.texture > 0. {
        let relief = texture(width, height, 0.11 * cells.typical, rng);
        let mut slope = Plane::zeros((height, width));
        for (from, mut to) in relief.outer_iter().zip(slope.outer_iter_mut()) {
            for x in 1..width {
                to[x] = from[x] - from[x - 1];
            }
        }
        let strength = options.texture as f32 / deviation(&slope).max(1e-6);
        plane.zip_mut_with(&slope, |sum, &v| *sum += strength * v);
    }
    smooth(&plane, 0.05 * cells.typical)
}

fn deviation(plane: &Plane) -> f32 {
    let squares: f64 = plane.iter().map(|&v| f64::from(v * v)).sum();
    (squares / plane.len() as f64).sqrt() as f32
}
