//! Regions of interest: boxes grown around a centre until they contain enough cells, and boxes that
//! slide over a window.
//!
//! A box is grown in three steps:
//!
//! 1. Enlarge it by a factor of 1.2 until it contains enough bound cells.
//! 2. If it leaves the window first, find the largest box that still fits.
//! 3. Bisect the scale between the last box that was too small and the first that was large enough.

use super::{StatsError, voronoi};
use crate::geometry::{Point, Rectangle, Window};

/// Factor by which a box is enlarged in each step, until it contains enough cells. The exact size
/// is then found by bisection.
const STEP: f64 = 1.2;
/// Relative precision of the final size of a grown box, at which the bisection ends.
const PRECISION: f64 = 1e-4;
/// Largest number of sliding boxes. Requests for more are refused with the advice to choose a
/// larger step.
const MOST: f64 = 100_000.;
/// Largest share of the area of a box that may lie outside a polygon for the box to count as
/// inside. So small a share is only rounding error.
const ROUNDING: f64 = 1e-9;

/// Rectangular region of interest that was grown about its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grown {
    /// Box to which the region has grown.
    pub frame: Rectangle,
    /// `true` if the box contains at least the requested number of bound cells, which are Voronoi
    /// cells strictly inside the box.
    pub enough: bool,
}

/// Grows a box about its centre until it contains `needed` bound cells.
///
/// The cells are the Voronoi cells of the points in the box alone, as if the box were a mosaic of
/// its own; a cell is bound if it lies strictly inside the box. The sides of the box keep their
/// proportion, and its size is exact to 1/10 000.
///
/// A box that already contains enough cells stays as it is. A box that meets the border of the
/// window before it contains enough cells ends there, and [`Grown::enough`] is `false`. A bound
/// cell stays bound when a box grows, so the smallest sufficient box is well defined.
pub fn grown(points: &[Point], window: &Window, frame: Rectangle, needed: usize) -> Grown {
    let bound = |frame: &Rectangle| bound_cells(points, window, frame);
    let enough = |frame: &Rectangle| bound(frame) >= needed;
    if enough(&frame) {
        return Grown { frame, enough: true };
    }
    if !lies_in(&frame, window) {
        return Grown { frame, enough: false };
    }
    let (mut low, mut high) = (1., 1.);
    loop {
        high *= STEP;
        let largest = match scaled(&frame, high) {
            Some(wider) if lies_in(&wider, window) => None,
            _ => Some(last(low, high, |f| scaled(&frame, f).is_some_and(|b| lies_in(&b, window)))),
        };
        if let Some(largest) = largest {
            let Some(widest) = scaled(&frame, largest) else { return Grown { frame, enough: false } };
            if !enough(&widest) {
                return Grown { frame: widest, enough: false };
            }
            high = largest;
        } else if !scaled(&frame, high).is_some_and(|b| enough(&b)) {
            low = high;
            continue;
        }
        // The box at scale `low` contains too few cells, the box at `high` enough.
        while high - low > PRECISION * low {
            let middle = (low + high) / 2.;
            if scaled(&frame, middle).is_some_and(|b| enough(&b)) { high = middle } else { low = middle }
        }
        let frame = scaled(&frame, high).unwrap_or(frame);
        return Grown { frame, enough: true };
    }
}

/// Returns the largest factor for which `holds` is true, found by bisection.
///
/// `holds` must be true at `low` and false at `high`. The precision is a thousand times finer than
/// that of a grown box.
fn last(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    while high - low > PRECISION * 1e-3 * low {
        let middle = (low + high) / 2.;
        if holds(middle) { low = middle } else { high = middle }
    }
    low
}

/// Returns the box enlarged about its centre by `factor`; `None` if its corners are not finite.
fn scaled(frame: &Rectangle, factor: f64) -> Option<Rectangle> {
    let (x, y) = ((frame.x0() + frame.x1()) / 2., (frame.y0() + frame.y1()) / 2.);
    let (dx, dy) = (frame.width() / 2. * factor, frame.height() / 2. * factor);
    Rectangle::new(x - dx, y - dy, x + dx, y + dy).ok()
}

/// Returns whether the box lies entirely in the window.
pub fn lies_in(frame: &Rectangle, window: &Window) -> bool {
    match window {
        Window::Rectangle(b) | Window::Torus(b) => {
            frame.x0() >= b.x0() && frame.y0() >= b.y0() && frame.x1() <= b.x1() && frame.y1() <= b.y1()
        }
        Window::Polygon(polygon) => {
            polygon.within(frame).is_some_and(|part| part.area() >= frame.area() * (1. - ROUNDING))
        }
    }
}

/// Counts the bound cells in the box, as if the points in the box were a mosaic of their own.
fn bound_cells(points: &[Point], window: &Window, frame: &Rectangle) -> usize {
    let Some(window) = window.within(frame) else { return 0 };
    let inside: Vec<Point> = points.iter().copied().filter(|&p| window.contains(p)).collect();
    voronoi(&inside, &window).cells.iter().filter(|cell| cell.bound).count()
}

