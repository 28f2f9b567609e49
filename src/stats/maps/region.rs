//! Region in which a map is at least as high as a level: its area, centroid and outlines.
//!
//! 1. Cut each triangle, in which the map is linear, along the level.
//! 2. Integrate area and moments exactly over the part above the level.
//! 3. Join the points where the level crosses the sides of triangles into outlines.

use super::surface::{Surface, Valued, cross};
use crate::geometry::Point;
use std::collections::{BTreeMap, BTreeSet};

/// Part of a map that is at least as high as a level.
#[derive(Clone, Debug, Default)]
pub(super) struct Region {
    /// Area of the region, in squared units of the coordinates.
    pub(super) area: f64,
    /// Centroid of the region, weighted by the map; `None` if the region has no area.
    pub(super) centroid: Option<Point>,
    /// `true` if the region extends to the edge of the map, where the map has not yet fallen below
    /// the level; its true extent is then unknown.
    pub(super) cut: bool,
    /// Outlines of the region, longest first.
    pub(super) contours: Vec<Contour>,
}

/// Line along which a map has a constant value.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    /// Points along the line, in order; a closed line does not repeat its first point.
    pub places: Vec<Point>,
    /// `true` if the line returns to its first point, `false` if it ends at the edge of the map.
    pub closed: bool,
}

impl Contour {
    /// Returns the length of the line, in units of the coordinates.
    pub fn length(&self) -> f64 {
        let steps: f64 = self.places.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let back = match (self.places.first(), self.places.last()) {
            (Some(first), Some(last)) if self.closed => first.distance(*last),
            _ => 0.,
        };
        steps + back
    }
}

/// Computes the region in which a map is at least `level`.
///
/// `values` contains the value of the map at each cone; between cones the map is linear in each
/// triangle. Sums are taken relative to `origin`, a point near the map, to avoid cancellation in
/// windows far from the origin of the coordinates.
pub(super) fn region(surface: &Surface, values: &[Option<f64>], level: f64, origin: Point) -> Region {
    // `mass` is the integral of the map over the region, and `moment` the integral of the map times
    // the position.
    let (mut area, mut mass, mut moment) = (0., 0., [0.; 2]);
    // Points where the level crosses sides of triangles, by the index of the side. Each point comes
    // with the indices of the crossed sides at which the outline continues, at most one in either
    // of the two triangles that share the side.
    let mut crossings: BTreeMap<usize, (Point, Vec<usize>)> = BTreeMap::new();
    // Sides at the edge of the map of which an end is in the region. A side is at the edge of the
    // map if only one triangle with values has it.
    let mut border: BTreeSet<usize> = BTreeSet::new();
    for triangle in &surface.triangles {
        let Some(corners) = surface.valued(triangle, values) else { continue };
        // `crossed`: sides of this triangle that the level crosses, none or two. `part`: corners of
        // the part of this triangle above the level, 3 or 4 if there is one.
        let mut crossed: Vec<usize> = Vec::with_capacity(2);
        let mut part: Vec<Valued> = Vec::with_capacity(4);
        for k in 0..3 {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            let side = triangle.sides[k];
            if from.1 >= level || to.1 >= level {
                // The second triangle that has the same side removes it again.
                if !border.remove(&side) {
                    border.insert(side);
                }
            }
            if from.1 >= level {
                part.push(from);
            }
            if (from.1 >= level) != (to.1 >= level) {
                let t = (level - from.1) / (to.1 - from.1);
                let place =
                    Point::new(from.0.x + t * (to.0.x - from.0.x), from.0.y + t * (to.0.y - from.0.y));
                part.push((place, level));
                crossings.entry(side).or_insert((place, Vec::new()));
                crossed.push(side);
            }
        }
        if let [a, b] = crossed[..] {
            for (this, other) in [(a, b), (b, a)] {
                if let Some((_, joined)) = crossings.get_mut(&this) {
                    joined.push(other);
                }
            }
        }
        // The part above the level is convex, so it is divided into triangles from its first
        // corner.
        for k in 2..part.len() {
            let (a, b, c) = (part[0], part[k - 1], part[k]);
            let size = cross(a.0, b.0, c.0).abs() / 2.;
            area += size;
            // The integrand of `moment` is the product of two linear functions, map and position.
            // For such a product, the area times the mean over the midpoints of the three sides is
            // the exact integral.
            for (p, q) in [(a, b), (b, c), (c, a)] {
                let weight = size / 3. * (p.1 + q.1) / 2.;
                mass += weight;
                moment[0] += weight * ((p.0.x + q.0.x) / 2. - origin.x);
                moment[1] += weight * ((p.0.y + q.0.y) / 2. - origin.y);
            }
        }
    }
    let centroid = (mass > 0.).then(|| Point::new(origin.x + moment[0] / mass, origin.y + moment[1] / mass));
    let mut contours = contours(crossings);
    contours.sort_by(|a, b| b.length().total_cmp(&a.length()));
    Region { area, centroid, cut: !border.is_empty(), contours }
}

/// Joins the crossings of [`region()`] into lines: first the lines that end at the edge of the map,
/// then the closed lines.
fn contours(mut crossings: BTreeMap<usize, (Point, Vec<usize>)>) -> Vec<Contour> {
    let mut lines = Vec::new();
    for open in [true, false] {
        // An open line starts at a crossing that continues in one direction only. When the open
        // lines are removed, any crossing that is left can start a closed line.
        let starts: Vec<usize> =
            crossings.iter().filter(|(_, (_, joined))| !open || joined.len() < 2).map(|(&k, _)| k).collect();
        for start in starts {
            let mut places = Vec::new();
            let mut at = Some(start);
            while let Some((place, joined)) = at.and_then(|k| crossings.remove(&k)) {
                places.push(place);
                at = joined.into_iter().find(|next| crossings.contains_key(next));
            }
            // A single crossing is no line.
            if places.len() > 1 {
                lines.push(Contour { places, closed: !open });
            }
        }
    }
    lines
}
