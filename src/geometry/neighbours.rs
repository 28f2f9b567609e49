use super::{Point, Window};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
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
    if points.len() < 2 || points.iter().any(|p| !p.is_finite()) {
        return nearest;
    }
    let bounds = window.bounds();
    let sides = [bounds.width(), bounds.height()];
    let coordinates: Vec<[f64; 2]> = points.iter().map(|p| [p.x - bounds.x0(), p.y - bounds.y0()]).collect();
    let Ok(tree) = ImmutableKdTree::<f64, 2>::new_from_slice(&coordinates) else { return nearest };
    // The point itself is one of the two nearest, unless others coincide with it.
    let two = NonZero::<usize>::MIN.saturating_add(1);
    for (i, at) in coordinates.iter().enumerate() {
        let query = tree.query(at);
        let found = if window.is_torus() {
            query.periodic_boundary_condition(&sides).nearest_n::<SquaredEuclidean<f64>>(two).execute()
        } else {
            query.nearest_n::<SquaredEuclidean<f64>>(two).execute()
        };
        let Some(j) = found.iter().map(|f| f.item as usize).find(|&j| j != i) else {
            return NearestNeighbours::default();
        };
        // From the coordinates as given, so that moving the window cannot round the distance.
        nearest.distances.push(window.distance(points[i], points[j]));
        nearest.indices.push(j);
    }
    nearest
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
