use super::{CompareError, curve, draw, mean_curve};
use crate::geometry::{Polygon, Rectangle, Window};
use crate::mosaic::hexagonal_spacing;
use crate::sample::{SampleError, Sampler};
use crate::stats::{Deviation, Pcf, PcfOptions, moments, nearest_neighbours};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use sha2::{Digest, Sha256};
use std::cell::Cell;
use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

/// Ratio of successive classes of n and of aspect. Mean curves at 250, 275, 300 and 330 points differ by no more (.002–.011 of seven samplers)
/// than the noise that a mean over 58 realisations leaves (.006–.02).
const CLASS: f64 = 1.2;
/// Points drawn for one curve, over all realisations.
const POINTS_PER_CURVE: f64 = 16_000.;
/// Bounds on the number of realisations, below [`LARGE`] points.
const REALISATIONS: (usize, usize) = (4, 60);
/// From here on 2 realisations, from five times as many on 1: large patterns scatter little and cost much.
const LARGE: usize = 20_000;

/// What a sampler looks like at some n in a window of some shape: the mean over realisations.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceCurve {
    /// Name of the sampler.
    pub sampler: String,
    /// Mean pair correlation function; its spacing is that of `n` points in a window of area 1.
    pub pcf: Pcf,
    /// Number of points asked of the sampler: the middle of the mosaic's class.
    pub n: usize,
    /// Patterns averaged.
    pub realisations: usize,
    /// Mean regularity index (all points, sample deviation); `None` where it is not defined, as for a lattice.
    pub ri: Option<f64>,
}

type Curves = Result<Arc<Vec<ReferenceCurve>>, CompareError>;

/// Curves of samplers, made when first asked for and kept.
///
/// They depend on the mosaic only through its n, in classes 20 % apart, the proportions of its window, likewise, and whether
/// that is a torus: distances in spacings have no scale. Each polygon has curves of its own.
///
/// The number of realisations is 16 000/n, but at least 4 and at most 60 (2 from 20 000 points on, 1 from 100 000). Measured
/// noise of a mean curve that leaves, as l-infinity: uniform .02–.03, jittered .01–.03, Poisson disks .01–.017 at
/// n = 100, 300, 1024 and 4096; lattices below .001.
///
/// Every realisation has its own generator, seeded by a hash of the seed, the sampler's name, the classes and its number,
/// so results do not depend on order or threads.
///
/// # Threads
/// Threads that ask for the same curves at the same time share the work: each takes realisations off one list until
/// none is left and then waits for those under way. A realisation runs to its end on its thread; should it hand out work and
/// its thread meanwhile be given something that asks for curves, that is answered by private work instead of waiting.
/// So no wait can hang on what lies below it on the same stack, and rayon's stealing cannot deadlock.
pub struct References {
    setup: Arc<Setup>,
    jobs: Mutex<HashMap<Class, Arc<Job>>>,
}

struct Setup {
    samplers: Vec<&'static dyn Sampler>,
    options: PcfOptions,
    seed: u64,
}

impl References {
    /// Curves of `samplers`, estimated with `options`; the same `seed` gives the same curves.
    pub fn new(samplers: Vec<&'static dyn Sampler>, options: PcfOptions, seed: u64) -> Self {
        Self { setup: Arc::new(Setup { samplers, options, seed }), jobs: Mutex::new(HashMap::new()) }
    }

    /// The samplers' curves, in their order, for a mosaic of `n` points in `window`.
    ///
    /// # Errors
    /// If there are fewer than two points, an option is out of range, or a sampler cannot fill such a window.
    pub fn curves(&self, n: usize, window: &Window) -> Curves {
        if n < 2 {
            return Err(CompareError::TooFewPoints { found: n });
        }
        let class = Class::of(n, window);
        let mut created = false;
        let job = lock(&self.jobs)
            .entry(class.clone())
            .or_insert_with(|| {
                created = true;
                Arc::new(Job::new(class, Arc::clone(&self.setup)))
            })
            .clone();
        if let Some(curves) = job.finished() {
            return curves;
        }
        if BUSY.get() {
            return job.privately();
        }
        if created {
            for _ in 1..rayon::current_num_threads().min(job.tasks) {
                let job = Arc::clone(&job);
                rayon::spawn(move || job.work());
            }
        }
        job.work();
        job.wait()
    }
}

