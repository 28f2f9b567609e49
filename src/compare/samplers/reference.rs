//! Reference curves: mean pair correlation functions of samplers, to compare mosaics with.
//!
//! 1. Find the mosaic's class: its number of points and window shape, both rounded ([`Class`]).
//! 2. Look the samplers' curves for this class up in the table that comes with the program
//!    ([`shipped`]).
//! 3. Compute missing curves from simulated patterns, once per class for all threads ([`Workers`]),
//!    and keep them in memory.

use super::curve_class::Class;
use super::realisation::{average, realise};
use super::shared_work::{Once, Workers};
use super::{CompareError, shipped};
use crate::geometry::Window;
use crate::sample::Sampler;
use crate::stats::{Pcf, PcfOptions};
use std::fmt;
use std::sync::Arc;

/// Mean pair correlation function of a sampler over many simulated patterns, for one number of
/// points and one shape of window.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceCurve {
    /// Name of the sampler.
    pub sampler: String,
    /// Mean pair correlation function. The field `spacing` of [`Pcf`] is the hexagonal spacing of
    /// `n` points in a window of area 1.
    pub pcf: Pcf,
    /// Number of points asked of the sampler: the mosaic's own number rounded to a power of 1.2, so
    /// the two may differ by about 10 %.
    pub n: usize,
    /// Number of simulated patterns over which the curve is averaged.
    pub realisations: usize,
    /// Mean regularity index of the patterns (all points, sample standard deviation); `None` if it
    /// is undefined, as for a perfect lattice.
    pub ri: Option<f64>,
    /// `true` if the curve was taken from the table that comes with the program, `false` if it was
    /// computed in this run. Both give the same curve, but the table rounds g to 10⁻⁴.
    pub shipped: bool,
}

/// Sampler that could not be compared with a mosaic, and the reason.
#[derive(Clone, Debug, PartialEq)]
pub struct NotCompared {
    /// Name of the sampler.
    pub sampler: String,
    /// Reason why the sampler has no curve for the mosaic.
    pub reason: CompareError,
}

impl fmt::Display for NotCompared {
    /// Writes “not compared with”, the name of the sampler and the reason, without naming the
    /// sampler a second time.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "not compared with {} (its l-infinity stays empty): ", self.sampler)?;
        match &self.reason {
            CompareError::Sample { source, .. } => source.fmt(f),
            CompareError::Stats { source, .. } => source.fmt(f),
            CompareError::NoPattern { n, .. } => {
                write!(f, "it placed fewer than 2 of {n} points, since the window is too narrow for it")
            }
            other => other.fmt(f),
        }
    }
}

/// Reference curves of samplers for one mosaic, and the samplers that have no curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SamplerCurves {
    /// Reference curves, in the order of the samplers.
    pub curves: Vec<ReferenceCurve>,
    /// Samplers without a curve, each with the reason.
    pub missing: Vec<NotCompared>,
}

/// Reference curves of samplers. Each is computed when first asked for, and then kept in memory.
///
/// Curves depend on the mosaic only through its class: the number of points and the aspect ratio of
/// the window, both rounded to steps of 20 %, and whether the window is a torus. Scale does not
/// matter, as distances are in hexagonal spacings. For a polygon without holes, the curve of the
/// rectangle with the same perimeter² / area is used. Elongated polygons have curves of their own,
/// and samplers that make lattices have a curve of their own for every polygon.
///
/// A curve of n points is the mean of 16 000/n patterns, but at least 4 and at most 60; from 20 000
/// points on it is the mean of 2 patterns, from 100 000 on a single one. The noise that remains in
/// a mean curve was measured as an l-infinity distance, for 100, 300, 1024 and 4096 points: .02–.03
/// for uniform points, .01–.03 for jittered points, .01–.017 for Poisson disks, and below .001 for
/// lattices.
///
/// Every pattern has its own random generator, seeded by a hash of the seed, the sampler's name,
/// the class and the pattern's index, so results do not depend on order or threads. Curves of the
/// default samplers, options and seed come with the program for the classes that are usual for
/// images.
pub struct References {
    setup: Arc<Setup>,
    /// Curves made so far. The key is a class and a flag that selects samplers: `true` for those
    /// that place points in rows along the sides of the window, `false` for all others.
    made: Once<(Class, bool), Arc<Vec<Made>>>,
    workers: Workers,
}

