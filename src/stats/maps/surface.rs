//! Linear interpolation of values at cones over the Delaunay triangles between them.

use crate::geometry::{Point, Window};
use crate::stats::delaunay::delaunay;
use rayon::prelude::*;
use spade::Triangulation;

/// Interpolation of values between cones, linear in each Delaunay triangle.
///
/// Only triangles that lie in the window are used; a triangle counts as lying in the window if the
/// midpoints of its three sides do. The interpolation is not defined outside these triangles, nor
/// in a triangle of which a corner has no value.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    /// Positions of all cones.
    points: Vec<Point>,
    /// Delaunay triangles that lie in the window.
    pub(super) triangles: Vec<Triangle>,
}

/// Triangle between three cones, given by the indices of its corners and of its sides.
///
/// Side k runs from corner k to the next corner. A side that two triangles share has the same index
/// in both of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    /// Indices of the three cones, in order around the triangle.
    pub(super) corners: [usize; 3],
    /// Indices of the three sides.
    pub(super) sides: [usize; 3],
}

/// Position in the window, with the value of a map there.
pub(super) type Valued = (Point, f64);

impl Surface {
    /// Triangulates the points and keeps the triangles that lie in the window.
    pub(super) fn new(points: &[Point], window: &Window) -> Self {
        let mut triangles = Vec::new();
        if let Some(found) = delaunay(points, &window.bounds()) {
            for face in found.triangulation.inner_faces() {
                let edges = face.adjacent_edges();
                let corners = edges.map(|edge| found.sites[edge.from().index()].0);
                let [a, b, c] = corners.map(|k| points[k]);
                let middle = |p: Point, q: Point| Point::new((p.x + q.x) / 2., (p.y + q.y) / 2.);
                if [middle(a, b), middle(b, c), middle(c, a)].iter().all(|&p| window.contains(p)) {
                    triangles
                        .push(Triangle { corners, sides: edges.map(|edge| edge.as_undirected().index()) });
                }
            }
        }
        Self { points: points.to_vec(), triangles }
    }

    /// Returns the corners of a triangle with their values, or `None` if a corner has no value.
    ///
    /// `values` contains one value per cone.
    pub(super) fn valued(&self, triangle: &Triangle, values: &[Option<f64>]) -> Option<[Valued; 3]> {
        let [a, b, c] = triangle.corners;
        Some([(self.points[a], values[a]?), (self.points[b], values[b]?), (self.points[c], values[c]?)])
    }

    /// Returns the interpolated values of several maps at the position `place`, or `None` for each
    /// map that is not defined there.
    ///
    /// Each map contains one value per cone.
    pub(super) fn at<const N: usize>(&self, place: Point, maps: &[Vec<Option<f64>>; N]) -> [Option<f64>; N] {
        // On a side that triangles share, the first triangle with a value counts, whatever the
        // number of threads.
        let found = self.triangles.par_iter().find_map_first(|triangle| {
            let shares = self.shares(triangle, place)?;
            let value = |map: &Vec<Option<f64>>| weighted(map, triangle, shares);
            let values: [Option<f64>; N] = std::array::from_fn(|k| value(&maps[k]));
            values.iter().any(Option::is_some).then_some(values)
        });
        found.unwrap_or([None; N])
    }

    /// Returns the barycentric coordinates of the position `place` in a triangle: the weights of
    /// the corners in linear interpolation.
    ///
    /// Returns `None` if `place` lies outside the triangle, or if the triangle has no area. The
    /// border belongs to the triangle.
    pub(super) fn shares(&self, triangle: &Triangle, place: Point) -> Option<[f64; 3]> {
        let [a, b, c] = triangle.corners.map(|k| self.points[k]);
        let (low, high) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        // Most triangles are excluded by their range of x alone, which is cheap to compare.
        if place.x < low || place.x > high {
            return None;
        }
        let twice = cross(a, b, c);
        if twice == 0. {
            return None;
        }
        let shares = [cross(place, b, c) / twice, cross(a, place, c) / twice, cross(a, b, place) / twice];
        // Rounding may make a weight slightly negative. Without the tolerance, a position on a side
        // could lie in neither of the two triangles that share it.
        shares.iter().all(|&share| share >= -1e-12).then_some(shares)
    }

    /// Returns the bounding box of a triangle: the smallest x, the smallest y, the largest x and
    /// the largest y.
    pub(super) fn extent(&self, triangle: &Triangle) -> [f64; 4] {
        let [a, b, c] = triangle.corners.map(|k| self.points[k]);
        [a.x.min(b.x).min(c.x), a.y.min(b.y).min(c.y), a.x.max(b.x).max(c.x), a.y.max(b.y).max(c.y)]
    }
}

/// Returns the interpolated value in a triangle: the mean of the values at its corners, weighted by
/// the barycentric coordinates `shares`.
///
/// `values` contains one value per cone. Returns `None` if a corner has no value.
pub(super) fn weighted(values: &[Option<f64>], triangle: &Triangle, shares: [f64; 3]) -> Option<f64> {
    let mut sum = 0.;
    for (&corner, share) in triangle.corners.iter().zip(shares) {
        sum += share * values[corner]?;
    }
    Some(sum)
}

/// Returns twice the signed area of the triangle abc: the cross product of b − a and c − a.
///
/// It is positive if a, b, c run from +x towards +y.
pub(super) fn cross(a: Point, b: Point, c: Point) -> f64 {
    (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)
}
