use super::edge_tree::{Edge, EdgeTree, Extent};
use super::{Point, PolygonError};

/// Closed line through corners; the last corner is joined to the first.
pub type Ring = Vec<Point>;

/// Position of a point relative to a polygon.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    Inside,
    Border,
    Outside,
}

/// Returns the position of `p`: on an edge or, otherwise, inside if a ray to the right crosses an
/// odd number of edges.
pub(super) fn place(tree: &EdgeTree, p: Point) -> Place {
    let mut inside = false;
    let mut on_border = false;
    tree.visit(
        |b| b.y0 <= p.y && p.y <= b.y1 && b.x1 >= p.x,
        |_, edge| {
            let (low, high) =
                if edge.from.y <= edge.to.y { (edge.from, edge.to) } else { (edge.to, edge.from) };
            if p.y < low.y || p.y > high.y {
                return true;
            }
            let side = Edge { from: low, to: high }.side(p);
            let between = p.x >= low.x.min(high.x) && p.x <= low.x.max(high.x);
            if side == 0. && between {
                on_border = true;
                return false;
            }
            // p lies left of the edge (seen towards growing y), so the ray to the right meets it
            if p.y < high.y && side > 0. {
                inside = !inside;
            }
            true
        },
    );
    match (on_border, inside) {
        (true, _) => Place::Border,
        (false, true) => Place::Inside,
        (false, false) => Place::Outside,
    }
}

/// Returns whether the ring of `tree` surrounds `ring`; the two rings must not cross.
///
/// The first corner or middle of an edge of `ring` that does not lie on the ring of `tree` decides.
pub(super) fn surrounds(tree: &EdgeTree, ring: &Ring) -> bool {
    let next = ring.iter().cycle().skip(1);
    let places =
        ring.iter().zip(next).flat_map(|(a, b)| [*a, Point::new((a.x + b.x) / 2., (a.y + b.y) / 2.)]);
    places.map(|p| place(tree, p)).find(|p| *p != Place::Border) == Some(Place::Inside)
}

/// Returns a point at which two edges cross, or `None` if no edges cross.
///
/// Two edges cross if the ends of each edge lie strictly on opposite sides of the other edge.
pub(super) fn crossing(tree: &EdgeTree) -> Option<Point> {
    for (i, edge) in tree.edges().iter().enumerate() {
        let extent = Extent::of(edge);
        let mut found = None;
        tree.visit(
            |b| b.touches(&extent),
            |j, other| {
                if j <= i {
                    return true;
                }
                let (a, b) = (edge.side(other.from), edge.side(other.to));
                let (c, d) = (other.side(edge.from), other.side(edge.to));
                let opposite = |u: f64, v: f64| (u < 0. && v > 0.) || (u > 0. && v < 0.);
                if opposite(a, b) && opposite(c, d) {
                    let t = c / (c - d);
                    let at = |u: f64, v: f64| u + t * (v - u);
                    found = Some(Point::new(at(edge.from.x, edge.to.x), at(edge.from.y, edge.to.y)));
                }
                found.is_none()
            },
        );
        if found.is_some() {
            return found;
        }
    }
    None
}

/// Returns the edges of all rings.
pub(super) fn edges_of(rings: &[Ring]) -> Vec<Edge> {
    rings
        .iter()
        .flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&from, &to)| Edge { from, to }))
        .collect()
}

/// Returns the signed area of a ring: half the sum of the cross products of successive corners.
///
/// The corners are taken relative to the first one, as polygons far from the origin would lose
/// digits to cancellation.
pub(super) fn signed_area(ring: &[Point]) -> f64 {
    let Some(&o) = ring.first() else { return 0. };
    let cross = |a: &Point, b: &Point| (a.x - o.x) * (b.y - o.y) - (b.x - o.x) * (a.y - o.y);
    ring.windows(2).map(|w| cross(&w[0], &w[1])).sum::<f64>() / 2.
}

/// Removes repeated corners, and then rings with fewer than three corners.
///
/// # Errors
/// Fails if a coordinate is not finite or no ring is left.
pub(super) fn tidy(rings: Vec<Ring>) -> Result<Vec<Ring>, PolygonError> {
    if let Some(p) = rings.iter().flatten().find(|p| !p.is_finite()) {
        return Err(PolygonError::NotFinite { x: p.x, y: p.y });
    }
    let tidied = rings.into_iter().map(|mut ring| {
        // −0 becomes 0, so that equal polygons have equal bytes
        ring.iter_mut().for_each(|p| *p = Point::new(p.x + 0., p.y + 0.));
        ring.dedup();
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        ring
    });
    let rings: Vec<Ring> = tidied.filter(|ring| ring.len() > 2).collect();
    if rings.is_empty() { Err(PolygonError::NoArea) } else { Ok(rings) }
}

/// Returns the part of a ring in which `depth` is not negative.
///
/// `depth` must be a linear function of the position; it is 0 on the cutting line. `edge` moves a
/// computed crossing exactly onto that line.
pub(super) fn cut(ring: &[Point], depth: impl Fn(Point) -> f64, edge: impl Fn(Point) -> Point) -> Ring {
    let mut kept = Vec::with_capacity(ring.len() + 4);
    for (&a, &b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
        let (da, db) = (depth(a), depth(b));
        if da >= 0. {
            kept.push(a);
        }
        if (da > 0. && db < 0.) || (da < 0. && db > 0.) {
            let t = da / (da - db);
            kept.push(edge(Point::new(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y))));
        }
    }
    kept
}
