use super::torus_grid::{Nearby, TorusGrid};
use super::{Frame, SampleError, Sampler};
use crate::geometry::Point;
use rand::{Rng, RngExt};

/// Disk radius in hexagonal spacings.
const RADIUS: f64 = 0.75;
/// Distances are kept this much (relative) above the radius, so that rounding cannot violate it.
const MARGIN: f64 = 1e-9;
/// How often to begin when the window ran full before the last point.
const ATTEMPTS: usize = 200;
/// Squares halved this often count as covered: their share of the area is below 2⁻⁵⁰.
const DEEPEST: usize = 25;

/// Dart throwing with radius r = .75 hexagonal spacings of n points, torus distance, no relaxation: uniform darts, kept
/// when no earlier one is nearer than r, until there are n (Cook 1986).
///
/// Darts are thrown only over squares of a quadtree that may still have room (White, Cline & Egbert 2007): a square in
/// which a dart missed is cut in four, and quarters that one disk covers are dropped. Dropped squares could never
/// have taken a dart and the dart within the rest is uniform, so the points have exactly the law of plain darts. When
/// no square is left, the window is full: start anew, up to 200 times.
#[derive(Clone, Copy, Debug)]
pub struct DartThrowing;

impl Sampler for DartThrowing {
    fn name(&self) -> &'static str {
        "dart-throwing"
    }

    fn about(&self) -> &'static str {
        "uniform darts kept when none is nearer than r = 0.75 spacings, torus distance, no relaxation (Cook 1986); exactly n"
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        if n == 0 {
            return Ok(Vec::new());
        }
        let radius = RADIUS * frame.spacing(n) * (1. + MARGIN);
        let mut grid = TorusGrid::new(frame.width, frame.height, radius);
        let mut placed = 0;
        for _ in 0..ATTEMPTS {
            let points = throw(n, radius, &mut grid, rng);
            if points.len() == n {
                return Ok(points.into_iter().map(|[x, y]| frame.place(x, y)).collect());
            }
            placed = placed.max(points.len());
        }
        Err(SampleError::NoRoom { sampler: self.name(), n, placed, attempts: ATTEMPTS })
    }
}

/// Darts until there are `n` or the torus is full.
fn throw(n: usize, radius: f64, grid: &mut TorusGrid, rng: &mut dyn Rng) -> Vec<[f64; 2]> {
    grid.clear();
    let radius2 = radius * radius;
    let mut squares = Squares::new(grid);
    let mut points = Vec::with_capacity(n);
    let mut near = Nearby::default();
    while points.len() < n {
        let Some((level, [left, top])) = squares.take(rng) else { break };
        let (width, height) = squares.size(level);
        let half = [width / 2., height / 2.];
        let reach = radius + half[0].hypot(half[1]);
        grid.gather(left + half[0], top + half[1], reach, &mut near);
        let (u, v): (f64, f64) = (rng.random(), rng.random());
        let dart = [left + u * width, top + v * height];
        if !near.any_nearer(dart[0], dart[1], radius2) {
            // The square is gone with its dart: a disk covers any square of its grid cell.
            grid.insert(dart[0], dart[1]);
            points.push(dart);
            continue;
        }
        if level == DEEPEST {
            continue;
        }
        for (column, row) in [(0., 0.), (1., 0.), (0., 1.), (1., 1.)] {
            let corner = [left + column * half[0], top + row * half[1]];
            let quarter = [half[0] / 2., half[1] / 2.];
            let covered = near.any_covers(corner[0] + quarter[0], corner[1] + quarter[1], quarter, radius2);
            if !covered {
                squares.put(level + 1, corner);
            }
        }
    }
    points
}

/// Squares (rectangles of the grid's proportions) that may have room, by how often they were halved.
struct Squares {
    corners: Vec<Vec<[f64; 2]>>,
    /// Deepest level that ever held a square.
    deepest: usize,
    width: f64,
    height: f64,
}

impl Squares {
    fn new(grid: &TorusGrid) -> Self {
        let (width, height) = grid.cell_size();
        let mut corners = vec![Vec::new(); DEEPEST + 1];
        corners[0] = (0..grid.rows())
            .flat_map(|row| {
                (0..grid.columns()).map(move |column| [column as f64 * width, row as f64 * height])
            })
            .collect();
        Self { corners, deepest: 0, width, height }
    }

