use super::edge_tree::{Edge, EdgeTree, Extent};
use super::ring::{Place, Ring, crossing, cut, edges_of, place, signed_area, surrounds, tidy};
use super::{Point, Rectangle, SetCovariance, WindowError};
use serde::{Deserialize, Serialize};
use std::sync::{Arc, OnceLock};

/// Reason why rings do not make a polygon.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
pub enum PolygonError {
    /// Rings that enclose no area.
    #[error("the polygon has no area: give at least three corners that do not lie on one line")]
    NoArea,
    /// Corner with a coordinate that is not finite.
    #[error("a corner of the polygon is ({x}, {y}): expected finite coordinates")]
    NotFinite {
        /// Horizontal coordinate of the corner.
        x: f64,
        /// Vertical coordinate of the corner.
        y: f64,
    },
    /// Edges that cross, so that inside and outside cannot be told apart.
    #[error(
        "the outline of the polygon crosses itself at ({x:.3}, {y:.3}): give its corners in order, and rings that do not cross"
    )]
    Crosses {
        /// Horizontal coordinate of the crossing.
        x: f64,
        /// Vertical coordinate of the crossing.
        y: f64,
    },
}

/// Area enclosed by one or more rings that do not cross (they may touch).
///
/// A point belongs to the area if an odd number of rings surround it: a ring within a ring is a
/// hole, a ring within a hole an island. The corners may be listed in either direction. They are
/// stored so that outer rings have positive area (clockwise, since y points down) and holes have
/// negative area.
///
/// Clones are cheap, as they share one copy of the rings.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "Vec<Vec<[f64; 2]>>", into = "Vec<Vec<[f64; 2]>>")]
pub struct Polygon {
    shape: Arc<Shape>,
}

/// Contents of a polygon, shared by its clones.
#[derive(Debug)]
struct Shape {
    /// Rings, as [`Polygon::rings`] returns them.
    rings: Vec<Ring>,
    /// Edges of all rings.
    tree: EdgeTree,
    bounds: Rectangle,
    area: f64,
    /// Set covariance, computed when it is first asked for.
    covariance: OnceLock<SetCovariance>,
}

impl Polygon {
    /// Builds the polygon that `rings` enclose.
    ///
    /// A corner that repeats the corner before it, a last corner that repeats the first one, and
    /// rings without area are dropped.
    ///
    /// # Errors
    /// Fails if no area is left, a corner is not finite, or edges cross.
    pub fn new(rings: Vec<Ring>) -> Result<Self, PolygonError> {
        let rings = tidy(rings)?;
        let tree = EdgeTree::new(edges_of(&rings));
        if let Some(p) = crossing(&tree) {
            return Err(PolygonError::Crosses { x: p.x, y: p.y });
        }
        // rings without area are dropped only after the check for crossings: a figure of eight has
        // no area, but the error should name its crossing
        let rings: Vec<Ring> = rings.into_iter().filter(|ring| signed_area(ring) != 0.).collect();
        // the depth of a ring is the number of other rings around it
        let trees: Vec<EdgeTree> =
            rings.iter().map(|r| EdgeTree::new(edges_of(std::slice::from_ref(r)))).collect();
        let oriented = rings.iter().enumerate().map(|(i, ring)| {
            let around =
                trees.iter().enumerate().filter(|&(j, tree)| j != i && surrounds(tree, ring)).count();
            let mut ring = ring.clone();
            if (signed_area(&ring) > 0.) != (around % 2 == 0) {
                ring.reverse();
            }
            ring
        });
        Self::from_oriented(oriented.collect())
    }

