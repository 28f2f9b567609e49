//! Point processes behind one trait. A new one is one file here and one line in [`samplers`].
//!
//! All work in any window. Distances of the Poisson-disk samplers are those of the torus in every window, so the
//! pattern has no border of its own; a bounded window then cuts it off as an image cuts off a mosaic. A polygon is cut
//! out of a pattern of its bounds.

mod bnot;
mod density;
mod disk;
mod error;
mod frame;
mod jittered;
mod lattice;
mod lloyd;
mod normal_deviate;
mod parameter;
mod relaxed_region;
mod retinal;
mod shaped;
mod uniform;

pub use bnot::Bnot;
pub use density::Density;
pub use disk::{Bridson, DartThrowing, PoissonDisk};
pub use error::SampleError;
pub use frame::Frame;
pub use jittered::Jittered;
pub use lattice::{Square, Triangular};
pub use lloyd::Lloyd;
pub use parameter::{Parameter, Values};
pub use retinal::{Ahumada, CurcioSloan, Deering, MinimalSpacing, Wang};
pub use shaped::{GREEN, NearestTarget, Noise, PINK, Shaped, Step, TargetCurve};
pub use uniform::Uniform;

use crate::geometry::{Point, Polygon, Window};
use rand::Rng;

/// A way to put n points into a window.
pub trait Sampler: Send + Sync {
    /// The name users type: lower case, words joined by hyphens.
    fn name(&self) -> &'static str;

    /// One line: what it makes, its parameters, its source.
    fn about(&self) -> &'static str;

    /// About `n` points of `frame` (exactly `n` where the method allows; [`Sampler::about`] says so), in the half-open
    /// ranges of its bounds. The same generator state gives the same points.
    ///
    /// # Errors
    /// If `n` is out of the method's range, or it found no room for `n` points.
    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError>;

    /// What can be set by [`Sampler::configure`].
    fn parameters(&self) -> &'static [Parameter] {
        &[]
    }

    /// The same method with other parameters, given as (name, value); [`Values::read`] checks them.
    ///
    /// # Errors
    /// If there is no such parameter or the value is out of its range.
    fn configure(&self, settings: &[(&str, &str)]) -> Result<Box<dyn Sampler>, SampleError> {
        Values::read(self.name(), self.parameters(), settings)?;
        // reached without settings only
        Err(SampleError::unknown_parameter(self.name(), "", self.parameters()))
    }

    /// The same method for points as dense as `density` says, if it can; otherwise `None`.
    fn with_density(&self, _density: &Density) -> Option<Box<dyn Sampler>> {
        None
    }

    /// Whether mosaics are compared with it unless others are named: not with those that are slow, or that make no mosaic.
    fn by_default(&self) -> bool {
        true
    }

    /// The setting of it that mosaics are compared with, where that is not the default one.
    fn as_reference(&self) -> Option<&'static dyn Sampler> {
        None
    }

    /// [`Sampler::fill`] for methods that take long: `progress` hears of steps done, of how many at most.
    ///
    /// # Errors
    /// As [`Sampler::fill`].
    fn fill_watched(
        &self,
        n: usize,
        frame: &Frame,
        rng: &mut dyn Rng,
        _progress: &mut Watch<'_>,
    ) -> Result<Vec<Point>, SampleError> {
        self.fill(n, frame, rng)
    }

    /// [`Sampler::sample_watched`] without a listener.
    ///
    /// # Errors
    /// As there.
    fn sample(&self, n: usize, window: &Window, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        self.sample_watched(n, window, rng, &mut |_, _| ())
    }

    /// About `n` points of `window`, by [`Sampler::fill`]: the bounds of a rectangle or torus are filled.
    ///
    /// A polygon is cut out of a pattern of the same density in its bounds. How many points it holds is left to chance;
    /// patterns are drawn until their number is within .5 % of `n`, at most 32, and the nearest is taken.
    ///
    /// # Errors
    /// If `n` or the window is out of the method's range, or it found no room for the points.
    fn sample_watched(
        &self,
        n: usize,
        window: &Window,
        rng: &mut dyn Rng,
        progress: &mut Watch<'_>,
    ) -> Result<Vec<Point>, SampleError> {
        match window {
            Window::Polygon(polygon) => {
                cut(n, polygon, polygon.area() / polygon.bounds().area(), |n, frame| {
                    self.fill_watched(n, frame, rng, progress)
                })
            }
            Window::Rectangle(_) | Window::Torus(_) => {
                self.fill_watched(n, &Frame::new(n, window)?, rng, progress)
            }
        }
    }
}

/// What hears of a sampler's progress: steps done, and of how many at most.
pub type Watch<'a> = dyn FnMut(usize, usize) + 'a;

