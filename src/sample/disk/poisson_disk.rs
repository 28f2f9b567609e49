//! Maximal Poisson-disk sampling: darts are thrown until there is no room for another.

use super::darts::throw;
use crate::geometry::Point;
use crate::geometry::index::TorusGrid;
use crate::sample::{Frame, SampleError, Sampler};
use rand::Rng;

/// Fraction of the plane that disks whose diameter is the smallest distance cover when there is no
/// room for another.
///
/// Source: Feder (1980), <https://doi.org/10.1016/0022-5193(80)90358-6>: .547.
const JAMMED: f64 = 0.547;
/// Relative enlargement of the radius, so that rounding cannot bring points nearer than the radius.
const MARGIN: f64 = 1e-9;

/// Maximal Poisson disks: darts are thrown until there is no room for another.
///
/// No two points are nearer to each other than r on the torus. With r = √(4 · .547/(π n/A)) = .7766
/// hexagonal spacings, where A is the area, the window is full at about n points. The number varies
/// by about 1 % at n = 1024. In windows narrower than r, it is the number of disks that fill a
/// line, which may be far from n. The area that remains uncovered is smaller than 2⁻⁵⁰ of that of a
/// disk.
///
/// Sources: Ebeida et al. (2011) for the term, <https://doi.org/10.1145/2010324.1964944>; White,
/// Cline and Egbert (2007) for the quadtree, <https://doi.org/10.1109/RT.2007.4342600>.
#[derive(Clone, Copy, Debug)]
pub struct PoissonDisk;

impl PoissonDisk {
    /// Returns the smallest distance between two points for about `n` points, in the frame's unit.
    ///
    /// No position is farther than this distance from every point.
    fn radius(n: usize, frame: &Frame) -> f64 {
        (4. * JAMMED * frame.width * frame.height / (std::f64::consts::PI * n as f64)).sqrt()
    }
}

impl Sampler for PoissonDisk {
    fn name(&self) -> &'static str {
        "poisson-disk"
    }

    fn about(&self) -> &'static str {
        "maximal Poisson disks: darts at least 0.777 spacings apart on the torus, until no place is left; \
         about n points (Ebeida et al. 2011)"
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        if n == 0 {
            return Ok(Vec::new());
        }
        let radius = Self::radius(n, frame) * (1. + MARGIN);
        let mut grid = TorusGrid::new(frame.width, frame.height, radius);
        let points = throw(usize::MAX, radius, &mut grid, rng);
        Ok(points.into_iter().map(|[x, y]| frame.place(x, y)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Rectangle, Window};
    use crate::stats::nearest_neighbours;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn number_of_points_is_within_two_per_cent() {
        for seed in 0..20 {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let n = PoissonDisk.sample(1024, &Window::unit_square(), &mut rng).unwrap().len();
            assert!((1004..=1044).contains(&n), "seed {seed}: {n}");
        }
    }

    #[test]
    fn no_two_points_are_nearer_than_the_radius_and_no_place_is_left() {
        for (n, height) in [(3, 1.), (50, 0.05), (1500, 1.), (300, 3.)] {
            let torus = Window::Torus(Rectangle::new(0., 0., 1., height).unwrap());
            let mut rng = ChaCha8Rng::seed_from_u64(n as u64);
            let points = PoissonDisk.sample(n, &torus, &mut rng).unwrap();
            let radius = PoissonDisk::radius(n, &Frame::new(n, &torus).unwrap());
            let nearest = nearest_neighbours(&points, &torus);
            assert!(nearest.distances.iter().all(|&d| d >= radius));
            for _ in 0..20_000 {
                let place = Point::new(rng.random(), rng.random::<f64>() * height);
                let room = points.iter().all(|&p| torus.distance(p, place) >= radius * (1. + 1e-6));
                assert!(!room, "n {n}: room at {place:?}");
            }
        }
    }
}
