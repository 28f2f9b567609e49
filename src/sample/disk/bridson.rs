//! Bridson's Poisson-disk sampling: new points are sought around points placed before.

use crate::geometry::Point;
use crate::geometry::index::{Nearby, TorusGrid};
use crate::sample::{Frame, SampleError, Sampler};
use rand::{Rng, RngExt};

/// Smallest distance between two points, in hexagonal spacings; with this value the method places
/// about n points.
const RADIUS: f64 = 0.7306;
/// Number of candidates tried around a point before it is no longer active; the k = 30 of Bridson
/// (2007).
const CANDIDATES: usize = 30;
/// Relative enlargement of the radius, so that rounding cannot bring points nearer than the radius.
const MARGIN: f64 = 1e-9;

/// Poisson-disk points by Bridson's method, in O(n).
///
/// 1. Place one point at random; it is active.
/// 2. Pick an active point at random. Draw up to k = 30 candidates around it, uniform *by area* in
///    the annulus from r to 2r, where r is .7306 hexagonal spacings.
/// 3. The first candidate that is at least r (on the torus) from every point becomes an active
///    point itself. If no candidate is, the picked point is no longer active. Repeat from 2 until
///    no point is active.
///
/// The number of points varies by about 1 % at n = 1024, and is smaller than n in windows a few
/// radii wide. In windows narrower than r it is the number of disks that fill a line, which may be
/// far from n.
///
/// Source: Bridson (2007), <https://doi.org/10.1145/1278780.1278807>.
#[derive(Clone, Copy, Debug)]
pub struct Bridson;

impl Sampler for Bridson {
    fn name(&self) -> &'static str {
        "bridson"
    }

    fn about(&self) -> &'static str {
        "Poisson disks grown around earlier points (30 candidates each), at least 0.7306 spacings apart on \
         the torus; about n points (Bridson 2007)"
    }

    fn by_default(&self) -> bool {
        true
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        if n == 0 {
            return Ok(Vec::new());
        }
        let radius = RADIUS * frame.spacing(n) * (1. + MARGIN);
        let radius2 = radius * radius;
        let mut grid = TorusGrid::new(frame.width, frame.height, radius);
        let mut points: Vec<[f64; 2]> = Vec::with_capacity(n + n / 16 + 1);
        let mut active: Vec<usize> = vec![0];
        let start = [rng.random::<f64>() * frame.width, rng.random::<f64>() * frame.height];
        points.push(start);
        grid.insert(start[0], start[1]);
        let mut near = Nearby::default();
        let mut offsets = Offsets::default();
        while !active.is_empty() {
            let picked = rng.random_range(0..active.len());
            let [x, y] = points[active[picked]];
            // A candidate is at most 2r away and only points nearer than r reject it, so points
            // beyond 3r do not matter.
            grid.gather(x, y, 3. * radius, &mut near);
            let found = (0..CANDIDATES).find_map(|_| {
                let [dx, dy] = offsets.next(rng);
                let (x, y) = (x + radius * dx, y + radius * dy);
                (!near.any_nearer(x, y, radius2)).then_some((x, y))
            });
            if let Some((x, y)) = found {
                let (x, y) = (x.rem_euclid(frame.width), y.rem_euclid(frame.height));
                active.push(points.len());
                points.push([x, y]);
                grid.insert(x, y);
            } else {
                active.swap_remove(picked);
            }
        }
        Ok(points.into_iter().map(|[x, y]| frame.place(x, y)).collect())
    }
}

/// Supply of random offsets, uniform by area in the annulus between the radii 1 and 2 around the
/// origin.
///
/// Darts are thrown into the square around the annulus, and those that hit the annulus are kept.
/// The offsets do not depend on the points around which they are used, so many are drawn at once.
#[derive(Default)]
struct Offsets {
    /// Offsets that have not been used yet.
    ready: Vec<[f64; 2]>,
    /// Buffer for random bytes.
    bits: Vec<u8>,
}

impl Offsets {
    /// Number of darts thrown per refill of the supply.
    const DARTS: usize = 512;

    #[inline]
    fn next(&mut self, rng: &mut dyn Rng) -> [f64; 2] {
        loop {
            if let Some(offset) = self.ready.pop() {
                return offset;
            }
            self.refill(rng);
        }
    }

    fn refill(&mut self, rng: &mut dyn Rng) {
        self.bits.resize(8 * Self::DARTS, 0);
        rng.fill_bytes(&mut self.bits);
        self.ready.resize(Self::DARTS, [0.; 2]);
        let mut hits = 0;
        for dart in self.bits.chunks_exact(8) {
            // 32 bits per coordinate resolve 2⁻³⁰ of the radius.
            let coordinate = |at: usize| {
                let half = u32::from_le_bytes([dart[at], dart[at + 1], dart[at + 2], dart[at + 3]]);
                (f64::from(half) + 0.5) * 2f64.powi(-30) - 2.
            };
            let (x, y) = (coordinate(0), coordinate(4));
            // Each dart is written and then kept only if it hits: a branch here could not be
            // predicted.
            self.ready[hits] = [x, y];
            let square = x * x + y * y;
            hits += usize::from((1. ..4.).contains(&square));
        }
        self.ready.truncate(hits);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Window;
    use crate::stats::nearest_neighbours;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn number_of_points_is_within_two_per_cent() {
        for seed in 0..20 {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let n = Bridson.sample(1024, &Window::unit_square(), &mut rng).unwrap().len();
            assert!((1004..=1044).contains(&n), "seed {seed}: {n}");
        }
    }

    #[test]
    fn no_two_points_are_nearer_than_the_radius_on_the_torus() {
        for (n, height) in [(3, 1.), (50, 0.05), (5000, 1.), (700, 3.)] {
            let torus = Window::Torus(crate::geometry::Rectangle::new(0., 0., 1., height).unwrap());
            let mut rng = ChaCha8Rng::seed_from_u64(n as u64);
            let points = Bridson.sample(n, &torus, &mut rng).unwrap();
            let radius = RADIUS * crate::mosaic::hexagonal_spacing(n, torus.area()).unwrap();
            let nearest = nearest_neighbours(&points, &torus);
            assert!(nearest.distances.iter().all(|&d| d >= radius));
        }
    }

    #[test]
    fn candidates_are_uniform_by_area() {
        let mut rng = ChaCha8Rng::seed_from_u64(0);
        let mut offsets = Offsets::default();
        let draws = 40_000;
        let inner = (0..draws).filter(|_| {
            let [x, y] = offsets.next(&mut rng);
            x * x + y * y < 2.5
        });
        // Half the area of the annulus lies within √2.5; the tolerance is five standard deviations.
        assert!((inner.count() as f64 / f64::from(draws) - 0.5).abs() < 0.0125);
    }
}
