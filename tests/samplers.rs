//! What every sampler in the registry promises, whatever it is.

use conemosaic::geometry::{Point, Rectangle, Window};
use conemosaic::sample::{Sampler, samplers, samplers_by_default};
use conemosaic::stats::nearest_neighbours;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

fn seeded(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

fn promises_exactly_n(sampler: &dyn Sampler) -> bool {
    sampler.about().contains("exactly n")
}

/// Whether a point lies in the half-open ranges of the window's bounds.
fn within(bounds: &Rectangle, p: &Point) -> bool {
    p.x >= bounds.x0() && p.x < bounds.x1() && p.y >= bounds.y0() && p.y < bounds.y1()
}

#[test]
fn few_points_and_extreme_windows_give_correct_points_or_an_error() {
    let mut windows = Vec::new();
    for aspect in [1e-5, 1e-3, 1., 30., 1e4] {
        windows.push(Rectangle::new(0., 0., 1., 1. / aspect).unwrap());
    }
    for size in [1e-100, 1e-9, 1e9, 1e100] {
        windows.push(Rectangle::new(-size, size, size, 3. * size).unwrap());
    }
    // far from the origin, where a coordinate has few digits left
    windows.push(Rectangle::new(1e12, -1e12, 1e12 + 1., 1. - 1e12).unwrap());
    for sampler in samplers() {
        for bounds in &windows {
            for window in [Window::Rectangle(*bounds), Window::Torus(*bounds)] {
                for n in [0, 1, 2, 3, 7] {
                    let name = format!("{}, n {n}, {window:?}", sampler.name());
                    match sampler.sample(n, &window, &mut seeded(1)) {
                        Ok(points) => {
                            assert!(points.iter().all(|p| within(bounds, p)), "{name}");
                            let exact = n == 0 || promises_exactly_n(*sampler);
                            assert!(!exact || points.len() == n, "{name}: {}", points.len());
                        }
                        Err(error) => assert!(!error.to_string().is_empty()),
                    }
                }
            }
        }
    }
}

#[test]
fn those_that_promise_exactly_n_points_make_them_and_the_others_come_near() {
    let bounds = Rectangle::new(-3., 5., 9., 10.).unwrap();
    for sampler in samplers() {
        for window in [Window::Rectangle(bounds), Window::Torus(bounds)] {
            for n in [10, 97, 640] {
                let found = sampler.sample(n, &window, &mut seeded(n as u64)).unwrap().len();
                // rows of a lattice come and go as a whole
                let most =
                    if promises_exactly_n(*sampler) { 0 } else { 2 + (1.5 * (n as f64).sqrt()) as usize };
                assert!(found.abs_diff(n) <= most, "{}, {n}: {found}", sampler.name());
            }
        }
    }
}

/// Where a torus is promised nothing tells its seam: neighbours across it are as near as anywhere, on average.
#[test]
fn the_seam_of_a_torus_does_not_show() {
    let torus = Window::unit_torus();
    for sampler in samplers().iter().filter(|s| !s.about().contains("no torus")) {
        let (mut seam, mut middle) = (Vec::new(), Vec::new());
        for seed in 0..20 {
            let points = sampler.sample(400, &torus, &mut seeded(seed)).unwrap();
            let nearest = nearest_neighbours(&points, &torus);
            for (p, d) in points.iter().zip(nearest.distances) {
                let border = p.x.min(1. - p.x).min(p.y).min(1. - p.y);
                if border < 0.025 { seam.push(d) } else { middle.push(d) }
            }
        }
        let mean = |d: &[f64]| d.iter().sum::<f64>() / d.len() as f64;
        let spread =
            |d: &[f64]| d.iter().map(|v| (v - mean(d)).powi(2)).sum::<f64>() / (d.len() as f64).powi(2);
        let error = (spread(&seam) + spread(&middle)).sqrt();
        let apart = (mean(&seam) - mean(&middle)).abs();
        assert!(apart <= 4. * error + 1e-9, "{}: {apart}, standard error {error}", sampler.name());
    }
}

/// The defaults that are listed are those that hold, and no value in a parameter's range is a trap.
#[test]
fn parameters_at_their_defaults_change_nothing_and_at_their_limits_give_points_or_an_error() {
    let window = Window::rectangle(0., 0., 2., 1.).unwrap();
    for sampler in samplers() {
        let usual = sampler.sample(60, &window, &mut seeded(3)).unwrap();
        for parameter in sampler.parameters() {
            let name = format!("{} {}", sampler.name(), parameter.name);
            if parameter.default.parse::<f64>().is_ok() {
                let same = sampler.configure(&[(parameter.name, parameter.default)]).unwrap();
                assert_eq!(same.sample(60, &window, &mut seeded(3)).unwrap(), usual, "{name}");
            }
            // a relaxation of a million steps is no trap, but takes its time
            let most = if parameter.whole { parameter.range.1.min(1000.) } else { parameter.range.1 };
            for limit in [parameter.range.0, most].into_iter().filter(|v| v.is_finite()) {
                let at_limit = sampler.configure(&[(parameter.name, &limit.to_string())]).unwrap();
                assert_eq!(at_limit.name(), sampler.name());
                for n in [0, 1, 2, 60] {
                    if let Ok(points) = at_limit.sample(n, &window, &mut seeded(3)) {
                        assert!(points.iter().all(|&p| window.contains(p)), "{name} = {limit}");
                    }
                }
            }
        }
    }
}

#[test]
fn jitter_makes_a_lattice_less_regular_and_keeps_its_number_near() {
    for name in ["square", "triangular"] {
        let lattice = conemosaic::sample::sampler(name).unwrap();
        for window in [Window::unit_square(), Window::unit_torus()] {
            let scatter = |jitter: &str| {
                let lattice = lattice.configure(&[("jitter", jitter)]).unwrap();
                let points = lattice.sample(900, &window, &mut seeded(1)).unwrap();
                assert!(points.len().abs_diff(900) <= 40, "{name}: {}", points.len());
                let d = nearest_neighbours(&points, &window).distances;
                let mean = d.iter().sum::<f64>() / d.len() as f64;
                d.iter().map(|v| (v / mean - 1.).powi(2)).sum::<f64>() / d.len() as f64
            };
            let found = ["0", "0.05", "0.15", "1"].map(scatter);
            assert!(found[0] < 1e-12 && found.is_sorted(), "{name}: {found:?}");
        }
    }
}

#[test]
fn every_sampler_names_its_source_and_its_parameters_explain_themselves() {
    for sampler in samplers() {
        let about = sampler.about();
        let source = about.contains("19") || about.contains("20");
        assert!(source || ["uniform", "triangular", "square"].contains(&sampler.name()), "{about}");
        for parameter in sampler.parameters() {
            assert!(!parameter.meaning.is_empty() && parameter.range.0 <= parameter.range.1);
            assert!(
                parameter
                    .default
                    .parse()
                    .is_ok_and(|v: f64| parameter.range.0 <= v && v <= parameter.range.1)
                    || parameter.default.parse::<f64>().is_err()
            );
        }
    }
}

#[test]
fn mosaics_are_compared_by_default_with_fast_samplers_only() {
    let names: Vec<&str> = samplers_by_default().iter().map(|s| s.name()).collect();
    for expected in ["uniform", "jittered", "triangular", "square", "dart-throwing", "bridson"] {
        assert!(names.contains(&expected), "{expected}");
    }
    for slow in ["ahumada", "curcio-sloan", "wang", "minimal-spacing", "deering", "poisson-disk"] {
        assert!(!names.contains(&slow), "{slow}");
    }
}