thread_local! {
    /// Whether this thread has a realisation on its stack.
    static BUSY: Cell<bool> = const { Cell::new(false) };
}

/// A panic elsewhere leaves the data of these locks whole: they change by single steps.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What curves depend on. Classes are powers of [`CLASS`].
#[derive(Clone, PartialEq, Eq, Hash)]
struct Class {
    n: i32,
    shape: Shape,
}

/// Rectangles by their proportions; polygons each for itself.
#[derive(Clone, PartialEq, Eq, Hash)]
enum Shape {
    Rectangle { aspect: i32, torus: bool },
    Polygon(Polygon),
}

impl Class {
    fn of(n: usize, window: &Window) -> Self {
        let nearest = |v: f64| (v.ln() / CLASS.ln()).round() as i32;
        let shape = match window {
            Window::Rectangle(bounds) | Window::Torus(bounds) => Shape::Rectangle {
                aspect: nearest(bounds.width() / bounds.height()),
                torus: window.is_torus(),
            },
            Window::Polygon(polygon) => Shape::Polygon(polygon.clone()),
        };
        Self { n: nearest(n as f64), shape }
    }

    fn points(&self) -> usize {
        (CLASS.powi(self.n).round() as usize).max(2)
    }

    /// A rectangle of area 1, or the polygon; `None` if the proportions are beyond numbers.
    fn window(&self) -> Option<Window> {
        match &self.shape {
            Shape::Rectangle { aspect, torus } => {
                let width = CLASS.powi(*aspect).sqrt();
                let bounds = Rectangle::new(0., 0., width, 1. / width).ok()?;
                Some(if *torus { Window::Torus(bounds) } else { Window::Rectangle(bounds) })
            }
            Shape::Polygon(polygon) => Some(Window::Polygon(polygon.clone())),
        }
    }

    /// What tells the generators of its realisations from those of other shapes.
    fn seed(&self) -> Vec<u8> {
        match &self.shape {
            Shape::Rectangle { aspect, torus } => {
                let mut bytes = aspect.to_le_bytes().to_vec();
                bytes.push(u8::from(*torus));
                bytes
            }
            Shape::Polygon(polygon) => polygon.bytes(),
        }
    }

    fn realisations(&self) -> usize {
        let n = self.points();
        match n {
            _ if n >= 5 * LARGE => 1,
            _ if n >= LARGE => 2,
            _ => ((POINTS_PER_CURVE / n as f64).round() as usize).clamp(REALISATIONS.0, REALISATIONS.1),
        }
    }
}

/// One pattern of a sampler; without a curve where the sampler made fewer than two points.
struct Realisation {
    pcf: Option<Pcf>,
    ri: Option<f64>,
}

/// All realisations of all samplers for a class, on one list.
struct Job {
    class: Class,
    setup: Arc<Setup>,
    tasks: usize,
    next: AtomicUsize,
    progress: Mutex<Progress>,
    complete: Condvar,
}

struct Progress {
    done: Vec<Option<Result<Realisation, CompareError>>>,
    left: usize,
    curves: Option<Curves>,
}

impl Job {
    fn new(class: Class, setup: Arc<Setup>) -> Self {
        let tasks = setup.samplers.len() * class.realisations();
        let curves = (tasks == 0).then(|| Ok(Arc::default()));
        let progress = Progress { done: (0..tasks).map(|_| None).collect(), left: tasks, curves };
        Self {
            class,
            setup,
            tasks,
            next: AtomicUsize::new(0),
            progress: Mutex::new(progress),
            complete: Condvar::new(),
        }
    }

    fn finished(&self) -> Option<Curves> {
        lock(&self.progress).curves.clone()
    }

    /// Takes realisations off the list until there is none. Whoever ends the last one makes the curves.
    fn work(&self) {
        loop {
            let task = self.next.fetch_add(1, Ordering::Relaxed);
            if task >= self.tasks {
                return;
            }
            let outcome = self.realise(task);
            let mut progress = lock(&self.progress);
            progress.done[task] = Some(outcome);
            progress.left -= 1;
            if progress.left == 0 {
                let done = std::mem::take(&mut progress.done);
                progress.curves = Some(self.average(done.into_iter().flatten()));
                self.complete.notify_all();
            }
        }
    }

