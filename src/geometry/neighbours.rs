use super::{Point, Window};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use rayon::prelude::*;
use std::num::NonZero;

/// For every point the nearest other point; both empty for fewer than two points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NearestNeighbours {
    /// Distance to it, in the unit of the coordinates; 0 where points coincide.
    pub distances: Vec<f64>,
    /// Its index; one of them where several are equally near.
    pub indices: Vec<usize>,
}

/// Nearest neighbour of every point, by k-d tree; the short way round on a torus.
///
/// Empty for fewer than two points, and if a coordinate is not finite.
pub fn nearest_neighbours(points: &[Point], window: &Window) -> NearestNeighbours {
    let mut nearest = NearestNeighbours::default();
    if points.len() < 2 {
        return nearest;
    }
    let Some(finder) = Finder::new(points, window) else { return nearest };
    // The point itself is one of the two nearest, unless others coincide with it.
    let two = NonZero::<usize>::MIN.saturating_add(1);
    for (i, &p) in points.iter().enumerate() {
        let Some(j) = finder.nearest(p, two).find(|&j| j != i) else {
            return NearestNeighbours::default();
        };
        // From the coordinates as given, so that moving the window cannot round the distance.
        nearest.distances.push(window.distance(p, points[j]));
        nearest.indices.push(j);
    }
    nearest
}

/// Distance from each of `places` to the nearest of `points`, the short way round on a torus; infinite without points,
/// and if a coordinate of theirs is not finite.
pub fn distances_to_nearest(places: &[Point], points: &[Point], window: &Window) -> Vec<f64> {
    let finder = if points.is_empty() { None } else { Finder::new(points, window) };
    let distance = |&place: &Point| {
        let found = finder.as_ref().and_then(|f| f.nearest(place, NonZero::<usize>::MIN).next());
        found.map_or(f64::INFINITY, |j| window.distance(place, points[j]))
    };
    places.par_iter().map(distance).collect()
}

/// The points of a window, to look for those nearest to a place.
struct Finder<'a> {
    tree: ImmutableKdTree<f64, 2>,
    window: &'a Window,
    origin: [f64; 2],
    sides: [f64; 2],
}

impl<'a> Finder<'a> {
    /// `None` if a coordinate is not finite.
    fn new(points: &[Point], window: &'a Window) -> Option<Self> {
        if points.iter().any(|p| !p.is_finite()) {
            return None;
        }
        let bounds = window.bounds();
        let (origin, sides) = ([bounds.x0(), bounds.y0()], [bounds.width(), bounds.height()]);
        let coordinates: Vec<[f64; 2]> = points.iter().map(|p| [p.x - origin[0], p.y - origin[1]]).collect();
        let tree = ImmutableKdTree::new_from_slice(&coordinates).ok()?;
        Some(Self { tree, window, origin, sides })
    }

    /// Indices of the `n` nearest points.
    fn nearest(&self, place: Point, n: NonZero<usize>) -> impl Iterator<Item = usize> {
        let at = [place.x - self.origin[0], place.y - self.origin[1]];
        let query = self.tree.query(&at);
        let found = if self.window.is_torus() {
            query.periodic_boundary_condition(&self.sides).nearest_n::<SquaredEuclidean<f64>>(n).execute()
        } else {
            query.nearest_n::<SquaredEuclidean<f64>>(n).execute()
        };
        found.into_iter().map(|f| f.item as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn coinciding_points_are_each_others_neighbours_at_distance_0() {
        let p = Point::new(0.5, 0.5);
        for window in [Window::unit_square(), Window::unit_torus()] {
            let nearest = nearest_neighbours(&[p, p, p, Point::new(0.1, 0.1)], &window);
            assert_eq!(nearest.distances[..3], [0., 0., 0.]);
            assert!((0..4).all(|i| nearest.indices[i] != i));
        }
    }

    #[test]
    fn one_point_has_no_neighbour() {
        let window = Window::unit_torus();
        assert_eq!(nearest_neighbours(&[Point::new(0.5, 0.5)], &window), NearestNeighbours::default());
    }

    proptest! {
        #[test]
        fn nearest_neighbour_is_the_least_of_all_distances(
            // A coarse lattice of coordinates, so that points coincide and lie on the border.
            raw in prop::collection::vec((0..12u8, 0..12u8), 0..60), torus: bool, x0 in -1e3..1e3f64,
        ) {
            let bounds = crate::geometry::Rectangle::new(x0, 0., x0 + 11., 11.).unwrap();
            let window = if torus { Window::Torus(bounds) } else { Window::Rectangle(bounds) };
            let points: Vec<Point> =
                raw.iter().map(|&(x, y)| Point::new((x0 + f64::from(x)).min(x0 + 11.), f64::from(y))).collect();
            let nearest = nearest_neighbours(&points, &window);
            prop_assert_eq!(nearest.distances.len(), if points.len() < 2 { 0 } else { points.len() });
            for (i, &d) in nearest.distances.iter().enumerate() {
                let least = (0..points.len())
                    .filter(|&j| j != i)
                    .map(|j| window.distance(points[i], points[j]))
                    .fold(f64::INFINITY, f64::min);
                prop_assert!((d - least).abs() < 1e-9, "{} {}", d, least);
            }
        }
    }
}
