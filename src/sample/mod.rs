//! Point processes behind one trait. A new one is one file here and one line in [`samplers`].
//!
//! All work in any window. Distances of the Poisson-disk samplers are those of the torus in every window, so the
//! pattern has no border of its own; a bounded window then cuts it off as an image cuts off a mosaic.

mod bridson;
mod dart_throwing;
mod error;
mod frame;
mod jittered;
mod lattice;
mod square;
mod torus_grid;
mod triangular;
mod uniform;

pub use bridson::Bridson;
pub use dart_throwing::DartThrowing;
pub use error::SampleError;
pub use jittered::Jittered;
pub use square::Square;
pub use triangular::Triangular;
pub use uniform::Uniform;

use crate::geometry::{Point, Window};
use rand::Rng;

/// A way to put n points into a window.
pub trait Sampler: Send + Sync {
    /// The name users type: lower case, words joined by hyphens.
    fn name(&self) -> &'static str;

    /// One line: what it makes, its parameters, its source.
    fn about(&self) -> &'static str;

    /// About `n` points of `window` (exactly `n` where the method allows; [`Sampler::about`] says so), in the
    /// half-open ranges [x0, x1) and [y0, y1). The same generator state gives the same points.
    ///
    /// # Errors
    /// If `n` or the window is out of the method's range, or it found no room for `n` points.
    fn sample(&self, n: usize, window: &Window, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError>;
}

static SAMPLERS: [&dyn Sampler; 6] = [&Uniform, &Jittered, &Triangular, &Square, &DartThrowing, &Bridson];

/// Every sampler there is.
pub fn samplers() -> &'static [&'static dyn Sampler] {
    &SAMPLERS
}

/// The sampler of that name.
///
/// # Errors
/// If there is none; the error lists the names and the one closest to what was asked for.
pub fn sampler(name: &str) -> Result<&'static dyn Sampler, SampleError> {
    SAMPLERS.iter().copied().find(|s| s.name() == name).ok_or_else(|| {
        let names: Vec<&str> = SAMPLERS.iter().map(|s| s.name()).collect();
        SampleError::unknown(name, &names)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::{Deviation, moments, nearest_neighbours};
    use proptest::prelude::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn seeded(seed: u64) -> ChaCha8Rng {
        ChaCha8Rng::seed_from_u64(seed)
    }

    #[test]
    fn names_are_unique_and_found() {
        for (i, s) in samplers().iter().enumerate() {
            assert!(samplers()[..i].iter().all(|o| o.name() != s.name()));
            assert_eq!(sampler(s.name()).unwrap().name(), s.name());
            assert!(!s.about().contains('\n'));
        }
    }

    #[test]
    fn unknown_name_lists_the_names_and_the_closest() {
        let message = sampler("brideson").err().unwrap().to_string();
        assert!(message.contains("did you mean bridson?"), "{message}");
        assert!(!sampler("nonsense-of-its-own").err().unwrap().to_string().contains("did you mean"));
        assert!(samplers().iter().all(|s| message.contains(s.name())), "{message}");
    }

    /// METHODS §3: n = 1024 in the unit square, 12 seeds, all points, population deviation, plain distance.
    #[test]
    fn regularity_index_of_random_samplers_is_the_published_one() {
        for (name, expected, tolerance) in [
            ("uniform", 1.86, 0.05),
            ("jittered", 2.95, 0.05),
            ("dart-throwing", 13.7, 0.5),
            ("bridson", 12.1, 0.4),
        ] {
            let window = Window::unit_square();
            let mean = (0..12)
                .map(|seed| {
                    let points = sampler(name).unwrap().sample(1024, &window, &mut seeded(seed)).unwrap();
                    let nearest = nearest_neighbours(&points, &window);
                    moments(&nearest.distances, Deviation::Population).ri.unwrap()
                })
                .sum::<f64>()
                / 12.;
            assert!((mean - expected).abs() <= tolerance, "{name}: {mean}, expected {expected}");
        }
    }

    #[test]
    fn same_seed_gives_the_same_points_and_another_seed_others() {
        let window = Window::unit_square();
        for s in samplers() {
            let a = s.sample(100, &window, &mut seeded(1)).unwrap();
            assert_eq!(a, s.sample(100, &window, &mut seeded(1)).unwrap(), "{}", s.name());
            assert_ne!(a, s.sample(100, &window, &mut seeded(2)).unwrap(), "{}", s.name());
        }
    }

    #[test]
    fn numbers_beyond_memory_and_windows_like_threads_are_refused() {
        let thread = Window::rectangle(0., 0., 1e9, 1.).unwrap();
        for s in samplers() {
            let many = s.sample(usize::MAX, &Window::unit_square(), &mut seeded(1)).unwrap_err();
            assert!(matches!(many, SampleError::TooMany { .. }));
            assert!(matches!(s.sample(10, &thread, &mut seeded(1)), Err(SampleError::TooThin { .. })));
        }
    }

    proptest! {
        #[test]
        fn points_stay_inside_any_window_and_their_number_is_near(
            which in 0..samplers().len(), n in 0..200usize, torus: bool, seed: u64,
            x0 in -1e4..1e4f64, y0 in -1e4..1e4f64, w in 0.1..1e4f64, aspect in 0.1..10f64,
        ) {
            let bounds = crate::geometry::Rectangle::new(x0, y0, x0 + w, y0 + w * aspect).unwrap();
            let window = if torus { Window::Torus(bounds) } else { Window::Rectangle(bounds) };
            let s = samplers()[which];
            let points = s.sample(n, &window, &mut seeded(seed)).unwrap();
            for p in &points {
                prop_assert!(p.x >= bounds.x0() && p.x < bounds.x1() && p.y >= bounds.y0() && p.y < bounds.y1());
            }
            if matches!(s.name(), "uniform" | "jittered" | "dart-throwing") || n == 0 {
                prop_assert_eq!(points.len(), n);
            } else if n >= 50 {
                // few rows of a lattice close on a narrow torus: their number jumps
                prop_assert!((points.len() as f64 / n as f64).ln().abs() < 0.6, "{} of {}", points.len(), n);
            } else {
                prop_assert!(points.len() <= 2 * n + 10);
            }
        }
    }
}
