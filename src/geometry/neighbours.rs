use super::{Point, Rectangle, Window};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use rayon::prelude::*;
use serde::Serialize;
use std::num::NonZero;

/// Points from which on all threads look for neighbours.
const SPREAD_FROM: usize = 8192;

/// For every point the nearest other point; both empty for fewer than two points.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
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
    let other = |(i, &p): (usize, &Point)| {
        let j = finder.nearest(p, two).find(|&j| j != i)?;
        // From the coordinates as given, so that moving the window cannot round the distance.
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

/// Distance from each of `places` to the nearest of `points`, the short way round on a torus; infinite without points,
/// and if a coordinate of theirs is not finite.
pub fn distances_to_nearest(places: &[Point], points: &[Point], window: &Window) -> Vec<f64> {
    let finder = if points.is_empty() { None } else { Finder::new(points, window) };
    let Some(finder) = finder else { return vec![f64::INFINITY; places.len()] };
    let buckets = Buckets::new(points, window);
    let distance = |&place: &Point| {
        let near = buckets.nearest(place);
        let found = near.or_else(|| finder.nearest(place, NonZero::<usize>::MIN).next());
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

/// Points by the cells of a grid, about one a cell: where they lie evenly, the nearest is found sooner than in a tree.
struct Buckets<'a> {
    points: &'a [Point],
    bounds: Rectangle,
    torus: bool,
    columns: usize,
    rows: usize,
    /// Where each cell begins among `indices`; one more than there are cells.
    starts: Vec<usize>,
    indices: Vec<usize>,
}

impl<'a> Buckets<'a> {
    /// Of finite points.
    fn new(points: &'a [Point], window: &Window) -> Self {
        let bounds = window.bounds();
        let side = (bounds.area() / points.len().max(1) as f64).sqrt();
        let along = |length: f64| ((length / side) as usize).clamp(1, points.len().max(1));
        let (columns, rows) = (along(bounds.width()), along(bounds.height()));
        let mut buckets = Self {
            points,
            bounds,
            torus: window.is_torus(),
            columns,
            rows,
            starts: vec![0; columns * rows + 1],
            indices: Vec::new(),
        };
        let cells: Vec<usize> = points
            .iter()
            .map(|&p| {
                let (column, row) = buckets.cell(p);
                row * columns + column
            })
            .collect();
        for cell in &cells {
            buckets.starts[cell + 1] += 1;
        }
        for i in 1..buckets.starts.len() {
            buckets.starts[i] += buckets.starts[i - 1];
        }
        let mut next = buckets.starts.clone();
        buckets.indices = vec![0; points.len()];
        for (index, cell) in cells.into_iter().enumerate() {
            buckets.indices[next[cell]] = index;
            next[cell] += 1;
        }
        buckets
    }

    /// Column and row; of a place outside those of the nearest cell.
    fn cell(&self, p: Point) -> (usize, usize) {
        let b = &self.bounds;
        let column = (p.x - b.x0()) / b.width() * self.columns as f64;
        let row = (p.y - b.y0()) / b.height() * self.rows as f64;
        ((column as usize).min(self.columns - 1), (row as usize).min(self.rows - 1))
    }

    /// The nearest point, if it is sure to be among those of the 5 × 5 cells around a place: no other can be nearer. `None` near the
    /// edges of a torus, beyond which it goes on.
    fn nearest(&self, place: Point) -> Option<usize> {
        let (column, row) = self.cell(place);
        let b = &self.bounds;
        let (width, height) = (b.width() / self.columns as f64, b.height() / self.rows as f64);
        let mut best = (f64::INFINITY, 0);
        for reach in 1..=2 {
            let beyond =
                [column < reach, column + reach >= self.columns, row < reach, row + reach >= self.rows];
            if self.torus && beyond.contains(&true) {
                return None;
            }
            let columns = column.saturating_sub(reach)..(column + reach + 1).min(self.columns);
            let rows = row.saturating_sub(reach)..(row + reach + 1).min(self.rows);
            for row in rows.clone() {
                let line = row * self.columns;
                for &index in
                    &self.indices[self.starts[line + columns.start]..self.starts[line + columns.end]]
                {
                    let (dx, dy) = (self.points[index].x - place.x, self.points[index].y - place.y);
                    let d2 = dx * dx + dy * dy;
                    if d2 < best.0 {
                        best = (d2, index);
                    }
                }
            }
            let sides = [
                place.x - (b.x0() + columns.start as f64 * width),
                b.x0() + columns.end as f64 * width - place.x,
                place.y - (b.y0() + rows.start as f64 * height),
                b.y0() + rows.end as f64 * height - place.y,
            ];
            // beyond the bounds there is no point
            let open = sides.into_iter().zip(beyond).filter(|(_, beyond)| !beyond);
            // rounding must not let a nearer one be missed
            let sure = open.map(|(side, _)| side).fold(f64::INFINITY, f64::min) * (1. - 1e-9);
            if sure > 0. && best.0.is_finite() && best.0 <= sure * sure {
                return Some(best.1);
            }
        }
        None
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
