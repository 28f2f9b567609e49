//! Blood vessels that enter a simulated image from its border, wind and branch.

use super::RenderOptions;
use super::confocal::span;
use super::field::normal;
use crate::geometry::Point;
use crate::image::Plane;
use rand::{Rng, RngExt};
use std::f64::consts::{PI, TAU};

/// Length of a step in which a vessel is drawn, in widths of the vessel.
const STEP: f64 = 0.25;
/// Standard deviation of the change of direction over a length of one vessel width, in radians.
const WINDING: f64 = 0.12;
/// Mean length between two branchings, in widths of the vessel.
const BRANCHING: f64 = 14.;
/// Smallest width of a branch that is drawn, in median spacings of the cones.
const NARROWEST: f64 = 0.4;
/// Widths of the two branches, relative to their stem: the cubes add up to about 1 (0.8³ + 0.79³).
///
/// Source: Murray (1926), <https://doi.org/10.1073/pnas.12.3.207>.
const BRANCHES: [f64; 2] = [0.8, 0.79];
/// Largest number of pieces between branchings that are drawn for one tree of vessels, so that the
/// drawing ends.
const MOST_PIECES: usize = 64;

/// Start of the piece of a vessel between two branchings.
struct Piece {
    /// Position of the start, in px.
    start: Point,
    /// Direction in radians, clockwise from x as y points down.
    heading: f64,
    /// Width of the vessel, in px.
    width: f64,
}

/// Returns, for each pixel, the depth of the vessels: 1 on the axis of a vessel, 0 outside.
///
/// Vessels come in from the border, wind, and branch until they leave the image or become too
/// narrow. `spacing` is the median spacing of the cones, in px.
pub(super) fn depth(options: &RenderOptions, spacing: f64, rng: &mut dyn Rng) -> Plane {
    let (width, height) = (options.width, options.height);
    let mut plane = Plane::zeros((height, width));
    for _ in 0..options.vessels {
        let mut pieces = vec![entrance(width, height, options.vessel_width * spacing, rng)];
        let mut drawn = 0;
        while let (Some(piece), true) = (pieces.pop(), drawn < MOST_PIECES) {
            drawn += 1;
            let Some((end, heading)) = draw(&mut plane, &piece, rng) else { continue };
            for (side, part) in [-1., 1.].into_iter().zip(BRANCHES) {
                let width = part * piece.width;
                if width >= NARROWEST * spacing {
                    // a branch turns away from its stem by 0.4 radians, 23°, on average
                    let turn = side * (0.4 + 0.15 * normal(rng));
                    pieces.push(Piece { start: end, heading: heading + turn, width });
                }
            }
        }
    }
    plane
}

/// Returns the start of a vessel on the border, heading inwards; `vessel` is its width in px.
fn entrance(width: usize, height: usize, vessel: f64, rng: &mut dyn Rng) -> Piece {
    let (w, h) = (width as f64, height as f64);
    // distance along the border from the upper left corner, clockwise
    let along = rng.random_range(0. ..2. * (w + h));
    let (start, inwards) = match along {
        a if a < w => (Point::new(a, 0.), PI / 2.),
        a if a < w + h => (Point::new(w, a - w), PI),
        a if a < 2. * w + h => (Point::new(a - w - h, h), -PI / 2.),
        a => (Point::new(0., a - 2. * w - h), 0.),
    };
    Piece { start, heading: inwards + rng.random_range(-0.6..0.6), width: vessel }
}

/// Draws a piece of vessel, and returns its end and its direction there, or `None` if it left the
/// image.
fn draw(plane: &mut Plane, piece: &Piece, rng: &mut dyn Rng) -> Option<(Point, f64)> {
    let (height, width) = plane.dim();
    let radius = 0.5 * piece.width;
    let length = BRANCHING * piece.width * rng.random_range(0.5..1.5);
    let step = (STEP * piece.width).max(0.5);
    let (mut p, mut heading, mut gone) = (piece.start, piece.heading, 0.);
    while gone < length {
        if p.x < -piece.width
            || p.y < -piece.width
            || p.x > width as f64 + piece.width
            || p.y > height as f64 + piece.width
        {
            return None;
        }
        if let (Some(columns), Some(rows)) = (span(p.x, radius, width), span(p.y, radius, height)) {
            for y in rows {
                for x in columns.clone() {
                    let (dx, dy) = ((x as f64 - p.x) / radius, (y as f64 - p.y) / radius);
                    // Light crosses a round vessel along a chord, so the depth falls off as the
                    // length of the chord does.
                    let chord = (1. - dx * dx - dy * dy).max(0.).sqrt() as f32;
                    let pixel = &mut plane[[y, x]];
                    *pixel = pixel.max(chord);
                }
            }
        }
        heading = (heading + WINDING * (step / piece.width).sqrt() * normal(rng)).rem_euclid(TAU);
        p = Point::new(p.x + step * heading.cos(), p.y + step * heading.sin());
        gone += step;
    }
    Some((p, heading))
}
