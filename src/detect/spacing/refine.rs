//! Refines the spacing by the density of the detections: s = √(2A/(√3 n)) for n cones on the area
//! A.
//!
//! 1. The density over the entire image gives one spacing. It is kept within a factor of e^±0.35
//!    (.70 to 1.42) of the ring's spacing.
//! 2. If there are enough cones, a square of about 80 cones around every node of a grid gives a
//!    local spacing. It is kept within the same factor of the ring's.
//! 3. The local spacings are smoothed. If they differ too little, the single spacing stays.

use super::{SPACING_RANGE, SpacingMap};
use crate::geometry::Point;
use crate::geometry::index::BucketGrid;
use crate::image::EmptyPixels;
use crate::mosaic::hexagonal_spacing;

/// Width, in px, of the strip along the border of an image in which cones are not counted.
///
/// Filters see only half of a cone on the border.
pub const BORDER: f64 = 7.;

/// Largest change of the logarithm of the spacing that detections may cause, relative to the ring's
/// spacing: a factor of e^±0.35.
///
/// Detections that suggest a larger change are not to be trusted.
const TRUST: f64 = 0.35;

/// Largest factor by which detections may change a spacing that the user set.
const KEPT: f64 = 1.1;

/// Approximate number of cones in a square in which a local density is counted.
///
/// The count of a smaller square would scatter more, a larger square would blur the map.
const COUNTED: f64 = 80.;
/// Smallest number of cones in an image for which local spacings are computed.
///
/// With fewer, local counts would be noise, so one spacing serves the entire image. This number
/// fills four of the squares.
const ENOUGH_CONES: usize = 320;
/// Distance between neighbouring nodes of a map, in spacings: about half the side of a square of 80
/// cones, so that neighbouring squares overlap by half.
const NODE_STEP: f64 = 4.;
/// Smallest fraction of a square that must have been imaged for its count to be used: room for
/// about 32 cones.
const IMAGED: f64 = 0.4;
/// Smallest ratio of the largest to the smallest spacing of a map; a map with a smaller ratio is
/// replaced by a single spacing.
///
/// Local counts scatter by about as much, and filters tolerate a spacing that differs from their
/// own by such a factor.
pub(in crate::detect) const EVEN: f64 = 1.2;

/// Spacing from which a search starts.
#[derive(Clone, Debug)]
pub(in crate::detect) struct Start {
    /// Spacing as a function of position.
    pub map: SpacingMap,
    /// Smallest spacing, in px, that the density of the detections may give to the entire image; 0
    /// for no limit.
    ///
    /// It is the lower limit that the ring shows
    /// ([`RingEstimate::least`](super::RingEstimate::least)). If the cones counted show a
    /// smaller spacing, noise was probably counted as well.
    pub least: f64,
    /// Largest change of the logarithm of the typical spacing that detections may cause.
    pub trust: f64,
}

impl Start {
    /// Returns the start from a spacing that detections may change as usual, without a lower limit.
    pub(in crate::detect) const fn at(map: SpacingMap) -> Self {
        Self { map, least: 0., trust: TRUST }
    }

    /// Returns the start from which detections may move the typical spacing by at most 10 %.
    pub(in crate::detect) fn kept(self) -> Self {
        Self { trust: KEPT.ln(), ..self }
    }

    /// Returns another start if the density of `centres`, the cones found from this start,
    /// contradicts it.
    ///
    /// The density contradicts the start if its spacing differs from the typical spacing of the
    /// start by more than a factor of e^±0.35, the largest change that detections may cause. The
    /// other start has the spacing by density everywhere and no lower limit.
    pub(in crate::detect) fn contradicted_by(
        &self,
        centres: &[Point],
        (height, width): (usize, usize),
        empty: Option<&EmptyPixels>,
    ) -> Option<Self> {
        let (low, high) = SPACING_RANGE;
        let shown = density_spacing(centres, width, height, empty)?.clamp(low, high);
        let far = (shown / self.map.typical()).ln().abs() > TRUST;
        far.then(|| Self::at(SpacingMap::constant(shown)))
    }
}