    fn wait(&self) -> Curves {
        let mut progress = lock(&self.progress);
        loop {
            if let Some(curves) = &progress.curves {
                return curves.clone();
            }
            progress = self.complete.wait(progress).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn privately(&self) -> Curves {
        self.average((0..self.tasks).map(|task| self.realise(task)))
    }

    fn sampler_of(&self, task: usize) -> &'static dyn Sampler {
        self.setup.samplers[task / self.class.realisations()]
    }

    fn realise(&self, task: usize) -> Result<Realisation, CompareError> {
        let was_busy = BUSY.replace(true);
        // Others wait for this task: a sampler's panic must reach them as an error.
        let outcome = catch_unwind(AssertUnwindSafe(|| self.attempt(task)));
        BUSY.set(was_busy);
        outcome.unwrap_or_else(|_| {
            Err(CompareError::Interrupted { sampler: self.sampler_of(task).name().to_owned() })
        })
    }

    fn attempt(&self, task: usize) -> Result<Realisation, CompareError> {
        let (class, sampler) = (&self.class, self.sampler_of(task));
        let too_thin = || CompareError::Sample {
            sampler: sampler.name().to_owned(),
            source: SampleError::TooThin { aspect: f64::INFINITY, max: f64::MAX },
        };
        let window = class.window().ok_or_else(too_thin)?;
        let mut hash = Sha256::new();
        hash.update(self.setup.seed.to_le_bytes());
        hash.update((sampler.name().len() as u64).to_le_bytes());
        hash.update(sampler.name());
        hash.update(class.n.to_le_bytes());
        hash.update(class.seed());
        hash.update(((task % class.realisations()) as u64).to_le_bytes());
        let mut rng = ChaCha8Rng::from_seed(hash.finalize().into());
        let points = draw(sampler, class.points(), &window, &mut rng)?;
        if points.len() < 2 {
            return Ok(Realisation { pcf: None, ri: None });
        }
        let pcf = curve(sampler, &points, &window, &self.setup.options)?;
        let nearest = nearest_neighbours(&points, &window);
        Ok(Realisation { pcf: Some(pcf), ri: moments(&nearest.distances, Deviation::Sample).ri })
    }

    /// Means over each sampler's realisations, given in the order of tasks.
    fn average(&self, done: impl Iterator<Item = Result<Realisation, CompareError>>) -> Curves {
        let done: Vec<_> = done.collect();
        let realisations = self.class.realisations();
        let n = self.class.points();
        let curves = self.setup.samplers.iter().zip(done.chunks(realisations)).map(|(sampler, patterns)| {
            let patterns = patterns.iter().map(|p| p.as_ref()).collect::<Result<Vec<_>, _>>();
            let patterns = patterns.map_err(Clone::clone)?;
            let pcfs: Vec<&Pcf> = patterns.iter().filter_map(|p| p.pcf.as_ref()).collect();
            let Some(mean) = mean_curve(&pcfs) else {
                return Err(CompareError::TooFewPoints { found: n.min(1) });
            };
            let indexes: Vec<f64> = patterns.iter().filter_map(|p| p.ri).collect();
            Ok(ReferenceCurve {
                sampler: sampler.name().to_owned(),
                pcf: Pcf { spacing: hexagonal_spacing(n, 1.).unwrap_or(mean.spacing), ..mean },
                n,
                realisations: pcfs.len(),
                ri: moments(&indexes, Deviation::Sample).mean,
            })
        });
        // a sampler that cannot fill this window is left out, unless none can
        let (made, refused): (Vec<_>, Vec<_>) = curves.partition(Result::is_ok);
        let made: Vec<ReferenceCurve> = made.into_iter().flatten().collect();
        match refused.into_iter().find_map(Result::err) {
            Some(error) if made.is_empty() => Err(error),
            _ => Ok(Arc::new(made)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::l_infinity;
    use crate::geometry::Point;
    use crate::sample::{Frame, sampler};
    use rand::Rng;
    use rayon::prelude::*;

    fn references(names: &[&str], seed: u64) -> References {
        let samplers = names.iter().map(|name| sampler(name).unwrap()).collect();
        References::new(samplers, PcfOptions::default(), seed)
    }

    #[test]
    fn curves_come_in_the_order_of_the_samplers_with_their_regularity() {
        let curves = references(&["bridson", "uniform"], 1).curves(300, &Window::unit_square()).unwrap();
        assert_eq!([&curves[0].sampler, &curves[1].sampler], ["bridson", "uniform"]);
        assert!(curves[0].ri.unwrap() > 10. && (curves[1].ri.unwrap() - 1.88).abs() < 0.1);
        assert!(curves[1].pcf.g.iter().all(|g| (g - 1.).abs() < 0.1));
        assert_eq!((curves[0].n, curves[0].realisations), (285, 56));
    }

    #[test]
    fn one_class_of_n_and_shape_is_made_once_and_shared() {
        let references = references(&["uniform"], 1);
        let wide = Window::rectangle(5., 5., 305., 205.).unwrap();
        let first = references.curves(300, &Window::rectangle(0., 0., 3., 2.).unwrap()).unwrap();
        assert!(Arc::ptr_eq(&first, &references.curves(302, &wide).unwrap()));
        assert!(!Arc::ptr_eq(&first, &references.curves(330, &wide).unwrap()));
        assert!(!Arc::ptr_eq(&first, &references.curves(300, &Window::unit_square()).unwrap()));
    }

    #[test]
    fn a_polygon_has_curves_of_its_own_that_hardly_differ_from_a_rectangle_s() {
        let corners = [(0., 0.), (3., 0.), (3., 1.), (1., 1.), (1., 2.), (0., 2.)];
        let ring = || vec![corners.iter().map(|&(x, y)| Point::new(x, y)).collect::<Vec<_>>()];
        let (l, again) = (Window::polygon(ring()).unwrap(), Window::polygon(ring()).unwrap());
        let references = references(&["dart-throwing", "uniform"], 1);
        let curves = references.curves(300, &l).unwrap();
        assert!(Arc::ptr_eq(&curves, &references.curves(300, &again).unwrap()));
        let square = references.curves(300, &Window::unit_square()).unwrap();
        for (a, b) in curves.iter().zip(square.iter()) {
            let distance = l_infinity(&a.pcf, &b.pcf).unwrap();
            assert!(distance < 0.07, "{}: {distance}", a.sampler);
        }
    }

    #[test]
    fn mean_curve_is_within_its_stated_noise_of_another_seed() {
        let window = Window::unit_square();
        for (name, noise) in
            [("dart-throwing", 0.017), ("bridson", 0.017), ("jittered", 0.03), ("uniform", 0.03)]
        {
            let of = |seed| references(&[name], seed).curves(300, &window).unwrap()[0].pcf.clone();
            let distance = l_infinity(&of(1), &of(2)).unwrap();
            // Of two noisy curves, and half as much again for chance.
            assert!(distance < 1.5 * 2f64.sqrt() * noise, "{name}: {distance}");
        }
    }

    #[test]
    fn results_do_not_depend_on_threads_or_the_order_of_questions() {
        let window = Window::unit_square();
        let sizes: Vec<usize> = (0..24).map(|i| 30 + 17 * (i % 6)).collect();
        let alone = references(&["bridson", "jittered"], 7);
        let expected: Vec<_> = sizes.iter().map(|&n| alone.curves(n, &window).unwrap()).collect();
        for threads in [1, 4] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let shared = references(&["bridson", "jittered"], 7);
            let found: Vec<_> = pool
                .install(|| sizes.par_iter().rev().map(|&n| shared.curves(n, &window).unwrap()).collect());
            assert!(expected.iter().rev().eq(found.iter()));
        }
    }

    /// Hands its work to other threads, so that its thread may meanwhile be given another question.
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
            // Private work and shared work come to the same curves.
            for (i, answer) in answers.iter().enumerate() {
                assert_eq!(answer, &shared.curves(40 + i % 3, &Window::unit_torus()), "question {i}");
            }
        }
    }

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
        assert!(answers.iter().all(|a| matches!(a, Err(CompareError::Interrupted { .. }))));
    }

    #[test]
    fn what_cannot_be_compared_says_why() {
        let square = Window::unit_square();
        assert_eq!(
            references(&["uniform"], 1).curves(1, &square),
            Err(CompareError::TooFewPoints { found: 1 })
        );
        let thread = Window::rectangle(0., 0., 1e9, 1.).unwrap();
        let thin = references(&["uniform"], 1).curves(100, &thread);
        assert!(matches!(thin, Err(CompareError::Sample { .. })), "{thin:?}");
        let options = PcfOptions { bandwidth: -1., ..PcfOptions::default() };
        let bad = References::new(vec![sampler("uniform").unwrap()], options, 1).curves(100, &square);
        assert!(matches!(bad, Err(CompareError::Stats { .. })));
    }
}