    /// Builds a polygon from rings that are known not to cross; outer rings must have positive
    /// area, and holes negative area.
    fn from_oriented(rings: Vec<Ring>) -> Result<Self, PolygonError> {
        let tree = EdgeTree::new(edges_of(&rings));
        let area: f64 = rings.iter().map(|ring| signed_area(ring)).sum();
        let extent = tree.edges().iter().map(Extent::of).reduce(Extent::union).ok_or(PolygonError::NoArea)?;
        let bounds = Rectangle::new(extent.x0, extent.y0, extent.x1, extent.y1);
        let bounds = bounds.map_err(|_: WindowError| PolygonError::NoArea)?;
        // an area of 10⁻¹² of the bounds is not distinguished from rounding errors
        if area.is_nan() || area <= 1e-12 * bounds.area() {
            return Err(PolygonError::NoArea);
        }
        Ok(Self { shape: Arc::new(Shape { rings, tree, bounds, area, covariance: OnceLock::new() }) })
    }

    /// Returns the rings of the polygon: outer rings have positive area, holes negative area.
    pub fn rings(&self) -> &[Ring] {
        &self.shape.rings
    }

    /// Returns the smallest upright rectangle around the polygon.
    pub fn bounds(&self) -> Rectangle {
        self.shape.bounds
    }

    /// Returns the area, in squared units of the coordinates.
    pub fn area(&self) -> f64 {
        self.shape.area
    }

    /// Returns the upright rectangle that equals this polygon, or `None` if the polygon is not an
    /// upright rectangle.
    pub fn as_rectangle(&self) -> Option<Rectangle> {
        let b = self.bounds();
        let [ring] = self.rings() else { return None };
        let at_edge = |p: &Point| p.x == b.x0() || p.x == b.x1() || p.y == b.y0() || p.y == b.y1();
        let upright = |e: &Edge| e.from.x == e.to.x || e.from.y == e.to.y;
        let fills = (self.area() / b.area() - 1.).abs() < 1e-12;
        (fills && ring.iter().all(at_edge) && self.shape.tree.edges().iter().all(upright)).then_some(b)
    }

    /// Returns whether a point lies inside or on the border.
    pub fn contains(&self, p: Point) -> bool {
        self.place(p) != Place::Outside
    }

    /// Returns whether a point lies inside and not on the border.
    pub fn contains_strictly(&self, p: Point) -> bool {
        self.place(p) == Place::Inside
    }

    fn place(&self, p: Point) -> Place {
        let b = &self.shape.bounds;
        if b.contains(p) { place(&self.shape.tree, p) } else { Place::Outside }
    }

    /// Returns the distance from a point to the nearest edge; negative if the point lies outside.
    pub fn border_distance(&self, p: Point) -> f64 {
        let distance = self.shape.tree.distance(p);
        if self.contains(p) { distance } else { -distance }
    }

    /// Returns the fraction of the circle of radius `d` around `p` that lies in the polygon.
    ///
    /// `p` must lie inside the polygon. The crossings with the outline divide the circle into arcs;
    /// an arc counts if its middle lies in the polygon.
    pub fn share_of_circle(&self, p: Point, d: f64) -> f64 {
        let mut angles: Vec<f64> = Vec::new();
        self.shape.tree.visit_circle(p, d, |edge| {
            let (ax, ay) = (edge.from.x - p.x, edge.from.y - p.y);
            let (dx, dy) = (edge.to.x - edge.from.x, edge.to.y - edge.from.y);
            // with a the start of the edge relative to p, b its direction: |a + t b|² = d², 0 ≤ t ≤
            // 1
            let (a, half_b, c) = (dx * dx + dy * dy, ax * dx + ay * dy, ax * ax + ay * ay - d * d);
            let discriminant = half_b * half_b - a * c;
            if discriminant <= 0. {
                return;
            }
            for root in [-discriminant.sqrt(), discriminant.sqrt()] {
                let t = (root - half_b) / a;
                if (0. ..=1.).contains(&t) {
                    angles.push((ay + t * dy).atan2(ax + t * dx));
                }
            }
        });
        let inside = |angle: f64| self.contains(Point::new(p.x + d * angle.cos(), p.y + d * angle.sin()));
        if angles.is_empty() {
            return f64::from(u8::from(inside(0.)));
        }
        angles.sort_by(f64::total_cmp);
        let tau = std::f64::consts::TAU;
        let mut share = 0.;
        for (k, &from) in angles.iter().enumerate() {
            let to = angles.get(k + 1).copied().unwrap_or(angles[0] + tau);
            if to > from && inside((from + to) / 2.) {
                share += to - from;
            }
        }
        share / tau
    }