/// Returns the spacing by the density of `centres` in an image of `width` × `height` px.
///
/// Cones and area are counted without a strip along the border. The strip is 7 px wide, or a
/// quarter of the shorter side if that is less. Pixels that were not imaged (`empty`) are deducted
/// from the area in proportion. If there is no cone, one is assumed.
fn density_spacing(
    centres: &[Point],
    width: usize,
    height: usize,
    empty: Option<&EmptyPixels>,
) -> Option<f64> {
    let border = BORDER.min(width.min(height) as f64 / 4.);
    let (right, lower) = (width as f64 - 0.5 - border, height as f64 - 0.5 - border);
    let near = border - 0.5;
    let inside = centres.iter().filter(|p| p.x > near && p.x < right && p.y > near && p.y < lower).count();
    let area = (width as f64 - 2. * border) * (height as f64 - 2. * border);
    let imaged = empty.map_or(1., |e| 1. - e.part(0, 0, width, height));
    hexagonal_spacing(inside.max(1), area * imaged)
}

/// Returns the spacing by density, or the ring's spacing if there is no density; its logarithm is
/// limited to within `trust` of that of the ring's.
fn trusted(by_density: Option<f64>, ring_spacing: f64, trust: f64) -> f64 {
    let by_density = by_density.unwrap_or(ring_spacing);
    ring_spacing * (by_density / ring_spacing).ln().clamp(-trust, trust).exp()
}

/// Returns the map of the spacing by the local density of `centres`.
///
/// Around each node, the density is counted in a square of about 80 cones that stays inside the
/// border, and the spacing is kept within a factor of e^±0.35 of the spacing in `start`. The map is
/// constant if the spacings differ by less than 20 % or there are fewer than 320 cones.
///
/// If the spacing of the entire image is below `start.least`, more than the cones was counted. All
/// spacings by density are then multiplied by the factor that raises that spacing to `start.least`.
pub(in crate::detect) fn refined_map(
    centres: &[Point],
    width: usize,
    height: usize,
    empty: Option<&EmptyPixels>,
    start: &Start,
) -> SpacingMap {
    let ring = &start.map;
    let shown = density_spacing(centres, width, height, empty);
    let raise = shown.map_or(1., |s| (start.least / s).max(1.));
    let typical = trusted(shown.map(|s| raise * s), ring.typical(), start.trust);
    let constant = || SpacingMap::constant(typical);
    if centres.len() < ENOUGH_CONES {
        return constant();
    }
    let cells = Cells::new(centres, width, height, typical);
    let nodes = |length: usize| -> Vec<f64> {
        let count = ((length as f64 / (NODE_STEP * typical)).round() as usize).max(2);
        (0..count).map(|k| (k as f64 + 0.5) * length as f64 / count as f64 - 0.5).collect()
    };
    let (x, y) = (nodes(width), nodes(height));
    let mut spacing = Vec::with_capacity(x.len() * y.len());
    for &cy in &y {
        for &cx in &x {
            let place = Point::new(cx, cy);
            let before = ring.at(place);
            // a square of this half-side contains 80 cones of a triangular lattice
            let half = 0.5 * before * (COUNTED * 0.75f64.sqrt()).sqrt();
            let square = cells.square(place, half);
            let imaged = empty.map_or(1., |e| square.imaged(e));
            let known = imaged >= IMAGED;
            let by_density = hexagonal_spacing(cells.count(&square).max(1), square.area() * imaged);
            spacing.push(known.then(|| trusted(by_density.map(|s| raise * s), before, TRUST)));
        }
    }
    let map = SpacingMap::on_grid(x, y, &spacing, typical).smoothed();
    let (low, high) = map.range();
    if high / low < EVEN { constant() } else { map.within(ring.typical(), start.trust) }
}

/// A square of an image, in px, moved and if necessary shrunk to lie inside the border.
struct Square {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
}

impl Square {
    /// Returns the area in px².
    fn area(&self) -> f64 {
        (self.right - self.left) * (self.bottom - self.top)
    }

    /// Returns the fraction of the square that was imaged.
    fn imaged(&self, empty: &EmptyPixels) -> f64 {
        let pixel = |v: f64| (v + 0.5).max(0.) as usize;
        1. - empty.part(pixel(self.left), pixel(self.top), pixel(self.right), pixel(self.bottom))
    }
}

/// Points of an image in a grid of buckets, so that counting the points in a square does not visit
/// all of them.
struct Cells {
    /// Points in px, in buckets.
    points: BucketGrid<Point>,
    /// Width of the image in px.
    width: f64,
    /// Height of the image in px.
    height: f64,
}