    fn size(&self, level: usize) -> (f64, f64) {
        let scale = 0.5f64.powi(level as i32);
        (self.width * scale, self.height * scale)
    }

    fn put(&mut self, level: usize, corner: [f64; 2]) {
        self.corners[level].push(corner);
        self.deepest = self.deepest.max(level);
    }

    /// Removes a square chosen with probability proportional to its area.
    fn take(&mut self, rng: &mut dyn Rng) -> Option<(usize, [f64; 2])> {
        let mut areas = [0.; DEEPEST + 1];
        let (mut total, mut share) = (0., 1.);
        for (area, squares) in areas.iter_mut().zip(&self.corners[..=self.deepest]) {
            *area = share * squares.len() as f64;
            total += *area;
            share /= 4.;
        }
        let mut left = rng.random::<f64>() * total;
        let mut chosen = None;
        for (level, area) in areas.iter().enumerate().filter(|(_, area)| **area > 0.) {
            chosen = Some(level);
            left -= area;
            if left < 0. {
                break;
            }
        }
        let level = chosen?;
        let squares = &mut self.corners[level];
        let picked = rng.random_range(0..squares.len());
        Some((level, squares.swap_remove(picked)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Rectangle, Window};
    use crate::mosaic::hexagonal_spacing;
    use crate::stats::{Deviation, moments, nearest_neighbours};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn exactly_n_points_no_two_nearer_than_the_radius_on_the_torus() {
        for (n, height) in [(1, 1.), (2, 1.), (3, 1.), (5, 2.), (7, 1.), (40, 0.05), (2000, 1.), (300, 7.)] {
            let torus = Window::Torus(Rectangle::new(0., 0., 1., height).unwrap());
            let mut rng = ChaCha8Rng::seed_from_u64(n as u64);
            let points = DartThrowing.sample(n, &torus, &mut rng).unwrap();
            assert_eq!(points.len(), n);
            let radius = RADIUS * hexagonal_spacing(n, torus.area()).unwrap();
            let nearest = nearest_neighbours(&points, &torus);
            assert!(nearest.distances.iter().all(|&d| d >= radius));
        }
    }

    /// Darts over the whole torus, as the definition says.
    fn plain_darts(n: usize, rng: &mut ChaCha8Rng) -> Vec<Point> {
        let radius = RADIUS * hexagonal_spacing(n, 1.).unwrap();
        let torus = Window::unit_torus();
        loop {
            let mut points: Vec<Point> = Vec::new();
            for _ in 0..20_000 {
                let dart = Point::new(rng.random(), rng.random());
                if points.iter().all(|&p| torus.distance(p, dart) >= radius) {
                    points.push(dart);
                    if points.len() == n {
                        return points;
                    }
                }
            }
        }
    }

    #[test]
    fn quadtree_of_free_squares_gives_the_law_of_plain_darts() {
        let n = 60;
        let torus = Window::unit_torus();
        let sample_of = |make: &mut dyn FnMut() -> Vec<Point>| -> (f64, f64) {
            let values: Vec<f64> = (0..150)
                .map(|_| {
                    let nearest = nearest_neighbours(&make(), &torus);
                    moments(&nearest.distances, Deviation::Sample).mean.unwrap()
                })
                .collect();
            let m = moments(&values, Deviation::Sample);
            (m.mean.unwrap(), m.sd.unwrap() / 150f64.sqrt())
        };
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let (plain, plain_error) = sample_of(&mut || plain_darts(n, &mut rng));
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        let (fast, fast_error) = sample_of(&mut || DartThrowing.sample(n, &torus, &mut rng).unwrap());
        let error = plain_error.hypot(fast_error);
        assert!((plain - fast).abs() < 3.5 * error, "{plain} and {fast}, standard error {error}");
    }

    #[test]
    fn full_window_is_an_error_that_says_how_many_fitted() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut grid = TorusGrid::new(1., 1., 0.2);
        let placed = throw(1000, 0.2, &mut grid, &mut rng).len();
        // A saturated torus holds between the loosest maximal packing and the densest.
        assert!((8..29).contains(&placed), "{placed}");
    }
}