    /// Writes to `chords` the intervals of x, in rising order, in which the horizontal line at `y`
    /// runs inside the polygon.
    pub(crate) fn chords(&self, y: f64, chords: &mut Vec<(f64, f64)>) {
        let mut crossings: Vec<f64> = Vec::new();
        self.shape.tree.visit(
            |b| b.y0 <= y && y <= b.y1,
            |_, edge| {
                if (edge.from.y <= y) != (edge.to.y <= y) {
                    let t = (y - edge.from.y) / (edge.to.y - edge.from.y);
                    crossings.push(edge.from.x + t * (edge.to.x - edge.from.x));
                }
                true
            },
        );
        crossings.sort_by(f64::total_cmp);
        chords.clear();
        chords.extend(crossings.as_chunks::<2>().0.iter().map(|&[from, to]| (from, to)));
    }

    /// Returns the set covariance, which is computed when first asked for and shared by all clones.
    pub fn covariance(&self) -> &SetCovariance {
        self.shape.covariance.get_or_init(|| SetCovariance::of(self))
    }

    /// Returns nodes, each a point on the outline and a weight, such that Σ weight · F(point) is
    /// the integral of ∂F/∂x over the polygon (Green's theorem).
    ///
    /// Edges are divided into pieces no longer than `step`. Each piece is integrated by Gauss's
    /// rule of 8 nodes, which is exact to rounding if F varies slowly over a step.
    pub(crate) fn boundary_rule(&self, step: f64) -> Vec<(Point, f64)> {
        let mut nodes = Vec::new();
        for edge in self.shape.tree.edges() {
            let (dx, dy) = (edge.to.x - edge.from.x, edge.to.y - edge.from.y);
            // dy is the factor of every weight, so a horizontal edge adds nothing
            if dy == 0. {
                continue;
            }
            let pieces = (dx.hypot(dy) / step).ceil().clamp(1., 1e4);
            for piece in 0..pieces as usize {
                for (at, weight) in GAUSS {
                    for (at, weight) in [(0.5 - at / 2., weight / 2.), (0.5 + at / 2., weight / 2.)] {
                        let t = (piece as f64 + at) / pieces;
                        let place = Point::new(edge.from.x + t * dx, edge.from.y + t * dy);
                        nodes.push((place, weight * dy / pieces));
                    }
                }
            }
        }
        nodes
    }

    /// Returns the part of the polygon inside `frame`, or `None` if nothing is left.
    ///
    /// Each ring is cut at the four edges of the frame in turn (Sutherland & Hodgman 1974,
    /// <https://doi.org/10.1145/360767.360802>). Parts of a ring that come apart stay joined by
    /// edges that run to and fro along the frame. These edges enclose nothing, and no path out of
    /// the polygon meets them first.
    pub fn within(&self, frame: &Rectangle) -> Option<Self> {
        let b = self.bounds();
        if frame.x0() <= b.x0() && frame.y0() <= b.y0() && frame.x1() >= b.x1() && frame.y1() >= b.y1() {
            return Some(self.clone());
        }
        let rings = self.rings().iter().map(|ring| {
            let ring = cut(ring, |p| p.x - frame.x0(), |p| Point::new(frame.x0(), p.y));
            let ring = cut(&ring, |p| frame.x1() - p.x, |p| Point::new(frame.x1(), p.y));
            let ring = cut(&ring, |p| p.y - frame.y0(), |p| Point::new(p.x, frame.y0()));
            cut(&ring, |p| frame.y1() - p.y, |p| Point::new(p.x, frame.y1()))
        });
        let rings = tidy(rings.collect()).ok()?;
        Self::from_oriented(rings.into_iter().filter(|ring| signed_area(ring) != 0.).collect()).ok()
    }