impl Cells {
    /// Sorts the points `centres` of an image of `width` × `height` px into buckets of `side` px.
    fn new(centres: &[Point], width: usize, height: usize, side: f64) -> Self {
        let (width, height) = (width as f64, height as f64);
        let cells = |length: f64| (length / side) as usize + 1;
        // the image begins at the outer corner of its first pixel
        let mut points = BucketGrid::new([-0.5; 2], side, [cells(width), cells(height)]);
        centres.iter().for_each(|&p| points.insert(p, p));
        Self { points, width, height }
    }

    /// Returns the square with the middle `middle` and the half-side `half` (px), moved and if
    /// necessary shrunk to stay inside the border.
    fn square(&self, middle: Point, half: f64) -> Square {
        let ends = |middle: f64, length: f64| {
            let border = BORDER.min(length / 4.) - 0.5;
            let half = half.min(0.5 * (length - 1.) - border);
            let middle = middle.clamp(border + half, length - 1. - border - half);
            (middle - half, middle + half)
        };
        let ((left, right), (top, bottom)) = (ends(middle.x, self.width), ends(middle.y, self.height));
        Square { left, top, right, bottom }
    }

    /// Returns the number of points in a square.
    fn count(&self, s: &Square) -> usize {
        self.points
            .touching(Point::new(s.left, s.top), Point::new(s.right, s.bottom))
            .filter(|p| p.x >= s.left && p.x < s.right && p.y >= s.top && p.y < s.bottom)
            .count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refined(centres: &[Point], width: usize, height: usize, ring_spacing: f64) -> f64 {
        trusted(density_spacing(centres, width, height, None), ring_spacing, TRUST)
    }

    fn lattice(step: f64, side: usize) -> Vec<Point> {
        let cells = (side as f64 / step) as usize;
        (0..cells * cells)
            .map(|k| Point::new(((k % cells) as f64 + 0.5) * step, ((k / cells) as f64 + 0.5) * step))
            .collect()
    }

    #[test]
    fn density_corrects_a_ring_that_is_a_little_off() {
        let square_lattice = lattice(10., 300);
        let expected = 10. * (2. / 3f64.sqrt()).sqrt();
        assert!((refined(&square_lattice, 300, 300, 12.) / expected - 1.).abs() < 0.03);
    }

    #[test]
    fn detections_cannot_carry_the_spacing_far_from_the_ring() {
        assert!((refined(&[], 100, 100, 10.) - 10. * 0.35f64.exp()).abs() < 1e-9);
        assert!((refined(&lattice(2., 100), 100, 100, 10.) - 10. * (-0.35f64).exp()).abs() < 1e-9);
    }

    fn start(spacing: f64, least: f64) -> Start {
        Start { least, ..Start::at(SpacingMap::constant(spacing)) }
    }

    #[test]
    fn too_many_detections_do_not_make_the_spacing_smaller_than_the_ring_allows() {
        let centres = lattice(8., 400);
        let shown = refined_map(&centres, 400, 400, None, &start(10., 0.)).typical();
        assert!((shown / (8. * (2. / 3f64.sqrt()).sqrt()) - 1.).abs() < 0.02);
        assert!((refined_map(&centres, 400, 400, None, &start(10., 9.5)).typical() - 9.5).abs() < 1e-9);
    }

    #[test]
    fn an_even_mosaic_has_one_spacing() {
        let map = refined_map(&lattice(10., 400), 400, 400, None, &start(11., 0.));
        assert!(map.is_constant());
    }

    #[test]
    fn a_gradient_of_density_is_followed_to_its_ends() {
        // the columns of cones lie farther and farther apart: density falls 4:1 from left to right
        let (mut points, mut x) = (Vec::new(), 0.);
        while x < 600. {
            let step = 6. + 6. * x / 600.;
            points.extend((0..(600. / step) as usize).map(|k| Point::new(x, (k as f64 + 0.5) * step)));
            x += step;
        }
        let map = refined_map(&points, 600, 600, None, &start(9., 0.));
        for x in [30., 150., 300., 450., 570.] {
            let expected = (6. + 6. * x / 600.) * (2. / 3f64.sqrt()).sqrt();
            let found = map.at(Point::new(x, 300.));
            assert!((found / expected - 1.).abs() < 0.12, "{x}: {found} for {expected}");
        }
    }
}
