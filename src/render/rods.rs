//! Rods at random positions in the room that cones leave.

use super::RenderOptions;
use super::field::normal;
use super::spacing::CellSizes;
use crate::geometry::Point;
use crate::geometry::index::BucketGrid;
use rand::{Rng, RngExt};
use std::f64::consts::TAU;

/// Area of a cone's cell in a triangular lattice, in squared spacings: √3/2.
const CELL: f64 = 0.866_025_403_784_438_6;
/// Smallest distance between two rods, as a fraction of the spacing of a triangular lattice of the
/// same density.
///
/// Discs placed at random without overlap come to about this distance before there is no more room:
/// .777 if no room at all is left.
const CLOSEST: f64 = 0.75;
/// Number of discs of diameter 1 per unit of area that are placed at random without overlap.
///
/// Random sequential adsorption of discs ends at .70 discs, which cover .547 of the plane (Feder
/// 1980, <https://doi.org/10.1016/0022-5193(80)90358-6>). The limited number of tries, see
/// [`TRIES`], achieves only a part of it.
const PARKED: f64 = 0.6;
/// Smallest room that cones are assumed to leave to rods, in squared spacings per cone, even if
/// wide cones leave less.
const LEAST_ROOM: f64 = 0.1;
/// Number of random positions tried per rod; most of them have no room.
const TRIES: f64 = 6.;
/// Coefficient of variation of the rods' peaks, which are log-normal.
const SCATTER: f64 = 0.5;

/// Rod that lies between cones, in px.
pub(super) struct Rod {
    /// Position of the rod's centre.
    pub(super) centre: Point,
    /// Typical distance between this rod and the rods around it, in px.
    pub(super) pitch: f64,
    /// Peak brightness over the surround, relative to that of the average cone.
    pub(super) height: f64,
}

/// Places rods at random in the room that the cones leave, without overlap.
///
/// The smallest distance between rods follows from `options.rods` and from the room that the cones
/// leave.
pub(super) fn between(
    points: &[Point],
    cells: &CellSizes,
    options: &RenderOptions,
    rng: &mut dyn Rng,
) -> Vec<Rod> {
    if options.rods == 0. || points.is_empty() {
        return Vec::new();
    }
    let closest_per_spacing = closest(options);
    let widest = cells.spacing.iter().copied().fold(0., f64::max);
    let mut taken = Discs::new(options, widest * (0.5 * options.diameter + closest_per_spacing));
    for (&p, &spacing) in points.iter().zip(&cells.spacing) {
        taken.insert(p, 0.5 * options.diameter * spacing);
    }
    // standard deviation of the logarithm; a mean of −log_sd²/2 makes the mean of the peaks
    // `rod_contrast`
    let log_sd = (1. + SCATTER * SCATTER).ln().sqrt();
    let tries = (TRIES * options.rods).ceil() as usize;
    let mut rods = Vec::new();
    for (&p, &spacing) in points.iter().zip(&cells.spacing) {
        let closest = closest_per_spacing * spacing;
        let pitch = closest / CLOSEST;
        for _ in 0..tries {
            // uniform by area, from 0.2 to 1 spacings away from the cone
            let distance = spacing * rng.random_range(0.04f64..1.).sqrt();
            let (sin, cos) = rng.random_range(0. ..TAU).sin_cos();
            let centre = Point::new(p.x + distance * cos, p.y + distance * sin);
            if taken.insert_if_free(centre, 0.5 * closest) {
                let height = options.rod_contrast * (log_sd * normal(rng) - log_sd * log_sd / 2.).exp();
                rods.push(Rod { centre, pitch, height });
            }
        }
    }
    rods
}

/// Returns the smallest distance between two rods, in spacings, at which `options.rods` rods per
/// cone find room.
///
/// With n rods per cone of diameter d and area CELL, the distance x solves n x² = PARKED · (CELL −
/// π (d + x)²/4), as the centre of a rod keeps x/2 away from the edge of a cone.
fn closest(options: &RenderOptions) -> f64 {
    let d = options.diameter;
    let parked = PARKED * TAU / 8.;
    let room = PARKED * (CELL - TAU / 8. * d * d).max(LEAST_ROOM);
    let (a, b) = (options.rods + parked, 2. * parked * d);
    ((b * b + 4. * a * room).sqrt() - b) / (2. * a)
}

/// Discs that must not overlap, sorted into a grid of squares.
///
/// The side of a square is at least the largest distance at which a rod can touch another disc, so
/// only adjacent squares are searched.
struct Discs {
    /// Side of a square, in px.
    side: f64,
    /// Numbers of columns and rows of squares that cover the image, without the ring of further
    /// squares around it.
    counts: [usize; 2],
    /// Centre and radius of each disc, in px.
    discs: BucketGrid<(Point, f64)>,
}

impl Discs {
    fn new(options: &RenderOptions, reach: f64) -> Self {
        // A square is at least one pixel wide, so there are never more squares than pixels.
        let side = reach.max(1.);
        let counts = [options.width, options.height].map(|length| (length as f64 / side) as usize + 1);
        // one more square on each side of the image
        let discs = BucketGrid::new([-side; 2], side, counts.map(|count| count + 2));
        Self { side, counts, discs }
    }

    fn insert(&mut self, p: Point, radius: f64) {
        self.discs.insert(p, (p, radius));
    }

    /// Adds a disc if it overlaps no other, and returns whether it was added.
    ///
    /// A disc whose centre lies beyond the ring of squares around the image is never added.
    fn insert_if_free(&mut self, p: Point, radius: f64) -> bool {
        let inside = |v: f64, count: usize| v > -self.side && v < (count as f64) * self.side;
        let free = inside(p.x, self.counts[0])
            && inside(p.y, self.counts[1])
            && self.discs.near(p).all(|&(q, r)| p.distance(q) >= radius + r);
        if free {
            self.insert(p, radius);
        }
        free
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Modality;
    use crate::render::{MosaicOptions, cone_mosaic};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn as_many_rods_as_asked_for_keep_clear_of_cones_and_each_other() {
        let mosaic = MosaicOptions { width: 400, height: 400, spacing: 24., ..MosaicOptions::default() };
        let cones = cone_mosaic(&mosaic, &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
        for (rods, diameter) in [(3., 0.4), (6., 0.6), (9., 0.38), (15., 0.5)] {
            let side = RenderOptions { width: 400, height: 400, ..RenderOptions::new(Modality::Confocal) };
            let options = RenderOptions { rods, diameter, ..side };
            let cells = CellSizes::of(&cones, &options).unwrap();
            let found = between(&cones, &cells, &options, &mut ChaCha8Rng::seed_from_u64(2));
            let inside = |p: &Point| (24. ..376.).contains(&p.x) && (24. ..376.).contains(&p.y);
            let per_cone = found.iter().filter(|r| inside(&r.centre)).count() as f64
                / cones.iter().filter(|p| inside(p)).count() as f64;
            assert!((per_cone / rods - 1.).abs() < 0.2, "{per_cone} of {rods} at {diameter}");
            for (i, rod) in found.iter().enumerate() {
                let free = |q: &Point, room: f64| q.distance(rod.centre) >= room;
                assert!(cones.iter().all(|c| free(c, 0.4 * diameter * 24.)));
                assert!(found[..i].iter().all(|r| free(&r.centre, 0.5 * rod.pitch)));
            }
        }
    }
}
