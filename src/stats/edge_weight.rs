//! Edge corrections for pairs of points: weights that compensate for pairs hidden beyond the border
//! of the window.
//!
//! - Set covariance: one factor per distance r, the share of the window that overlaps with a copy
//!   shifted by r, averaged over directions.
//! - Translation: one weight per pair, from the vector between its points (Ohser & Stoyan 1981,
//!   <https://doi.org/10.1002/bimj.4710230602>).
//! - Isotropic: one weight per pair, from the circles around both points (Ripley 1976,
//!   <https://doi.org/10.2307/3212829>).

use crate::geometry::{Point, Rectangle, Window};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Largest weight of a pair, as in spatstat: a pair that is rarely observable must not dominate the
/// curve.
pub(super) const MAX_WEIGHT: f64 = 100.;

/// Edge corrections for the pairs of one window, with weights of at most [`MAX_WEIGHT`].
pub(super) struct EdgeWeights<'a> {
    window: &'a Window,
    bounds: Rectangle,
}

impl<'a> EdgeWeights<'a> {
    /// Prepares the corrections for `window`.
    pub(super) fn new(window: &'a Window) -> Self {
        Self { window, bounds: window.bounds() }
    }

    /// Returns the largest distance for which [`Self::covariance`] is valid: the shorter side of a
    /// rectangle or torus, infinity for a polygon.
    pub(super) fn covariance_reach(&self) -> f64 {
        match self.window {
            Window::Polygon(_) => f64::INFINITY,
            Window::Rectangle(_) | Window::Torus(_) => self.bounds.width().min(self.bounds.height()),
        }
    }

    /// Returns the set covariance at distance `r`: the share of the window that overlaps with a
    /// copy shifted by `r`, averaged over all directions of the shift.
    ///
    /// For a w × h rectangle this is 1 − 2r(w+h)/(πwh) + r²/(πwh).
    pub(super) fn covariance(&self, r: f64) -> f64 {
        match self.window {
            Window::Polygon(polygon) => polygon.covariance().isotropised(r).max(1. / MAX_WEIGHT),
            Window::Rectangle(_) | Window::Torus(_) => {
                let (w, h) = (self.bounds.width(), self.bounds.height());
                1. - (2. * (w + h) - r) * r / (PI * w * h)
            }
        }
    }

    /// Returns the translation weight: the area of the window divided by the area of its overlap
    /// with a copy of itself that is shifted by (dx, dy).
    #[inline]
    pub(super) fn translation(&self, dx: f64, dy: f64) -> f64 {
        let seen = match self.window {
            Window::Polygon(polygon) => polygon.covariance().share(dx, dy),
            Window::Rectangle(_) | Window::Torus(_) => {
                let (w, h) = (self.bounds.width(), self.bounds.height());
                (1. - dx.abs() / w).max(0.) * (1. - dy.abs() / h).max(0.)
            }
        };
        1. / seen.max(1. / MAX_WEIGHT)
    }

    /// Returns the isotropic weight of the pair of points `a` and `b` at distance `d`: the inverse
    /// of the share of a circle of radius `d` that lies in the window, averaged over the circles
    /// around both points.
    pub(super) fn isotropic(&self, a: Point, b: Point, d: f64) -> f64 {
        let weight = |p: Point| 1. / self.share_of_circle(p, d).max(1. / MAX_WEIGHT);
        0.5 * (weight(a) + weight(b))
    }

    /// Returns the share of the circle of radius `d` around `p` that lies in the window; `p` must
    /// be inside.
    pub(super) fn share_of_circle(&self, p: Point, d: f64) -> f64 {
        match self.window {
            Window::Polygon(polygon) if polygon.border_distance(p) >= d => 1.,
            Window::Polygon(polygon) => polygon.share_of_circle(p, d),
            Window::Rectangle(b) | Window::Torus(b) => {
                share_of_circle(d, [p.x - b.x0(), p.y - b.y0(), b.x1() - p.x, b.y1() - p.y])
            }
        }
    }
}

/// Returns the share of the circle of radius `d` around a point that lies in a rectangle.
///
/// `sides` are the point's distances to the four sides, in order around the rectangle. A side
/// nearer than `d` hides an arc of the circle. The arcs of adjacent sides may overlap; the overlap
/// is then counted once.
fn share_of_circle(d: f64, sides: [f64; 4]) -> f64 {
    let half = sides.map(|side| if side < d { (side.max(0.) / d).acos() } else { 0. });
    let hidden: f64 = half.iter().map(|a| 2. * a).sum();
    let overlaps: f64 = (0..4).map(|i| (half[i] + half[(i + 1) % 4] - FRAC_PI_2).max(0.)).sum();
    1. - (hidden - overlaps) / TAU
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Polygon;

    #[test]
    fn share_of_a_circle_at_edges_and_corners() {
        assert_eq!(share_of_circle(1., [5.; 4]), 1.);
        assert!((share_of_circle(1., [0., 5., 5., 5.]) - 0.5).abs() < 1e-12);
        assert!((share_of_circle(1., [0., 0., 5., 5.]) - 0.25).abs() < 1e-12);
        // From the corner of the unit square no part of a circle of radius 1.5 is inside.
        assert!(share_of_circle(1.5, [0., 0., 1., 1.]).abs() < 1e-12);
    }

    #[test]
    fn a_rectangle_given_as_a_polygon_weighs_pairs_as_a_rectangle() {
        let rectangle = Window::rectangle(1., 2., 4., 4.).unwrap();
        let corners = [(1., 2.), (4., 2.), (4., 4.), (1., 4.)].map(|(x, y)| Point::new(x, y));
        let polygon = Window::Polygon(Polygon::new(vec![corners.to_vec()]).unwrap());
        let (a, b) = (EdgeWeights::new(&rectangle), EdgeWeights::new(&polygon));
        for (x, y, dx, dy) in
            [(1.2, 2.1, 0.9, 0.3), (3.9, 3.9, -1., -1.7), (2.5, 3., 0.1, 0.1), (1., 2., 3., 1.)]
        {
            let (from, to, d) = (Point::new(x, y), Point::new(x + dx, y + dy), f64::hypot(dx, dy));
            assert!((a.translation(dx, dy) / b.translation(dx, dy) - 1.).abs() < 1e-9);
            assert!((a.isotropic(from, to, d) / b.isotropic(from, to, d) - 1.).abs() < 1e-9, "{x} {y}");
        }
        for r in [0.05, 0.5, 1.9] {
            assert!((a.covariance(r) - b.covariance(r)).abs() < 1e-4);
        }
    }
}