/// Returns square boxes of side `side` that slide over `bounds` in steps of `step`, from the upper
/// left corner.
///
/// As many boxes as fit are returned, row by row, each with the numbers of its row and its column,
/// of which the first is 1. Lengths are in units of the coordinates. The list is empty if `bounds`
/// is smaller than one box.
///
/// # Errors
/// Fails if a length is not positive or there would be more than 100 000 boxes.
pub fn sliding(bounds: &Rectangle, side: f64, step: f64) -> Result<Vec<([usize; 2], Rectangle)>, StatsError> {
    for (option, value) in [("side of the regions", side), ("step of the regions", step)] {
        if !(value.is_finite() && value > 0.) {
            return Err(StatsError::Option { option, value, range: "a positive length" });
        }
    }
    // The small allowance for rounding keeps the last box if it ends exactly at the border.
    let along = |length: f64| ((length - side) / step + 1e-9).floor() + 1.;
    let (columns, rows) = (along(bounds.width()).max(0.), along(bounds.height()).max(0.));
    if columns * rows > MOST {
        let range = "at most 100000, so choose a larger step";
        return Err(StatsError::Option { option: "number of regions", value: columns * rows, range });
    }
    let mut boxes = Vec::with_capacity((columns * rows) as usize);
    for row in 0..rows as usize {
        for column in 0..columns as usize {
            let (x, y) = (bounds.x0() + column as f64 * step, bounds.y0() + row as f64 * step);
            let (right, lower) = ((x + side).min(bounds.x1()), (y + side).min(bounds.y1()));
            if let Ok(frame) = Rectangle::new(x, y, right, lower) {
                boxes.push(([row + 1, column + 1], frame));
            }
        }
    }
    Ok(boxes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Polygon;
    use rand::{RngExt, SeedableRng};

    fn uniform(n: usize, seed: u64) -> Vec<Point> {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        (0..n).map(|_| Point::new(rng.random(), rng.random())).collect()
    }

    fn frame(x0: f64, y0: f64, x1: f64, y1: f64) -> Rectangle {
        Rectangle::new(x0, y0, x1, y1).unwrap()
    }

    #[test]
    fn a_box_grows_until_it_just_holds_its_cells() {
        let (points, window) = (uniform(2000, 5), Window::unit_square());
        for (x, y) in [(0.5, 0.5), (0.4, 0.6), (0.3, 0.35)] {
            let start = frame(x - 0.02, y - 0.01, x + 0.02, y + 0.01);
            let found = grown(&points, &window, start, 40);
            assert!(found.enough && bound_cells(&points, &window, &found.frame) >= 40);
            let smaller = scaled(&found.frame, 1. - 2. * PRECISION).unwrap();
            assert!(bound_cells(&points, &window, &smaller) < 40);
            assert!((found.frame.width() / found.frame.height() - 2.).abs() < 1e-9);
            assert!((found.frame.x0() + found.frame.x1() - 2. * x).abs() < 1e-12);
            // A box that contains enough cells stays as it is.
            assert_eq!(grown(&points, &window, found.frame, 20).frame, found.frame);
        }
    }

    #[test]
    fn a_box_ends_at_the_border_of_the_window() {
        let points = uniform(400, 6);
        let found = grown(&points, &Window::unit_square(), frame(0.05, 0.4, 0.15, 0.5), 100);
        assert!(!found.enough && found.frame.x0() >= 0. && found.frame.x0() < 1e-5, "{found:?}");
        // A box that sticks out of the window has no room to grow.
        let out = frame(-0.1, 0.4, 0.1, 0.6);
        assert_eq!(grown(&points, &Window::unit_square(), out, 100), Grown { frame: out, enough: false });
        let ring = |a: f64, b: f64| [(a, a), (b, a), (b, b), (a, b)].map(|(x, y)| Point::new(x, y)).to_vec();
        let holed = Window::Polygon(Polygon::new(vec![ring(0., 1.), ring(0.45, 0.55)]).unwrap());
        let found = grown(&points, &holed, frame(0.15, 0.45, 0.25, 0.55), 100);
        assert!(!found.enough && found.frame.x1() <= 0.45 && found.frame.x1() > 0.39, "{found:?}");
    }

    #[test]
    fn few_points_never_suffice() {
        let window = Window::unit_square();
        let start = frame(0.4, 0.4, 0.6, 0.6);
        let line: Vec<Point> = (0..9).map(|i| Point::new(f64::from(i) / 8., 0.5)).collect();
        for points in [&line[..0], &line[..1], &line[..2], &line[..3], &line, &[Point::new(0.5, 0.5); 7]] {
            let found = grown(points, &window, start, 1);
            assert!(!found.enough && found.frame.x0() < 1e-4, "{found:?}");
        }
    }

    #[test]
    fn sliding_boxes_tile_the_window() {
        let bounds = frame(-0.5, -0.5, 99.5, 49.5);
        let boxes = sliding(&bounds, 10., 10.).unwrap();
        assert_eq!((boxes.len(), boxes[10].0), (50, [2, 1]));
        assert_eq!(boxes[49].1, frame(89.5, 39.5, 99.5, 49.5));
        assert_eq!(sliding(&bounds, 20., 5.).unwrap().len(), 17 * 7);
        assert_eq!(sliding(&bounds, 60., 5.).unwrap().len(), 0);
        assert_eq!(sliding(&frame(0., 0., 0.3, 0.3), 0.1, 0.1).unwrap().len(), 9);
        assert!(sliding(&bounds, 1., 1e-3).is_err());
        assert!(sliding(&bounds, 0., 1.).is_err() && sliding(&bounds, 1., f64::NAN).is_err());
    }
}
