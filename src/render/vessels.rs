use super::RenderOptions;
use super::confocal::span;
use super::field::normal;
use crate::geometry::Point;
use crate::image::Plane;
use rand::{Rng, RngExt};
use std::f64::consts::{PI, TAU};

/// Steps along a vessel, in its widths.
const STEP: f64 = 0.25;
/// How much its direction changes over one width, radians.
const WINDING: f64 = 0.12;
/// Mean length between two branches, in widths.
const BRANCHING: f64 = 14.;
/// Narrowest branch, in spacings.
const NARROWEST: f64 = 0.4;
/// Widths of the branches over that of their stem: Murray's (1926) cubes, 0.8³ + 0.79³ = 1.
const BRANCHES: [f64; 2] = [0.8, 0.79];
/// Most pieces of a tree, so that it ends.
const MOST_PIECES: usize = 64;

/// Where a vessel begins, which way it runs, and how wide it is, px.
struct Piece {
    start: Point,
    heading: f64,
    width: f64,
}

/// How deep inside a vessel every pixel lies: 1 on its axis, 0 outside. Vessels come in from the border, wind and
/// branch until they leave.
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
                    let turn = side * (0.4 + 0.15 * normal(rng));
                    pieces.push(Piece { start: end, heading: heading + turn, width });
                }
            }
        }
    }
    plane
}

/// A place on the border, heading inwards.
fn entrance(width: usize, height: usize, vessel: f64, rng: &mut dyn Rng) -> Piece {
    let (w, h) = (width as f64, height as f64);
    let along = rng.random_range(0. ..2. * (w + h));
    let (start, inwards) = match along {
        a if a < w => (Point::new(a, 0.), PI / 2.),
        a if a < w + h => (Point::new(w, a - w), PI),
        a if a < 2. * w + h => (Point::new(a - w - h, h), -PI / 2.),
        a => (Point::new(0., a - 2. * w - h), 0.),
    };
    Piece { start, heading: inwards + rng.random_range(-0.6..0.6), width: vessel }
}

/// Draws a vessel up to its branching; where that is and which way it runs there, or nothing if it has left the image.
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
                    // light crosses a round vessel along a chord
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
