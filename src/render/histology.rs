//! Histological images: inner segments cut across, as discs with a dark outline on a grained
//! ground.

use super::RenderOptions;
use super::confocal::span;
use super::field::{normal, texture};
use super::rods::Rod;
use super::spacing::CellSizes;
use crate::geometry::Point;
use crate::image::Plane;
use rand::Rng;

/// Width of the soft edge of a disc, in spacings.
const EDGE: f64 = 0.1;
/// Distance between the edge of a disc and its outline, and the standard deviation of the outline's
/// profile, in spacings.
const OUTLINE: f64 = 0.07;
/// Diameter of a rod's disc divided by the distance between rods.
const ROD: f64 = 0.7;
/// Standard deviation of the height at which a cell is cut, relative to the mean height of the
/// section.
///
/// Heights are measured from the widest place of the inner segments, in half axes.
const UNEVEN_SECTION: f64 = 0.25;

/// Returns the size of each cell in the section relative to its widest place, or 0 if the section
/// misses the cell.
pub(super) fn section(count: usize, options: &RenderOptions, rng: &mut dyn Rng) -> Vec<f64> {
    if options.section == 0. {
        return vec![1.; count];
    }
    let mut cut = || {
        let height = options.section + UNEVEN_SECTION * options.section * normal(rng);
        (1. - height * height).max(0.).sqrt()
    };
    (0..count).map(|_| cut()).collect()
}

/// Draws inner segments cut across: discs of about height 1 with a dark outline on a grained
/// ground.
///
/// The discs are not quite round or even, and never overlap.
pub(super) fn signal(
    points: &[Point],
    cells: &CellSizes,
    heights: &[f64],
    sizes: &[f64],
    rods: &[Rod],
    options: &RenderOptions,
    rng: &mut dyn Rng,
) -> Plane {
    let (width, height) = (options.width, options.height);
    let mut section = Section::empty(options);
    let cv = options.size_scatter;
    for (i, (&p, &peak)) in points.iter().zip(heights).enumerate() {
        let spacing = cells.spacing[i];
        let scatter = (1. + cv * normal(rng)).clamp((1. - 4. * cv).max(0.3), 1. + 4. * cv);
        let radius = (0.5 * options.diameter * spacing * scatter).min(0.5 * cells.nearest[i]).max(0.2);
        // Amplitudes of the second and third harmonic of the outline, each along x and y.
        let oval = [0.035 * normal(rng), 0.035 * normal(rng)];
        let lobes = [0.02 * normal(rng), 0.02 * normal(rng)];
        if peak > 0. && sizes[i] > 0. {
            section.add_disc(&Disc {
                centre: p,
                radius: radius * sizes[i],
                scale: spacing,
                peak,
                oval,
                lobes,
            });
        }
    }
    for rod in rods {
        let disc = Disc {
            centre: rod.centre,
            radius: 0.5 * ROD * rod.pitch,
            scale: rod.pitch,
            peak: rod.height,
            oval: [0.; 2],
            lobes: [0.; 2],
        };
        section.add_disc(&disc);
    }
    let Section { mut discs, outlines, inside, .. } = section;
    let depth = options.outline as f32;
    discs.zip_mut_with(&outlines, |disc, &outline| *disc -= depth * outline * (1. - disc.clamp(0., 1.)));
    if options.granules > 0. {
        let granules = texture(width, height, 0.1 * cells.typical, rng);
        let strength = options.granules as f32;
        ndarray::Zip::from(&mut discs)
            .and(&inside)
            .and(&granules)
            .for_each(|sum, inside, grain| *sum += strength * inside * grain);
    }
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

/// Cell that is cut across; lengths are in px.
struct Disc {
    centre: Point,
    radius: f64,
    /// Local spacing in px, of which the widths of edge and outline are multiples.
    scale: f64,
    /// Height of the disc's centre over the ground.
    peak: f64,
    /// Amplitudes of the second harmonic of the outline, along x and y.
    oval: [f64; 2],
    /// Amplitudes of the third harmonic of the outline, along x and y.
    lobes: [f64; 2],
}

/// Planes on which cells are drawn.
struct Section {
    discs: Plane,
    outlines: Plane,
    inside: Plane,
    /// Change of a disc's height over one radius, to the right and downwards, relative to the
    /// height.
    shading: [f64; 2],
}

impl Section {
    fn empty(options: &RenderOptions) -> Self {
        let plane = || Plane::zeros((options.height, options.width));
        let (sin, cos) = options.orientation.to_radians().sin_cos();
        let strength = 2f64.sqrt() * options.shading;
        let shading = [strength * cos, strength * sin];
        Self { discs: plane(), outlines: plane(), inside: plane(), shading }
    }

    fn add_disc(&mut self, disc: &Disc) {
        let (height, width) = self.discs.dim();
        let Disc { centre: p, radius, scale, peak, oval, lobes } = *disc;
        let reach = 1.25 * radius + 3. * OUTLINE * scale;
        let (Some(columns), Some(rows)) = (span(p.x, reach, width), span(p.y, reach, height)) else { return };
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
                let beyond = (distance - radius * shape) / scale;
                if beyond > 3. * OUTLINE {
                    continue;
                }
                let inside = (0.5 - beyond / EDGE).clamp(0., 1.);
                let inside = inside * inside * (3. - 2. * inside);
                let shade = 1. + (self.shading[0] * dx + self.shading[1] * dy) / radius;
                let disc = (peak * shade * inside) as f32;
                let outline = (-0.5 * ((beyond - OUTLINE) / OUTLINE).powi(2)).exp() as f32;
                let pixel = [y, x];
                // The dark side of strong shading falls below the ground and is drawn too. A pixel
                // that only the outline touches keeps its value.
                let drawn = &mut self.discs[pixel];
                if disc != 0. {
                    *drawn = if *drawn == 0. { disc } else { disc.max(*drawn) };
                }
                self.outlines[pixel] = outline.max(self.outlines[pixel]);
                self.inside[pixel] = (inside as f32).max(self.inside[pixel]);
            }
        }
    }
}
