use crate::geometry::{Point, Window};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use serde::{Deserialize, Serialize};
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

/// Points whose distance to the border is at least the distance to their nearest neighbour: for them no neighbour
/// beyond the border could have been nearer. All points of a torus.
pub fn interior(points: &[Point], window: &Window, nearest: &NearestNeighbours) -> Vec<bool> {
    points.iter().zip(&nearest.distances).map(|(&p, &d)| window.border_distance(p) >= d).collect()
}

/// The divisor of the variance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Deviation {
    /// n − 1: of a sample.
    #[default]
    Sample,
    /// n: of the population, as in the tables of Lanaro et al.
    Population,
}

/// Mean, standard deviation and their ratio.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Moments {
    /// How many values.
    pub n: usize,
    /// μ; `None` without values.
    pub mean: Option<f64>,
    /// σ; `None` with fewer values than its divisor needs.
    pub sd: Option<f64>,
    /// μ/σ, of nearest-neighbour distances the regularity (conformity) index (Wässle & Riemann 1978, Cook 1996). `None`
    /// without σ, and where σ is nothing but rounding (below 10⁻¹² μ): all values are equal, and the index of a perfect
    /// lattice is no number.
    pub ri: Option<f64>,
}

/// Relative deviation below which values are equal up to rounding.
const ROUNDING: f64 = 1e-12;

/// Moments of `values`; all `None` if one is not finite.
pub fn moments(values: &[f64], deviation: Deviation) -> Moments {
    let n = values.len();
    if n == 0 || values.iter().any(|v| !v.is_finite()) {
        return Moments { n, ..Moments::default() };
    }
    let mean = values.iter().sum::<f64>() / n as f64;
    let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    let divisor = match deviation {
        Deviation::Sample => n - 1,
        Deviation::Population => n,
    };
    let sd = (divisor > 0).then(|| (squares / divisor as f64).sqrt());
    let ri = sd.filter(|&sd| sd > ROUNDING * mean.abs()).map(|sd| mean / sd);
    Moments { n, mean: Some(mean), sd, ri }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn moments_of_one_to_five() {
        let values = [1., 2., 3., 4., 5.];
        let sample = moments(&values, Deviation::Sample);
        assert_eq!((sample.n, sample.mean, sample.sd), (5, Some(3.), Some(2.5f64.sqrt())));
        assert_eq!(sample.ri, Some(3. / 2.5f64.sqrt()));
        assert_eq!(moments(&values, Deviation::Population).sd, Some(2f64.sqrt()));
    }

    #[test]
    fn what_is_not_defined_is_none() {
        assert_eq!(moments(&[], Deviation::Sample), Moments::default());
        let one = moments(&[2.], Deviation::Sample);
        assert_eq!((one.mean, one.sd, one.ri), (Some(2.), None, None));
        let equal = moments(&[2.; 4], Deviation::Sample);
        assert_eq!((equal.sd, equal.ri), (Some(0.), None));
        assert_eq!(moments(&[1., f64::NAN], Deviation::Sample).mean, None);
    }

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

    #[test]
    fn interior_points_are_farther_from_the_border_than_from_their_neighbour() {
        let points = [Point::new(0.5, 0.5), Point::new(0.5, 0.6), Point::new(0.95, 0.5)];
        let window = Window::unit_square();
        assert_eq!(interior(&points, &window, &nearest_neighbours(&points, &window)), [true, true, false]);
        let torus = Window::unit_torus();
        assert_eq!(interior(&points, &torus, &nearest_neighbours(&points, &torus)), [true; 3]);
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