/// Index of a sampler in the list of samplers, with its curve or the reason why it has none.
type Made = (usize, Result<ReferenceCurve, CompareError>);

/// Settings that are the same for all classes: samplers, options of the curves, and seed.
struct Setup {
    samplers: Vec<&'static dyn Sampler>,
    options: PcfOptions,
    seed: u64,
}

impl References {
    /// Prepares reference curves of `samplers`, estimated with `options`; none is computed yet. The
    /// same `seed` gives the same curves.
    pub fn new(samplers: Vec<&'static dyn Sampler>, options: PcfOptions, seed: u64) -> Self {
        let setup = Arc::new(Setup { samplers, options, seed });
        Self { setup, made: Once::new(), workers: Workers::like_the_caller() }
    }

    /// Returns the samplers' curves for a mosaic of `n` points in `window`.
    ///
    /// For fewer than two points there are no curves, and every sampler is listed as missing.
    pub fn curves(&self, n: usize, window: &Window) -> SamplerCurves {
        let class = Class::of(n, window);
        // only samplers that do not place points in rows may use the curve of the stand-in class
        let groups = [(class.clone(), true), (class.stand_in(), false)].map(|group| {
            let made = || Arc::new(self.curves_of(n, &group.0, group.1));
            self.made.get(group.clone(), made)
        });
        let mut made: Vec<&Made> = groups.iter().flat_map(|group| group.iter()).collect();
        made.sort_by_key(|(place, _)| *place);
        let mut found = SamplerCurves::default();
        for (place, curve) in made {
            let sampler = self.setup.samplers[*place].name().to_owned();
            match curve {
                Ok(curve) => found.curves.push(curve.clone()),
                Err(reason) => found.missing.push(NotCompared { sampler, reason: reason.clone() }),
            }
        }
        found
    }

    /// Returns the curves of one class, from the table that comes with the program or computed now.
    /// `in_rows` selects either the samplers that place points in rows or all others.
    fn curves_of(&self, n: usize, class: &Class, in_rows: bool) -> Vec<Made> {
        let setup = &self.setup;
        let samplers = setup.samplers.iter().copied().enumerate().filter(|(_, s)| s.in_rows() == in_rows);
        if n < 2 {
            return samplers
                .map(|(place, _)| (place, Err(CompareError::TooFewPoints { found: n })))
                .collect();
        }
        let (mut made, mut unknown) = (Vec::new(), Vec::new());
        for (place, sampler) in samplers {
            match shipped::find(sampler, class, &setup.options, setup.seed) {
                Some(curve) => made.push((place, Ok(curve))),
                None => unknown.push((place, sampler)),
            }
        }
        let new = self.make(unknown.iter().map(|(_, sampler)| *sampler).collect(), class);
        made.extend(unknown.iter().map(|(place, _)| *place).zip(new));
        made
    }