    /// Multiplies all coordinates by `factor`, a positive number.
    ///
    /// # Errors
    /// Fails if a coordinate or the area of the result is too large or too small for an `f64`.
    pub fn scaled(&self, factor: f64) -> Result<Self, PolygonError> {
        let times = |p: &Point| Point::new(p.x * factor, p.y * factor);
        Self::new(self.rings().iter().map(|ring| ring.iter().map(times).collect()).collect())
    }
}

/// Positive nodes and weights of Gauss's rule of 8 nodes on `[−1, 1]` (Abramowitz & Stegun 1964,
/// table 25.4). The other four nodes are their negatives, with the same weights.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};

    fn ring(corners: &[(f64, f64)]) -> Ring {
        corners.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    /// Returns a square with a square hole, in which there is a square island.
    fn island() -> Polygon {
        let square = |low: f64, high: f64| ring(&[(low, low), (high, low), (high, high), (low, high)]);
        Polygon::new(vec![square(2., 8.), square(0., 10.), square(4., 6.)]).unwrap()
    }

    #[test]
    fn rings_in_rings_are_holes_and_islands_whichever_way_round() {
        let polygon = island();
        assert_eq!(polygon.area(), 100. - 36. + 4.);
        for (x, expected) in
            [(1., true), (2., true), (3., false), (5., true), (7., false), (9., true), (11., false)]
        {
            assert_eq!(polygon.contains(Point::new(x, 5.)), expected, "{x}");
        }
        assert!(!polygon.contains_strictly(Point::new(2., 5.)));
        for (x, expected) in [(1., 1.), (1.9, 0.1), (5., 1.), (3., -1.), (12., -2.)] {
            assert!((polygon.border_distance(Point::new(x, 5.)) - expected).abs() < 1e-12, "{x}");
        }
    }

    #[test]
    fn rings_that_enclose_nothing_or_cross_are_refused() {
        let bow_tie = ring(&[(0., 0.), (2., 2.), (2., 0.), (0., 2.)]);
        let [x, y] = match Polygon::new(vec![bow_tie]).unwrap_err() {
            PolygonError::Crosses { x, y } => [x, y],
            other => panic!("{other:?}"),
        };
        assert!((x - 1.).abs() < 1e-12 && (y - 1.).abs() < 1e-12);
        assert_eq!(Polygon::new(vec![]).unwrap_err(), PolygonError::NoArea);
        assert_eq!(
            Polygon::new(vec![ring(&[(0., 0.), (1., 1.), (2., 2.)])]).unwrap_err(),
            PolygonError::NoArea
        );
        let nan = Polygon::new(vec![ring(&[(0., 0.), (1., f64::NAN), (2., 2.)])]);
        assert!(matches!(nan, Err(PolygonError::NotFinite { .. })));
    }

    #[test]
    fn a_polygon_survives_json_and_only_upright_rectangles_become_rectangles() {
        use crate::geometry::Window;
        let polygon = island();
        let json = serde_json::to_string(&Window::Polygon(polygon.clone())).unwrap();
        assert_eq!(serde_json::from_str::<Window>(&json).unwrap(), Window::Polygon(polygon));
        let closed = ring(&[(1., 1.), (1., 3.), (5., 3.), (5., 3.), (5., 1.), (3., 1.), (1., 1.)]);
        assert_eq!(Window::polygon(vec![closed]).unwrap(), Window::rectangle(1., 1., 5., 3.).unwrap());
        let tilted = ring(&[(1., 0.), (2., 1.), (1., 2.), (0., 1.)]);
        assert!(matches!(Window::polygon(vec![tilted]).unwrap(), Window::Polygon(_)));
    }

    #[test]
    fn a_frame_cuts_area_and_leaves_what_is_inside() {
        let frame = Rectangle::new(1., 3., 9., 7.).unwrap();
        let cut = island().within(&frame).unwrap();
        // 8 × 4 less the 6 × 4 hole, and the island
        assert!((cut.area() - (32. - 24. + 4.)).abs() < 1e-12);
        for i in 0..400 {
            let p = Point::new(0.03 + 0.5 * f64::from(i % 20), 0.02 + 0.5 * f64::from(i / 20));
            assert_eq!(cut.contains(p), island().contains(p) && frame.contains(p), "{p:?}");
        }
        assert!(island().within(&Rectangle::new(20., 0., 21., 1.).unwrap()).is_none());
        // a U cut across its arms: two pieces, and no border between them
        let u = ring(&[(0., 0.), (1., 0.), (1., 4.), (4., 4.), (4., 0.), (5., 0.), (5., 5.), (0., 5.)]);
        let arms = Polygon::new(vec![u]).unwrap().within(&Rectangle::new(-1., -1., 6., 3.).unwrap()).unwrap();
        assert_eq!(arms.area(), 6.);
        assert!((arms.border_distance(Point::new(0.5, 2.8)) - 0.2).abs() < 1e-12);
        assert!(!arms.contains(Point::new(2., 2.9)));
    }

    #[test]
    fn shares_of_circles_are_those_counted_on_their_points() {
        let polygon = island();
        for (x, y, d) in [(1., 5., 0.7), (1., 5., 2.5), (5., 5., 1.3), (0.1, 0.1, 6.), (9., 9., 4.4)] {
            let m = 20_000;
            let on = |a: i32| {
                let angle = std::f64::consts::TAU * (f64::from(a) + 0.5) / f64::from(m);
                Point::new(x + d * angle.cos(), y + d * angle.sin())
            };
            let counted = (0..m).filter(|&a| polygon.contains(on(a))).count() as f64 / f64::from(m);
            let share = polygon.share_of_circle(Point::new(x, y), d);
            assert!((share - counted).abs() < 5e-4, "{x} {y} {d}: {share}, {counted}");
        }
    }

    /// Returns a star of many corners whose radius scatters; no two of its edges cross.
    fn star(corners: usize, seed: u64) -> Polygon {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let corner = |k: usize, r: f64| {
            let angle = k as f64 / corners as f64 * std::f64::consts::TAU;
            Point::new(5. + r * angle.cos(), -3. + r * angle.sin())
        };
        Polygon::new(vec![(0..corners).map(|k| corner(k, 1. + rng.random::<f64>())).collect()]).unwrap()
    }

    #[test]
    fn boundary_rule_integrates_over_the_area() {
        let polygon = star(200, 1);
        let area: f64 = polygon.boundary_rule(0.1).iter().map(|(p, weight)| p.x * weight).sum();
        assert!((area / polygon.area() - 1.).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn tree_answers_as_all_edges_one_by_one(seed: u64, corners in 3..300usize, x in 2.5..7.5f64, y in -5.5..-0.5f64) {
            let polygon = star(corners, seed);
            let p = Point::new(x, y);
            let edges = edges_of(polygon.rings());
            let crossings = edges.iter().filter(|e| {
                let at = |y: f64| e.from.x + (y - e.from.y) / (e.to.y - e.from.y) * (e.to.x - e.from.x);
                (e.from.y <= y) != (e.to.y <= y) && at(y) > x
            });
            prop_assert_eq!(polygon.contains(p), crossings.count() % 2 == 1);
            let least = edges.iter().map(|e| EdgeTree::new(vec![*e]).distance(p)).fold(f64::INFINITY, f64::min);
            // the tree may take the same edge in a sum of another order
            prop_assert!((polygon.border_distance(p).abs() - least).abs() <= 1e-14 * (1. + least));
            let sampled = edges.iter().flat_map(|e| (0..=50).map(move |k| {
                let t = f64::from(k) / 50.;
                Point::new(e.from.x + t * (e.to.x - e.from.x), e.from.y + t * (e.to.y - e.from.y)).distance(p)
            }));
            prop_assert!(least <= sampled.fold(f64::INFINITY, f64::min) + 1e-12);
        }
    }
}