/// The pattern nearest to `n` points in number that a polygon cuts out of fillings of its bounds, of whose points it
/// holds about `share`.
fn cut(
    n: usize,
    polygon: &Polygon,
    share: f64,
    mut fill: impl FnMut(usize, &Frame) -> Result<Vec<Point>, SampleError>,
) -> Result<Vec<Point>, SampleError> {
    let bounds = polygon.bounds();
    let filled = (n as f64 / share).round() as usize;
    let frame = Frame::new(filled, &Window::Rectangle(bounds))?;
    nearest_in_number(n, CUTS, || {
        let mut points = fill(filled, &frame)?;
        points.retain(|&p| polygon.contains(p));
        Ok(points)
    })
}

/// Of at most `tries` patterns the one whose number of points is nearest to `n`; one that is near enough ends the search.
fn nearest_in_number(
    n: usize,
    tries: usize,
    mut pattern: impl FnMut() -> Result<Vec<Point>, SampleError>,
) -> Result<Vec<Point>, SampleError> {
    let mut best: Option<(usize, Vec<Point>)> = None;
    for _ in 0..tries {
        let points = pattern()?;
        let miss = points.len().abs_diff(n);
        if best.as_ref().is_none_or(|(least, _)| miss < *least) {
            best = Some((miss, points));
        }
        if miss as f64 <= CLOSE * n as f64 {
            break;
        }
    }
    Ok(best.map(|(_, points)| points).unwrap_or_default())
}

/// Most patterns drawn to cut a polygon out of, and how near, as a share of n, a number must come to end the search.
const CUTS: usize = 32;
const CLOSE: f64 = 0.005;

static SAMPLERS: &[&dyn Sampler] = &[
    &Uniform,
    &Jittered,
    &Triangular::DEFAULT,
    &Square::DEFAULT,
    &DartThrowing,
    &Bridson,
    &PoissonDisk,
    &GREEN,
    &PINK,
    &Step::HIGHEST,
    &Lloyd::DEFAULT,
    &Bnot::CONVERGED,
    &Ahumada::DEFAULT,
    &CurcioSloan::DEFAULT,
    &Wang::DEFAULT,
    &MinimalSpacing::DEFAULT,
    &Deering::DEFAULT,
];

/// Every sampler there is.
pub fn samplers() -> &'static [&'static dyn Sampler] {
    SAMPLERS
}

/// The samplers that mosaics are compared with if none are named, each in the setting for that.
pub fn samplers_by_default() -> Vec<&'static dyn Sampler> {
    SAMPLERS.iter().copied().filter(|s| s.by_default()).map(as_reference).collect()
}

/// The setting of a sampler that mosaics are compared with.
pub fn as_reference(sampler: &'static dyn Sampler) -> &'static dyn Sampler {
    sampler.as_reference().unwrap_or(sampler)
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
    use crate::stats::{Deviation, interior, moments, nearest_neighbours};
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

    #[test]
    fn every_sampler_fills_a_polygon_with_about_n_points_of_its_own_regularity() {
        let corners = [(0., 0.), (3., 0.), (3., 1.), (1., 1.), (1., 2.), (0., 2.)];
        let ring = corners.iter().map(|&(x, y)| Point::new(x, y)).collect();
        let polygon = Window::polygon(vec![ring]).unwrap();
        let rectangle = Window::rectangle(0., 0., 2., 2.).unwrap();
        for s in samplers().iter().copied().map(as_reference) {
            // rows of a lattice that the sides of the L take or leave hold 12 to 40 points
            let most = if matches!(s.name(), "square" | "triangular") { 30 } else { 3 };
            let n = s.sample(600, &polygon, &mut seeded(1)).unwrap().len();
            assert!(n.abs_diff(600) <= most, "{}: {n}", s.name());
            let ri = |window: &Window, seed: u64| {
                let points = s.sample(600, window, &mut seeded(seed)).unwrap();
                assert!(points.iter().all(|&p| window.contains(p)));
                let nearest = nearest_neighbours(&points, window);
                let inside = interior(&points, window, &nearest);
                let kept = inside.iter().zip(&nearest.distances).filter_map(|(&keep, &d)| keep.then_some(d));
                moments(&kept.collect::<Vec<f64>>(), Deviation::Sample).ri
            };
            let means = [&polygon, &rectangle].map(|w| {
                let all: Vec<f64> = (0..10).filter_map(|seed| ri(w, seed)).collect();
                all.iter().sum::<f64>() / all.len().max(1) as f64
            });
            assert!((means[0] - means[1]).abs() <= 0.05 * means[1], "{}: {means:?}", s.name());
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
            let s = as_reference(samplers()[which]);
            let points = s.sample(n, &window, &mut seeded(seed)).unwrap();
            for p in &points {
                prop_assert!(p.x >= bounds.x0() && p.x < bounds.x1() && p.y >= bounds.y0() && p.y < bounds.y1());
            }
            if s.about().contains("exactly n") || n == 0 {
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
