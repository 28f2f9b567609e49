//! Split-detector images: inner segments are domes, of which the slope is seen.
//!
//! Brightness is in units of the contrast: 0 is a level surface, and 1 is the steepest slope of an
//! average cone.

use super::RenderOptions;
use super::confocal::span;
use super::field::{normal, smooth, texture};
use super::rods::Rod;
use super::spacing::CellSizes;
use crate::geometry::Point;
use crate::image::Plane;
use rand::Rng;

/// Diameter of a rod's dome divided by the typical distance between rods.
const ROD: f64 = 0.9;
/// Steepness of the flanks of a vessel, which makes their brightness, in units of the contrast; it
/// is multiplied by the vessel's depth.
const VESSEL_RELIEF: f64 = 0.4;

/// Draws inner segments as domes, seen by their slope along the direction of detection
/// `options.orientation`.
///
/// At distance ρ from its centre, in radii, a dome is (1 − ρ²)^1.5 high. It is dark on one side and
/// bright on the other, from −1 to 1 for the average cone; `heights` are the extremes of the cones.
/// Between the cones lie rods, which are smaller domes, and the slope of a finer relief.
pub(super) fn signal(
    points: &[Point],
    cells: &CellSizes,
    heights: &[f64],
    rods: &[Rod],
    options: &RenderOptions,
    rng: &mut dyn Rng,
) -> Plane {
    let (width, height) = (options.width, options.height);
    let (sin, cos) = options.orientation.to_radians().sin_cos();
    let mut relief = Relief { plane: Plane::zeros((height, width)), sin, cos };
    let cv = options.size_scatter;
    for ((&p, &spacing), &peak) in points.iter().zip(&cells.spacing).zip(heights) {
        // At the default scatter of 0.08, sizes stay from 0.7 to 1.3 times the mean. Even at the
        // largest scatter no size falls below 0.3, as a radius must be positive.
        let scatter = (1. + cv * normal(rng)).clamp((1. - 3.75 * cv).max(0.3), 1. + 3.75 * cv);
        let radius = 0.5 * options.diameter * spacing * scatter;
        // Segments stand slightly askew: they look longer across the direction of detection, and
        // their middle is brighter or darker than the surround.
        let longer = (options.elongation + 0.08 * normal(rng)).clamp(0.5, 2.);
        let lean = options.lean + 0.25 * normal(rng);
        relief.add_dome(p, radius, longer, peak, lean);
    }
    for rod in rods {
        relief.add_dome(rod.centre, 0.5 * ROD * rod.pitch, 1., rod.height, 0.25 * normal(rng));
    }
    let mut plane = relief.plane;
    if options.texture > 0. {
        let slope = slope(&texture(width, height, 0.11 * cells.typical, rng), sin, cos);
        // scaled to the standard deviation `texture`; 1e-6 keeps an even plane from a division by 0
        let strength = options.texture as f32 / deviation(&slope).max(1e-6);
        plane.zip_mut_with(&slope, |sum, &v| *sum += strength * v);
    }
    smooth(&plane, 0.05 * cells.typical)
}

/// Adds the flanks of vessels to `plane`, and weakens the cones behind them.
///
/// `vessels` is 1 on the axis of a vessel and 0 outside, and `spacing` is the median spacing, in
/// px.
pub(super) fn cover(plane: &mut Plane, vessels: &Plane, options: &RenderOptions, spacing: f64) {
    let (sin, cos) = options.orientation.to_radians().sin_cos();
    // A vessel's profile is steep at its edge; smoothing keeps the flanks from becoming thin lines.
    let soft = smooth(vessels, 0.15 * options.vessel_width * spacing);
    let steepness = (VESSEL_RELIEF * options.vessel_width * spacing * options.vessel_depth) as f32;
    let shade = options.vessel_depth as f32;
    let flanks = slope(&soft, sin, cos);
    ndarray::Zip::from(plane)
        .and(vessels)
        .and(&flanks)
        .for_each(|v, depth, flank| *v = *v * (1. - shade * depth) - steepness * flank);
}

/// Plane on which domes are drawn, with the sine and cosine of the direction of detection.
struct Relief {
    plane: Plane,
    sin: f64,
    cos: f64,
}

impl Relief {
    /// Adds the slope of a dome at `p`; lengths are in px.
    ///
    /// `longer` is the ratio of the dome's length across the direction of detection to its length
    /// along that direction, `radius`. `peak` is the brightness of the bright side. `lean` is the
    /// brightness of the middle, relative to `peak`.
    fn add_dome(&mut self, p: Point, radius: f64, longer: f64, peak: f64, lean: f64) {
        let (height, width) = self.plane.dim();
        let (sin, cos) = (self.sin, self.cos);
        let reach = |along: f64, across: f64| radius * (along.powi(2) + (longer * across).powi(2)).sqrt();
        let (columns, rows) = (span(p.x, reach(cos, sin), width), span(p.y, reach(sin, cos), height));
        let (Some(columns), Some(rows)) = (columns, rows) else { return };
        for y in rows {
            for x in columns.clone() {
                let (dx, dy) = (x as f64 - p.x, y as f64 - p.y);
                let u = (dx * cos + dy * sin) / radius;
                let v = (dy * cos - dx * sin) / (radius * longer);
                let inside = 1. - u * u - v * v;
                if inside > 0. {
                    // The slope of a dome (1 − ρ²)^1.5 along u is proportional to u √(1 − ρ²). On
                    // the line through the centre that is u √(1 − u²), which is largest, ½, at u =
                    // 1/√2; hence the factor 2.
                    let slope = 2. * u * inside.sqrt();
                    self.plane[[y, x]] += (peak * (slope + lean * inside * inside)) as f32;
                }
            }
        }
    }
}

/// Returns the slope per px of a relief along the direction whose angle from x has the sine `sin`
/// and the cosine `cos`.
///
/// The first column, and the first row unless the direction is along x, are 0.
fn slope(relief: &Plane, sin: f64, cos: f64) -> Plane {
    let (along_x, along_y) = (cos as f32, sin as f32);
    let (height, width) = relief.dim();
    Plane::from_shape_fn((height, width), |(y, x)| {
        if x == 0 || (y == 0 && along_y != 0.) {
            return 0.;
        }
        let here = relief[[y, x]];
        let down = if along_y == 0. { 0. } else { along_y * (here - relief[[y - 1, x]]) };
        along_x * (here - relief[[y, x - 1]]) + down
    })
}

/// Returns the root mean square of the values.
fn deviation(plane: &Plane) -> f32 {
    let squares: f64 = plane.iter().map(|&v| f64::from(v * v)).sum();
    (squares / plane.len() as f64).sqrt() as f32
}
