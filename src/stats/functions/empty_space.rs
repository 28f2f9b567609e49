//! Distances from a grid of test locations to the nearest point, from which the distribution F is
//! estimated.

use crate::geometry::{Point, Window, distances_to_nearest};

/// Number of test locations along each side of the window's bounds, as in spatstat, so that its
/// values of F can be compared digit by digit.
const PLACES: usize = 128;

/// Distances from test locations to the nearest point and to the border.
///
/// The test locations are the centres of 128 × 128 pixels that cover the bounding box. Only those
/// that lie in the window are used.
pub(super) struct EmptySpace {
    /// Distance from each test location to the nearest point; infinite if there are no points.
    pub distances: Vec<f64>,
    /// Distance from each test location to the border; infinite on a torus.
    pub borders: Vec<f64>,
    /// Values of `borders` in rising order. The area of an eroded polygon is counted from them.
    sorted_borders: Vec<f64>,
}

/// Measures the distances from all test locations that lie in the window.
pub(super) fn empty_space(points: &[Point], window: &Window) -> EmptySpace {
    let bounds = window.bounds();
    let (w, h) = (bounds.width() / PLACES as f64, bounds.height() / PLACES as f64);
    let places: Vec<Point> = (0..PLACES * PLACES)
        .map(|i| {
            let (column, row) = ((i % PLACES) as f64, (i / PLACES) as f64);
            Point::new(bounds.x0() + (column + 0.5) * w, bounds.y0() + (row + 0.5) * h)
        })
        .filter(|&p| window.contains(p))
        .collect();
    let distances = distances_to_nearest(&places, points, window);
    let borders = window.border_distances(&places);
    let mut sorted_borders = borders.clone();
    sorted_borders.sort_by(f64::total_cmp);
    EmptySpace { distances, borders, sorted_borders }
}

impl EmptySpace {
    /// Returns the area of the part of the window that is at least `r` from the border.
    ///
    /// The area is exact for a rectangle. For a polygon, it is the share of test locations in that
    /// part times the area of the window.
    pub(super) fn eroded(&self, window: &Window, r: f64) -> f64 {
        let bounds = window.bounds();
        match window {
            Window::Torus(_) => window.area(),
            Window::Rectangle(_) => (bounds.width() - 2. * r).max(0.) * (bounds.height() - 2. * r).max(0.),
            Window::Polygon(_) => {
                let all = self.sorted_borders.len();
                let left = all - self.sorted_borders.partition_point(|&b| b < r);
                window.area() * left as f64 / all.max(1) as f64
            }
        }
    }
}