    /// Computes the curve of each sampler, or returns the reason why the sampler has none. The
    /// patterns of all samplers form one list of tasks, so that all cores are busy until the end.
    pub(super) fn make(
        &self,
        samplers: Vec<&'static dyn Sampler>,
        class: &Class,
    ) -> Vec<Result<ReferenceCurve, CompareError>> {
        let each = class.realisations();
        let (count, setup, of) = (each * samplers.len(), Arc::clone(&self.setup), class.clone());
        let tasks = samplers.clone();
        let done = self.workers.all(count, move |task| {
            realise(tasks[task / each], &of, task % each, &setup.options, setup.seed)
        });
        samplers.iter().zip(done.chunks(each)).map(|(s, patterns)| average(*s, class, patterns)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::l_infinity;
    use crate::geometry::Point;
    use crate::sample::{Frame, SampleError, as_reference, sampler};
    use rand::Rng;
    use rayon::prelude::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn references(names: &[&str], seed: u64) -> References {
        let samplers = names.iter().map(|name| as_reference(sampler(name).unwrap())).collect();
        References::new(samplers, PcfOptions::default(), seed)
    }

    #[test]
    fn curves_come_in_the_order_of_the_samplers_with_their_regularity() {
        let curves = references(&["bridson", "uniform"], 1).curves(300, &Window::unit_square());
        let curves = &curves.curves;
        assert_eq!([&curves[0].sampler, &curves[1].sampler], ["bridson", "uniform"]);
        assert!(curves[0].ri.unwrap() > 10. && (curves[1].ri.unwrap() - 1.88).abs() < 0.1);
        assert!(curves[1].pcf.g.iter().all(|g| (g - 1.).abs() < 0.1));
        assert_eq!((curves[0].n, curves[0].realisations), (285, 56));
    }

    #[test]
    fn one_class_of_n_and_shape_is_made_once_and_shared() {
        /// Sampler that counts the patterns it makes.
        #[derive(Debug)]
        struct Counts(AtomicUsize);
        impl Sampler for Counts {
            fn name(&self) -> &'static str {
                "counts"
            }
            fn about(&self) -> &'static str {
                "a test"
            }
            fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
                self.0.fetch_add(1, Ordering::Relaxed);
                sampler("uniform")?.fill(n, frame, rng)
            }
        }
        static COUNTS: Counts = Counts(AtomicUsize::new(0));
        let references = References::new(vec![&COUNTS], PcfOptions::default(), 1);
        let made = |n: usize, window: &Window| {
            let before = COUNTS.0.load(Ordering::Relaxed);
            assert_eq!(references.curves(n, window).curves.len(), 1);
            COUNTS.0.load(Ordering::Relaxed) - before
        };
        let wide = Window::rectangle(5., 5., 305., 205.).unwrap();
        assert_eq!(made(300, &Window::rectangle(0., 0., 3., 2.).unwrap()), 56);
        assert_eq!(made(302, &wide), 0);
        assert!(made(330, &wide) > 0 && made(300, &Window::unit_square()) > 0);
    }

    fn polygon(corners: &[(f64, f64)]) -> Window {
        Window::polygon(vec![corners.iter().map(|&(x, y)| Point::new(x, y)).collect()]).unwrap()
    }

    #[test]
    fn a_polygon_has_the_curve_of_the_rectangle_that_its_own_hardly_differs_from() {
        let cut = polygon(&[(0.4, 0.), (1., 0.), (1., 1.), (0., 1.), (0., 0.3)]);
        let samplers = || ["dart-throwing", "uniform"].map(|name| sampler(name).unwrap()).to_vec();
        let references = References::new(samplers(), PcfOptions::default(), 3);
        let own = references.make(samplers(), &Class::of(300, &cut));
        for (a, b) in own.into_iter().zip(references.curves(300, &cut).curves) {
            let distance = l_infinity(&a.unwrap().pcf, &b.pcf).unwrap();
            assert!(distance > 0. && distance < 0.05, "{}: {distance}", b.sampler);
        }
    }

    #[test]
    fn lattices_and_long_polygons_have_curves_of_their_own() {
        let turned = polygon(&[(0., 0.), (1., 0.3), (0.7, 1.3), (-0.3, 1.)]);
        let thin = polygon(&[(0., 0.), (9., 0.3), (9., 1.3), (0., 1.)]);
        for (name, window) in [("triangular", &turned), ("jittered", &thin)] {
            let one = || vec![sampler(name).unwrap()];
            let references = References::new(one(), PcfOptions::default(), 1);
            let own = references.make(one(), &Class::of(150, window));
            assert_eq!(references.curves(150, window).curves, [own[0].clone().unwrap()], "{name}");
        }
    }

    #[test]
    fn mean_curve_is_within_its_stated_noise_of_another_seed() {
        let window = Window::unit_square();
        for (name, noise) in
            [("dart-throwing", 0.017), ("bridson", 0.017), ("jittered", 0.03), ("uniform", 0.03)]
        {
            let of = |seed| references(&[name], seed).curves(300, &window).curves[0].pcf.clone();
            let distance = l_infinity(&of(1), &of(2)).unwrap();
            // the difference of two noisy curves scatters √2 times as much as one; the factor 1.5
            // allows for chance
            assert!(distance < 1.5 * 2f64.sqrt() * noise, "{name}: {distance}");
        }
    }

    #[test]
    fn results_do_not_depend_on_threads_or_the_order_of_questions() {
        let window = Window::unit_square();
        let sizes: Vec<usize> = (0..24).map(|i| 30 + 17 * (i % 6)).collect();
        let alone = references(&["bridson", "jittered"], 7);
        let expected: Vec<_> = sizes.iter().map(|&n| alone.curves(n, &window)).collect();
        for threads in [1, 4] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let shared = references(&["bridson", "jittered"], 7);
            let found: Vec<_> =
                pool.install(|| sizes.par_iter().rev().map(|&n| shared.curves(n, &window)).collect());
            assert!(expected.iter().rev().eq(found.iter()));
        }
    }

    /// Sampler that distributes its work over threads, so that its own thread may meanwhile take up
    /// another request for curves.
    #[derive(Debug)]
    struct Parallel;

    impl Sampler for Parallel {
        fn name(&self) -> &'static str {
            "parallel"
        }
        fn about(&self) -> &'static str {
            "a test"
        }
        fn fill(&self, n: usize, _: &Frame, _: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
            let place = |i: usize| Point::new((i as f64 * 0.618).fract(), (i as f64 + 0.5) / n as f64);
            Ok((0..n).into_par_iter().with_max_len(2).map(place).collect())
        }
    }

    #[test]
    fn samplers_that_use_threads_themselves_cannot_deadlock() {
        static PARALLEL: Parallel = Parallel;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().unwrap();
        for seed in 0..20 {
            let shared = References::new(vec![&PARALLEL], PcfOptions::default(), seed);
            let answers: Vec<_> = pool.install(|| {
                (0..200).into_par_iter().map(|i| shared.curves(40 + i % 3, &Window::unit_torus())).collect()
            });
            // requests from inside and outside the thread pool must give the same curves
            for (i, answer) in answers.iter().enumerate() {
                assert_eq!(answer, &shared.curves(40 + i % 3, &Window::unit_torus()), "question {i}");
            }
        }
    }

    #[derive(Debug)]
    struct Panics;

    impl Sampler for Panics {
        fn name(&self) -> &'static str {
            "panics"
        }
        fn about(&self) -> &'static str {
            "a test"
        }
        fn fill(&self, _: usize, _: &Frame, _: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
            panic!("on purpose")
        }
    }

    #[test]
    fn panicking_sampler_is_an_error_for_all_who_wait() {
        static PANICS: Panics = Panics;
        let shared = References::new(vec![&PANICS], PcfOptions::default(), 0);
        let answers: Vec<_> =
            (0..4).into_par_iter().map(|_| shared.curves(1000, &Window::unit_square())).collect();
        let interrupted = |missing: &NotCompared| matches!(missing.reason, CompareError::Interrupted { .. });
        assert!(answers.iter().all(|a| a.curves.is_empty() && a.missing.iter().all(interrupted)));
        assert!(answers.iter().all(|a| a.missing.len() == 1));
    }

    #[test]
    fn what_cannot_be_compared_says_why() {
        let square = Window::unit_square();
        let reason = |references: &References, n: usize, window: &Window| {
            let found = references.curves(n, window);
            assert!(found.curves.is_empty());
            found.missing[0].to_string()
        };
        let few = reason(&references(&["uniform"], 1), 1, &square);
        assert_eq!(
            few,
            "not compared with uniform (its l-infinity stays empty): a comparison needs at least 2 points, found 1: \
             use a larger window"
        );
        let thread = Window::rectangle(0., 0., 1e9, 1.).unwrap();
        let thin = reason(&references(&["uniform"], 1), 100, &thread);
        assert!(thin.contains("with uniform (its l-infinity stays empty): the window is"), "{thin}");
        let options = PcfOptions { bandwidth: -1., ..PcfOptions::default() };
        let bad = References::new(vec![sampler("uniform").unwrap()], options, 1);
        assert!(reason(&bad, 100, &square).contains("bandwidth"));
    }

    #[test]
    fn one_sampler_that_fails_leaves_the_others_and_its_reason() {
        static PANICS: Panics = Panics;
        let both = References::new(vec![&PANICS, sampler("uniform").unwrap()], PcfOptions::default(), 2);
        let found = both.curves(100, &Window::unit_square());
        assert_eq!(
            (found.curves[0].sampler.as_str(), found.missing[0].sampler.as_str()),
            ("uniform", "panics")
        );
    }
}
