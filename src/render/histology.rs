use super::RenderOptions;
use super::confocal::{span, spot_heights};
use super::field::{normal, texture};
use super::spacing::CellSizes;
use crate::geometry::Point;
use crate::image::Plane;
use rand::Rng;

/// Width of the soft edge of a disc, in spacings.
const EDGE: f64 = 0.1;
/// Distance of the outline from the edge, and its standard deviation, in spacings.
const OUTLINE: f64 = 0.07;
/// How far the outline falls below the ground, for an average disc of height 1.
const OUTLINE_DEPTH: f64 = 0.45;
/// Rise and fall of a disc from one side to the other, as in differential interference contrast.
const SHADING: f64 = 0.12;

/// Inner segments cut across: discs of about height 1 with a dark outline, not quite round, not quite even, and never
/// overlapping, on a grained ground.
pub(super) fn signal(
    points: &[Point],
    cells: &CellSizes,
    options: &RenderOptions,
    rng: &mut dyn Rng,
) -> Plane {
    let (width, height) = (options.width, options.height);
    let heights = spot_heights(points, cells, options, rng);
    let mut discs = Plane::zeros((height, width));
    let mut outlines = Plane::zeros((height, width));
    for (i, (&p, peak)) in points.iter().zip(heights).enumerate() {
        let spacing = cells.spacing[i];
        let scatter = (1. + 0.05 * normal(rng)).clamp(0.8, 1.2);
        let radius = (0.5 * options.diameter * spacing * scatter).min(0.5 * cells.nearest[i]).max(0.2);
        // Amplitudes, along x and y, of the second and third harmonic of the outline.
        let oval = [0.035 * normal(rng), 0.035 * normal(rng)];
        let lobes = [0.02 * normal(rng), 0.02 * normal(rng)];
        let reach = 1.25 * radius + 3. * OUTLINE * spacing;
        let (Some(columns), Some(rows)) = (span(p.x, reach, width), span(p.y, reach, height)) else {
            continue;
        };
        for y in rows {
            for x in columns.clone() {
                let (dx, dy) = (x as f64 - p.x, y as f64 - p.y);
                let distance = (dx * dx + dy * dy).sqrt();
                let (cos, sin) = if distance > 0. { (dx / distance, dy / distance) } else { (1., 0.) };
                let shape = 1.
                    + oval[0] * (cos * cos - sin * sin)
                    + oval[1] * 2. * sin * cos
                    + lobes[0] * cos * (1. - 4. * sin * sin)
                    + lobes[1] * sin * (4. * cos * cos - 1.);
                let beyond = (distance - radius * shape) / spacing;
                if beyond > 3. * OUTLINE {
                    continue;
                }
                let inside = (0.5 - beyond / EDGE).clamp(0., 1.);
                let inside = inside * inside * (3. - 2. * inside);
                let shade = 1. + SHADING * (dx + dy) / radius;
                let disc = (peak * shade * inside) as f32;
                let outline = (-0.5 * ((beyond - OUTLINE) / OUTLINE).powi(2)).exp() as f32;
                let pixel = [y, x];
                discs[pixel] = disc.max(discs[pixel]);
                outlines[pixel] = outline.max(outlines[pixel]);
            }
        }
    }
    let depth = OUTLINE_DEPTH as f32;
    discs.zip_mut_with(&outlines, |disc, &outline| *disc -= depth * outline * (1. - disc.clamp(0., 1.)));
    if options.texture > 0. {
        let fine = texture(width, height, 0.08 * cells.typical, rng);
        let coarse = texture(width, height, 0.25 * cells.typical, rng);
        let strength = (options.texture * 0.5f64.sqrt()) as f32;
        ndarray::Zip::from(&mut discs)
            .and(&fine)
            .and(&coarse)
            .for_each(|sum, f, c| *sum += strength * (f + c));
    }
    discs
}
