//! Random point patterns to compare mosaics with: point processes behind one trait, [`Sampler`].
//!
//! Every sampler works in any window. The Poisson-disk samplers always measure distances on a
//! torus, so the pattern has no border of its own; a bounded window then cuts the pattern off as an
//! image cuts off a mosaic. A polygon is cut out of a pattern that fills the polygon's bounds.
//!
//! To add a sampler, add a file here, declare its module, re-export its type and enter it in the
//! registry `SAMPLERS` below.
//!
//! # Examples
//! ```
//! use conemosaic::geometry::Rectangle;
//! use conemosaic::prelude::*;
//! use conemosaic::sample::{sampler, samplers};
//! use rand::SeedableRng;
//!
//! let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(4);
//! let torus = Window::Torus(Rectangle::new(0., 0., 1., 1.)?);
//! let points = sampler("bnot")?.sample(64, &torus, &mut rng)?;
//! assert_eq!(points.len(), 64);
//!
//! // the same method with another parameter, in a polygon
//! let lattice = sampler("triangular")?.configure(&[("jitter", "0.1")])?;
//! let corners = [(0., 0.), (100., 0.), (50., 80.)].map(|(x, y)| Point::new(x, y));
//! let triangle = Window::polygon(vec![corners.to_vec()])?;
//! let inside = lattice.sample(200, &triangle, &mut rng)?;
//! assert!(inside.iter().all(|&p| triangle.contains(p)));
//!
//! for sampler in samplers() {
//!     println!("{:<16} {}", sampler.name(), sampler.about());
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

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
mod sampler;
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
pub use parameter::{Configure, Parameter, Settable, Setting};
pub use retinal::{Ahumada, CurcioSloan, Deering, MinimalSpacing, Wang};
pub use sampler::{Sampler, Watch};
pub use shaped::{GREEN, NearestTarget, Noise, PINK, Shaped, Step, TargetCurve};
pub use uniform::Uniform;

use self::sampler::{cut, nearest_in_number};

/// Registry of all samplers, in the order in which they are listed.
///
/// The samplers used by default come first, ordered from the least to the most regular, and then
/// all others.
static SAMPLERS: &[&dyn Sampler] = &[
    &Uniform,
    &Jittered,
    &Bridson,
    &DartThrowing,
    &Bnot::CONVERGED,
    &Triangular::DEFAULT,
    &Square::DEFAULT,
    &PoissonDisk,
    &GREEN,
    &PINK,
    &Step::HIGHEST,
    &Lloyd::DEFAULT,
    &Ahumada::DEFAULT,
    &CurcioSloan::DEFAULT,
    &Wang::DEFAULT,
    &MinimalSpacing::DEFAULT,
    &Deering::DEFAULT,
];

/// Returns all samplers, in the order in which they are listed.
pub fn samplers() -> &'static [&'static dyn Sampler] {
    SAMPLERS
}

/// Returns the samplers called `names`, each once, in the setting with which mosaics are compared.
///
/// The name `all` stands for every sampler. The name `none` drops all samplers named before it. If
/// `names` is empty, the default samplers are returned, see [`samplers_by_default`].
///
/// # Errors
/// Fails if one of the names belongs to no sampler; the error lists all names.
pub fn samplers_named(names: &[String]) -> Result<Vec<&'static dyn Sampler>, SampleError> {
    if names.is_empty() {
        return Ok(samplers_by_default());
    }
    let mut found: Vec<&'static dyn Sampler> = Vec::new();
    for name in names {
        let chosen = match name.trim() {
            "all" => SAMPLERS.to_vec(),
            "none" => {
                found.clear();
                continue;
            }
            name => vec![sampler(name)?],
        };
        for one in chosen.into_iter().map(as_reference) {
            if !found.iter().any(|s| s.name() == one.name()) {
                found.push(one);
            }
        }
    }
    Ok(found)
}

/// Returns the default samplers, with which mosaics are compared unless the user names others.
///
/// Each sampler is in the setting with which mosaics are compared, see [`as_reference`].
pub fn samplers_by_default() -> Vec<&'static dyn Sampler> {
    SAMPLERS.iter().copied().filter(|s| s.by_default()).map(as_reference).collect()
}

/// Returns the sampler in the setting with which mosaics are compared.
///
/// That setting is the default one unless [`Sampler::as_reference`] returns another.
pub fn as_reference(sampler: &'static dyn Sampler) -> &'static dyn Sampler {
    sampler.as_reference().unwrap_or(sampler)
}

/// Returns the sampler called `name`.
///
/// # Errors
/// Fails if no sampler has that name; the error lists all names and suggests a similar one.
pub fn sampler(name: &str) -> Result<&'static dyn Sampler, SampleError> {
    SAMPLERS.iter().copied().find(|s| s.name() == name).ok_or_else(|| {
        let names: Vec<&str> = SAMPLERS.iter().map(|s| s.name()).collect();
        SampleError::unknown(name, &names)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, Window};
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
            assert_eq!(s.about().contains("exactly n"), s.exact(), "{}", s.name());
            assert_eq!(s.about().contains("no torus"), !s.periodic(), "{}", s.name());
        }
    }

    #[test]
    fn names_choose_samplers_once_and_none_chooses_none() {
        let chosen = |names: &[&str]| -> Vec<&str> {
            let names: Vec<String> = names.iter().map(|n| (*n).to_owned()).collect();
            samplers_named(&names).unwrap().iter().map(|s| s.name()).collect()
        };
        assert_eq!(chosen(&[]), ["uniform", "jittered", "bridson", "dart-throwing", "bnot", "triangular"]);
        assert_eq!(chosen(&["square", " uniform", "square"]), ["square", "uniform"]);
        assert_eq!(chosen(&["all"]).len(), samplers().len());
        assert!(chosen(&["none"]).is_empty());
        assert!(samplers_named(&["nothing".to_owned()]).is_err());
        assert_eq!(samplers_named(&["bnot".to_owned()]).unwrap()[0].parameters()[0].default, Some(20.));
    }

    #[test]
    fn unknown_name_lists_the_names_and_the_closest() {
        let message = sampler("brideson").err().unwrap().to_string();
        assert!(message.contains("did you mean bridson?"), "{message}");
        assert!(!sampler("nonsense-of-its-own").err().unwrap().to_string().contains("did you mean"));
        assert!(samplers().iter().all(|s| message.contains(s.name())), "{message}");
    }

    /// The conditions of Table 1 of Lanaro et al. (2020): n = 1024 in the unit square, all points,
    /// population standard deviation, Euclidean (not toroidal) distance; the mean of 12 seeds.
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
            // a side of the L includes or excludes an entire row of a lattice, which holds 12 to 40
            // points
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
            if s.exact() || n == 0 {
                prop_assert_eq!(points.len(), n);
            } else if n >= 50 {
                // a lattice of few rows must close on a narrow torus, so the number of points jumps
                prop_assert!((points.len() as f64 / n as f64).ln().abs() < 0.6, "{} of {}", points.len(), n);
            } else {
                prop_assert!(points.len() <= 2 * n + 10);
            }
        }
    }
}
