//! Histological images: inner segments cut across, as discs with a dark outline on a grained
//! ground.
//!
//! Brightness is in units of the contrast: 0 is the ground, and 1 is the peak of an average disc.

use super::RenderOptions;
use super::confocal::span;
use super::field::{normal, texture};
use super::rods::Rod;
use super::spacing::CellSizes;
use crate::geometry::Point;
use crate::image::Plane;
use rand::Rng;

/// Width of the soft edge of a disc, in local spacings: the distance over which the brightness of
/// the disc falls to 0.
const EDGE: f64 = 0.1;
/// Distance from the edge of a disc outwards to the middle of its dark outline, in local spacings.
///
/// The same constant is the standard deviation of the outline's Gaussian profile. The outline thus
/// has e^(−1/2), 61 %, of its depth at the edge of the disc.
const OUTLINE: f64 = 0.07;
/// Diameter of a rod's disc divided by the typical distance between rods.
const ROD: f64 = 0.7;
/// Standard deviation of the level at which a cell is cut, as a fraction of the mean level
/// ([`RenderOptions::section`]).
///
/// Levels are measured above the widest plane of the inner segments.
const UNEVEN_SECTION: f64 = 0.25;

/// Returns, for each of `count` cells, the radius of its cross-section relative to its largest
/// radius, or 0 if the section misses the cell.
///
/// Inner segments are taken as ellipsoids. Each is cut at about the level `options.section`, which
/// is measured from its widest plane in units of its half axis.
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

/// Draws inner segments cut across: discs with a dark outline on a grained ground.
///
/// `heights` are the peaks of the discs, and `sizes` the relative radii that [`section()`] returns.
/// Discs are neither quite round nor evenly bright. Their mean radius is at most half the distance
/// to the nearest neighbour (but at least 0.2 px), so they hardly overlap. Where they do, the
/// brighter one is seen.
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
        // At the default scatter of 0.05, sizes stay from 0.8 to 1.2 times the mean. Even at the
        // largest scatter no size falls below 0.3, as a radius must be positive.
        let scatter = (1. + cv * normal(rng)).clamp((1. - 4. * cv).max(0.3), 1. + 4. * cv);
        // The least radius, 0.2 px, keeps the discs of coincident points from a radius of 0, by
        // which the shading would divide.
        let radius = (0.5 * options.diameter * spacing * scatter).min(0.5 * cells.nearest[i]).max(0.2);
        // The radius at angle θ is multiplied by 1 + a cos 2θ + b sin 2θ + c cos 3θ + d sin 3θ. a
        // and b make the disc oval, c and d give it three lobes.
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
    // The outline fades as the disc becomes brighter, so that its inner flank does not darken the
    // disc.
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
        // Half of the variance is fine grain, and half is coarse.
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

/// Cross-section of a cell.
struct Disc {
    /// Centre of the disc, in px.
    centre: Point,
    /// Mean radius of the disc, in px.
    radius: f64,
    /// Local spacing in px, the unit of the widths of edge and outline.
    scale: f64,
    /// Brightness of the disc's centre above the ground.
    peak: f64,
    /// Amplitudes of cos 2θ and sin 2θ in the outline, relative to the radius.
    oval: [f64; 2],
    /// Amplitudes of cos 3θ and sin 3θ in the outline, relative to the radius.
    lobes: [f64; 2],
}

/// Planes of the size of the image, on which the cells of a histological section are drawn.
struct Section {
    /// Brightness of the discs above the ground; 0 where no disc is drawn.
    discs: Plane,
    /// Strength of the dark outlines, from 0 to 1.
    outlines: Plane,
    /// Degree to which each pixel lies inside a disc, from 0 to 1.
    inside: Plane,
    /// Change of a disc's brightness over one radius, to the right and downwards, relative to the
    /// disc's peak.
    shading: [f64; 2],
}

impl Section {
    /// Creates a section without cells, lit as `options` say.
    fn empty(options: &RenderOptions) -> Self {
        let plane = || Plane::zeros((options.height, options.width));
        let (sin, cos) = options.orientation.to_radians().sin_cos();
        // With the factor √2, light at the default 45° changes the brightness by `shading` over one
        // radius along each axis.
        let strength = 2f64.sqrt() * options.shading;
        let shading = [strength * cos, strength * sin];
        Self { discs: plane(), outlines: plane(), inside: plane(), shading }
    }

    /// Draws a disc and its outline on the planes.
    fn add_disc(&mut self, disc: &Disc) {
        let (height, width) = self.discs.dim();
        let Disc { centre: p, radius, scale, peak, oval, lobes } = *disc;
        // At any angle the harmonics add up to a standard deviation of 0.04 radii, so they
        // practically never exceed 0.25. Outlines are cut off two standard deviations beyond their
        // middle.
        let reach = 1.25 * radius + 3. * OUTLINE * scale;
        let (Some(columns), Some(rows)) = (span(p.x, reach, width), span(p.y, reach, height)) else { return };
        for y in rows {
            for x in columns.clone() {
                let (dx, dy) = (x as f64 - p.x, y as f64 - p.y);
                let distance = (dx * dx + dy * dy).sqrt();
                let (cos, sin) = if distance > 0. { (dx / distance, dy / distance) } else { (1., 0.) };
                // the harmonics of θ, written with cos θ and sin θ
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
                // makes the slope continuous at both ends of the soft edge
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
