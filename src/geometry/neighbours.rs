use super::index::{NeighbourTree, WindowGrid};
use super::{Point, Window};
use rayon::prelude::*;
use serde::Serialize;
use std::num::NonZero;

/// Smallest number of points for which the search runs on all threads; a search for fewer is done
/// before threads would pay.
const SPREAD_FROM: usize = 8192;

/// Nearest neighbour of every point, in the order of the points.
///
/// Both lists are empty for fewer than two points.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct NearestNeighbours {
    /// Distance from each point to the nearest other point, in the unit of the coordinates; 0 if
    /// the two coincide.
    pub distances: Vec<f64>,
    /// Index of the nearest other point of each point. If several are equally near, it is any of
    /// them.
    pub indices: Vec<usize>,
}

/// Finds the nearest neighbour of every point with a k-d tree; on a torus, distances are those of
/// the short way round.
///
/// The result is empty for fewer than two points, and if a coordinate is not finite.
pub fn nearest_neighbours(points: &[Point], window: &Window) -> NearestNeighbours {
    let mut nearest = NearestNeighbours::default();
    if points.len() < 2 {
        return nearest;
    }
    let Some(tree) = planted(points, window) else { return nearest };
    // The point itself is one of its two nearest, unless others coincide with it.
    let two = NonZero::<usize>::MIN.saturating_add(1);
    let other = |(i, &p): (usize, &Point)| {
        let (j, _) = tree.nearest(p, two).find(|&(j, _)| j != i)?;
        // Computed from the original coordinates, so that moving the window cannot change the
        // rounding.
        Some((window.distance(p, points[j]), j))
    };
    let found: Option<Vec<(f64, usize)>> = if points.len() < SPREAD_FROM {
        points.iter().enumerate().map(other).collect()
    } else {
        points.par_iter().enumerate().map(other).collect()
    };
    (nearest.distances, nearest.indices) = found.unwrap_or_default().into_iter().unzip();
    nearest
}

/// Returns the distance from each of `places` to the nearest of `points`; on a torus, distances are
/// those of the short way round.
///
/// Distances are infinite if there are no points or a coordinate of `points` is not finite.
pub fn distances_to_nearest(places: &[Point], points: &[Point], window: &Window) -> Vec<f64> {
    let tree = if points.is_empty() { None } else { planted(points, window) };
    let Some(tree) = tree else { return vec![f64::INFINITY; places.len()] };
    let grid = WindowGrid::new(points, window);
    let distance = |&place: &Point| {
        // The grid is faster, but finds no point where points are too sparse.
        let near = grid.nearest(place);
        let found = near.or_else(|| tree.nearest(place, NonZero::<usize>::MIN).next().map(|(j, _)| j));
        found.map_or(f64::INFINITY, |j| window.distance(place, points[j]))
    };
    places.par_iter().map(distance).collect()
}

/// Builds the k-d tree, or returns `None` if a coordinate is not finite or there are too many
/// points.
fn planted(points: &[Point], window: &Window) -> Option<NeighbourTree> {
    if points.iter().any(|p| !p.is_finite()) {
        return None;
    }
    NeighbourTree::in_window(points, window).ok()
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
    fn the_nearest_point_to_a_place_is_found_in_even_and_in_clustered_patterns() {
        use rand::{RngExt, SeedableRng};
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let places: Vec<Point> = (0..500).map(|_| Point::new(rng.random(), rng.random())).collect();
        for exponent in [1., 6.] {
            let points: Vec<Point> =
                (0..300).map(|_| Point::new(rng.random::<f64>().powf(exponent), rng.random())).collect();
            for window in [Window::unit_square(), Window::unit_torus()] {
                for (place, d) in places.iter().zip(distances_to_nearest(&places, &points, &window)) {
                    let least =
                        points.iter().map(|p| window.distance(*place, *p)).fold(f64::INFINITY, f64::min);
                    assert!((d - least).abs() < 1e-12, "{place:?}: {d}, {least}");
                }
            }
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
            // A coarse lattice of coordinates makes points coincide and lie on the border.
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
