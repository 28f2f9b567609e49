//! Properties that every sampler of the library must have: exact numbers of points, no seam on a
//! torus, and more.

use conemosaic::geometry::{Point, Rectangle, Window};
use conemosaic::mosaic::hexagonal_spacing;
use conemosaic::sample::{Sampler, sampler, samplers, samplers_by_default};
use conemosaic::stats::{nearest_neighbours, voronoi};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

fn seeded(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

fn named(name: &str) -> &'static dyn Sampler {
    sampler(name).unwrap()
}

/// Returns whether a point lies in the half-open ranges of the window's bounds.
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
    // a window far from the origin, where coordinates have few significant digits left for
    // differences
    windows.push(Rectangle::new(1e12, -1e12, 1e12 + 1., 1. - 1e12).unwrap());
    for sampler in samplers() {
        for bounds in &windows {
            for window in [Window::Rectangle(*bounds), Window::Torus(*bounds)] {
                for n in [0, 1, 2, 3, 7] {
                    let name = format!("{}, n {n}, {window:?}", sampler.name());
                    match sampler.sample(n, &window, &mut seeded(1)) {
                        Ok(points) => {
                            assert!(points.iter().all(|p| within(bounds, p)), "{name}");
                            let exact = n == 0 || sampler.exact();
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
                // lattices that are not exact gain or lose whole rows
                let most = if sampler.exact() { 0 } else { 2 + (1.5 * (n as f64).sqrt()) as usize };
                assert!(found.abs_diff(n) <= most, "{}, {n}: {found}", sampler.name());
            }
        }
    }
}

/// Patterns of a `periodic` sampler on a torus show no seam: the mean nearest-neighbour distance is
/// the same near the seam as elsewhere.
#[test]
fn the_seam_of_a_torus_does_not_show() {
    let torus = Window::unit_torus();
    for sampler in samplers().iter().filter(|s| s.periodic()) {
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

/// The listed defaults are the ones that the sampler uses, and both ends of a parameter's range
/// give points or an error.
#[test]
fn parameters_at_their_defaults_change_nothing_and_at_their_limits_give_points_or_an_error() {
    let window = Window::rectangle(0., 0., 2., 1.).unwrap();
    for sampler in samplers() {
        let usual = sampler.sample(60, &window, &mut seeded(3)).unwrap();
        for parameter in sampler.parameters() {
            let name = format!("{} {}", sampler.name(), parameter.name);
            if let Some(default) = parameter.default {
                let same = sampler.configure(&[(parameter.name, &default.to_string())]).unwrap();
                assert_eq!(same.sample(60, &window, &mut seeded(3)).unwrap(), usual, "{name}");
            }
            // a relaxation of a million steps works, but takes too long for a test
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
        let lattice = named(name);
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
            let (low, high) = parameter.range;
            assert!(parameter.default.map_or(!parameter.unset.is_empty(), |v| (low..=high).contains(&v)));
        }
    }
}

#[test]
fn mosaics_are_compared_by_default_with_what_they_could_be() {
    let names: Vec<&str> = samplers_by_default().iter().map(|s| s.name()).collect();
    assert_eq!(names, ["uniform", "jittered", "bridson", "dart-throwing", "bnot", "triangular"]);
}

#[test]
fn every_sampler_of_the_literature_is_there_under_its_name() {
    let names: Vec<&str> = samplers().iter().map(|s| s.name()).collect();
    for expected in "uniform jittered square triangular dart-throwing bridson poisson-disk green pink step bnot lloyd ahumada \
                     curcio-sloan wang minimal-spacing deering"
        .split_whitespace()
    {
        assert!(names.contains(&expected), "{expected}");
    }
    assert_eq!(names.len(), 17);
}

/// The distances are in hexagonal spacings of the number of points asked for. They are measured on
/// the torus, whatever the window.
#[test]
fn no_two_points_are_nearer_than_a_sampler_promises() {
    let bounds = Rectangle::new(-2., 1., 4., 5.).unwrap();
    for (name, least) in
        [("dart-throwing", 0.75), ("bridson", 0.7306), ("poisson-disk", 0.7766), ("minimal-spacing", 0.42)]
    {
        for n in [2, 30, 400, 2000] {
            let spacing = hexagonal_spacing(n, 24.).unwrap();
            for window in [Window::Rectangle(bounds), Window::Torus(bounds)] {
                let points = named(name).sample(n, &window, &mut seeded(n as u64)).unwrap();
                let nearest = nearest_neighbours(&points, &Window::Torus(bounds)).distances;
                let found = nearest.into_iter().fold(f64::INFINITY, f64::min) / spacing;
                assert!(found >= least - 2e-4, "{name}, {n}: {found}");
            }
        }
    }
}

/// Doubling is exact in binary numbers, so it must not change a single bit of the pattern.
#[test]
fn a_window_of_another_size_holds_the_same_pattern_scaled() {
    for sampler in samplers() {
        for torus in [false, true] {
            let window = |size: f64| {
                let bounds = Rectangle::new(0., 0., 2. * size, size).unwrap();
                if torus { Window::Torus(bounds) } else { Window::Rectangle(bounds) }
            };
            let [small, large] =
                [1., 1024.].map(|size| sampler.sample(120, &window(size), &mut seeded(9)).unwrap());
            assert_eq!(small.len(), large.len(), "{}", sampler.name());
            let off =
                small.iter().zip(&large).map(|(a, b)| Point::new(1024. * a.x, 1024. * a.y).distance(*b));
            let off = off.fold(0., f64::max);
            assert!(off < 1e-6, "{}, torus {torus}: {off}", sampler.name());
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_points() {
    let window = Window::rectangle(0., 0., 3., 2.).unwrap();
    let pools =
        [1, 2, 5].map(|threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap());
    for sampler in samplers() {
        let patterns = pools
            .each_ref()
            .map(|pool| pool.install(|| sampler.sample(900, &window, &mut seeded(4)).unwrap()));
        assert!(patterns.iter().all(|p| *p == patterns[0]), "{}", sampler.name());
    }
}

/// BNOT equalises the areas of its power cells. The areas of the Voronoi cells, which lack the
/// weights that make areas equal, must still scatter little. After Lloyd's relaxation, the areas
/// must scatter less than those of the uniform points from which it starts.
#[test]
fn relaxed_points_have_cells_of_nearly_equal_area() {
    let window = Window::unit_torus();
    let scatter = |sampler: &dyn Sampler| {
        let points = sampler.sample(500, &window, &mut seeded(2)).unwrap();
        let areas: Vec<f64> = voronoi(&points, &window).cells.iter().filter_map(|cell| cell.area).collect();
        let mean = areas.iter().sum::<f64>() / areas.len() as f64;
        assert!((mean * 500. - 1.).abs() < 1e-9);
        (areas.iter().map(|a| (a / mean - 1.).powi(2)).sum::<f64>() / areas.len() as f64).sqrt()
    };
    let [bnot, lloyd, uniform] = ["bnot", "lloyd", "uniform"].map(|name| scatter(named(name)));
    assert!(bnot < 0.06 && bnot < lloyd && lloyd < 0.2 && uniform > 0.4, "{bnot} {lloyd} {uniform}");
}
