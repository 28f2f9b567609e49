use super::*;
use crate::geometry::{Polygon, Rectangle};
use crate::stats::{Deviation, moments, nearest_neighbours, voronoi};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn seeded(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

fn regularity_index(n: usize, bnot: &Bnot, seeds: u64) -> f64 {
    let window = Window::unit_square();
    let index = |seed| {
        let points = bnot.sample(n, &window, &mut seeded(seed)).unwrap();
        moments(&nearest_neighbours(&points, &window).distances, Deviation::Population).ri.unwrap()
    };
    (0..seeds).map(index).sum::<f64>() / seeds as f64
}

/// Bounds around the regularity indices of the published single sets: 21.45, 22.92 and 23.31.
#[test]
fn twenty_steps_are_as_regular_as_published() {
    for (n, low, high) in [(1050, 20.7, 22.8), (2050, 21.6, 23.7), (4050, 22.2, 24.1)] {
        let mean = regularity_index(n, &Bnot::PAPER, 10);
        println!("BNOT {n}, 20 steps: mean RI of 10 seeds {mean:.2}");
        assert!((low..=high).contains(&mean), "{n}: {mean}");
    }
}

#[test]
fn points_at_rest_are_more_regular_than_after_twenty_steps() {
    let mean = regularity_index(1024, &Bnot::CONVERGED, 10);
    println!("BNOT 1024, converged: mean RI of 10 seeds {mean:.2}");
    assert!(mean >= 25., "{mean}");
}

#[test]
fn cells_have_equal_masses_in_every_kind_of_window() {
    let corners = [(0., 0.), (3., 0.5), (2., 2.), (0.5, 1.5)].map(|(x, y)| Point::new(x, y)).to_vec();
    let polygon = Polygon::new(vec![corners]).unwrap();
    let wide = Frame::new(300, &Window::rectangle(0., 0., 5., 1.).unwrap()).unwrap();
    let torus = Frame::new(300, &Window::unit_torus()).unwrap();
    let density = Density::from_fn(40, 30, |x, y| 1. + 20. * x * y).unwrap();
    for density in [None, Some(&density)] {
        let convex = Region::convex(300, &polygon, density).unwrap().unwrap();
        for region in [Region::new(&wide, density), Region::new(&torus, density), convex] {
            let start = region.scatter("bnot", 300, &mut seeded(3)).unwrap();
            let bnot = Bnot { steps: Some(4), ..Bnot::CONVERGED };
            let (points, solved) = bnot.relax(&start, &region, &mut seeded(4), &mut |_, _| ()).unwrap();
            assert_eq!(points.len(), 300);
            let masses: Vec<f64> = solved.diagram.cells().iter().map(|c| c.mass).collect();
            let mean = masses.iter().sum::<f64>() / 300.;
            assert!(masses.iter().all(|m| (m / mean - 1.).abs() < 1e-6));
            if density.is_none() {
                assert!((mean * 300. / region.domain.area() - 1.).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn moving_the_start_round_the_torus_moves_the_pattern_and_permutes_nothing() {
    let torus = Frame::new(500, &Window::unit_torus()).unwrap();
    let region = Region::new(&torus, None);
    let start = region.scatter("bnot", 500, &mut seeded(8)).unwrap();
    let (dx, dy): (f64, f64) = (seeded(9).random(), seeded(10).random());
    let moved: Vec<[f64; 2]> = start.iter().map(|p| region.domain.wrapped([p[0] + dx, p[1] + dy])).collect();
    let relax =
        |start: &[[f64; 2]]| Bnot::PAPER.relax(start, &region, &mut seeded(1), &mut |_, _| ()).unwrap().0;
    for (a, b) in relax(&start).iter().zip(relax(&moved)) {
        let [x, y] = region.domain.towards([a[0] + dx, a[1] + dy], b);
        // inner solves end at a deviation of 1 %, so rounding errors may grow to a fraction of that
        assert!(x.hypot(y) < 1e-3 * region.spacing(500), "{x} {y}");
    }
}

#[test]
fn threads_change_no_bit() {
    let make = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Bnot::PAPER.sample(1500, &Window::unit_square(), &mut seeded(2)).unwrap())
    };
    assert_eq!(make(1), make(4));
}

#[test]
fn points_follow_the_density() {
    let density = Density::from_fn(64, 64, |x, _| if x < 0.25 { 3. } else { 1. }).unwrap();
    let bnot = Bnot { density: Some(density), ..Bnot::PAPER };
    let points = bnot.sample(900, &Window::unit_torus(), &mut seeded(5)).unwrap();
    let left = points.iter().filter(|p| p.x < 0.25).count();
    // half the mass lies there; cells on its two edges may belong to either side
    assert!(left.abs_diff(450) <= 15, "{left}");
}

#[test]
fn cells_of_the_pattern_have_the_published_scatter_of_areas() {
    // the published coefficient of variation of Voronoi areas is .041 after 20 steps
    let points = Bnot::PAPER.sample(1024, &Window::unit_torus(), &mut seeded(6)).unwrap();
    let cv = voronoi(&points, &Window::unit_torus()).summary().area_cv.unwrap();
    assert!((cv - 0.041).abs() < 0.008, "{cv}");
}

#[test]
fn crystals_form_with_time_and_breaking_leaves_fewer_of_them() {
    let region = Region::new(&Frame::new(1000, &Window::unit_torus()).unwrap(), None);
    let crystalline = |steps: usize, breaks: usize| {
        let bnot = Bnot { breaks, steps: Some(steps), ..Bnot::CONVERGED };
        let start = region.scatter("bnot", 1000, &mut seeded(7)).unwrap();
        let (_, solved) = bnot.relax(&start, &region, &mut seeded(8), &mut |_, _| ()).unwrap();
        regularity::regular(&solved.diagram).len()
    };
    let [early, late, broken] =
        [(20, 0), (100, 0), (100, 2)].map(|(steps, breaks)| crystalline(steps, breaks));
    assert!(early < 10 && late > 100 && broken < late / 2, "{early} {late} {broken}");
}

#[test]
fn coincident_points_part_and_lines_spread() {
    let square = Frame::new(60, &Window::unit_square()).unwrap();
    let torus = Frame::new(60, &Window::unit_torus()).unwrap();
    let twins: Vec<[f64; 2]> = (0..60).map(|i| [0.1 + 0.01 * f64::from(i / 2), 0.5]).collect();
    let heap = vec![[0.5, 0.5]; 60];
    let corner = vec![[0., 0.]; 60];
    for frame in [square, torus] {
        let region = Region::new(&frame, None);
        for start in [&twins, &heap, &corner] {
            let (points, solved) = Bnot::PAPER.relax(start, &region, &mut seeded(1), &mut |_, _| ()).unwrap();
            assert!(solved.error <= 1e-6);
            let points = region.place(&points);
            let nearest = nearest_neighbours(&points, &Window::unit_square());
            assert!(nearest.distances.iter().all(|&d| d > 0.01));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn few_points_and_slivers_are_filled(
        n in 0..12usize, torus: bool, exponent in -5..=5i32, steps in 0..6usize, seed: u64,
    ) {
        let bounds = Rectangle::new(-3., 2., -3. + 10f64.powi(exponent), 3.).unwrap();
        let window = if torus { Window::Torus(bounds) } else { Window::Rectangle(bounds) };
        let bnot = Bnot { steps: Some(steps), ..Bnot::CONVERGED };
        let points = bnot.sample(n, &window, &mut seeded(seed)).unwrap();
        prop_assert_eq!(points.len(), n);
        prop_assert!(points.iter().all(|&p| bounds.contains(p)));
    }
}
