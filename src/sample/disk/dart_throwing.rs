//! Dart throwing: the classical Poisson-disk pattern with exactly n points.

use super::darts::throw;
use crate::geometry::Point;
use crate::geometry::index::TorusGrid;
use crate::sample::{Frame, SampleError, Sampler};
use rand::Rng;

/// Smallest distance between two points, in hexagonal spacings of n points. Random darts leave no
/// room for n points from about .777 spacings on.
const RADIUS: f64 = 0.75;
/// Relative enlargement of the radius, so that rounding cannot bring points nearer than the radius.
const MARGIN: f64 = 1e-9;
/// Largest number of attempts to place n points; an attempt ends early if the torus is full before
/// the last point.
const ATTEMPTS: usize = 200;

/// Uniform darts, each kept if it is at least the distance r from every dart kept before, until
/// exactly n are kept.
///
/// r is .75 hexagonal spacings of n points, distances are those of the torus, and points are not
/// relaxed afterwards. No darts are thrown at positions nearer than r to a kept dart, which changes
/// only the running time. If no other position is left, the window is full, and a new pattern is
/// begun, up to 200 times.
///
/// Sources: Cook (1986), <https://doi.org/10.1145/7529.8927>; White, Cline and Egbert (2007),
/// <https://doi.org/10.1109/RT.2007.4342600>.
#[derive(Clone, Copy, Debug)]
pub struct DartThrowing;

impl Sampler for DartThrowing {
    fn name(&self) -> &'static str {
        "dart-throwing"
    }

    fn about(&self) -> &'static str {
        "uniform darts, kept if at least 0.75 spacings from all earlier ones on the torus, not relaxed; \
         exactly n (Cook 1986)"
    }

    fn exact(&self) -> bool {
        true
    }

    fn by_default(&self) -> bool {
        true
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Rectangle, Window};
    use crate::mosaic::hexagonal_spacing;
    use crate::stats::{Deviation, moments, nearest_neighbours};
    use rand::{RngExt, SeedableRng};
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

    /// Throws darts over the entire torus, as the definition says.
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
}
