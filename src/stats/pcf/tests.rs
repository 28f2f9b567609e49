use super::*;
use crate::geometry::{Polygon, Rectangle};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

fn points_in(bounds: &Rectangle, n: usize, seed: u64) -> Vec<Point> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..n)
        .map(|_| {
            let (u, v): (f64, f64) = (rng.random(), rng.random());
            Point::new(bounds.x0() + u * bounds.width(), bounds.y0() + v * bounds.height())
        })
        .collect()
}

/// Computes g by its definition, as a sum over all ordered pairs (and images).
///
/// Valid for windows wider than r and for torus windows.
fn direct(points: &[Point], window: &Window, options: &PcfOptions) -> Vec<f64> {
    let b = window.bounds();
    let (w, h, n) = (b.width(), b.height(), points.len() as f64);
    let s = hexagonal_spacing(points.len(), w * h).unwrap();
    let sigma = options.bandwidth * s;
    let images = if options.edge == EdgeCorrection::Torus { -6..=6 } else { 0..=0 };
    (0..options.bins)
        .map(|bin| {
            let r = s * (options.r_min + bin as f64 * (options.r_max - options.r_min) / options.bins as f64);
            let mut sum = 0.;
            for (i, p) in points.iter().enumerate() {
                for (_, q) in points.iter().enumerate().filter(|&(j, _)| j != i) {
                    for (kx, ky) in images.clone().flat_map(|a| images.clone().map(move |b| (a, b))) {
                        let (dx, dy) = (q.x - p.x + w * f64::from(kx), q.y - p.y + h * f64::from(ky));
                        let d = dx.hypot(dy);
                        let t = (r - d) / sigma;
                        let k = match options.kernel {
                            Kernel::Gaussian => (-t * t / 2.).exp() / TAU.sqrt(),
                            Kernel::Box => f64::from(u8::from(t.abs() <= 3f64.sqrt())) / 12f64.sqrt(),
                            Kernel::Triangle => (1. - t.abs() / 6f64.sqrt()).max(0.) / 6f64.sqrt(),
                        } / sigma;
                        let translated = 1. / ((1. - dx.abs() / w) * (1. - dy.abs() / h)).max(0.01);
                        let weight = match options.edge {
                            EdgeCorrection::SetCovariance if r > w.min(h) => translated,
                            EdgeCorrection::SetCovariance => {
                                let disk = 1. - 2. * r * (w + h) / (PI * w * h) + r * r / (PI * w * h);
                                1. / disk
                            }
                            EdgeCorrection::Translation => translated,
                            EdgeCorrection::Isotropic => {
                                // The share of the circle around p that lies inside is found by
                                // counting 20 000 of its points.
                                let m = 20_000;
                                let inside = (0..m).filter(|&a| {
                                    let angle = TAU * (f64::from(a) + 0.5) / f64::from(m);
                                    window.contains(Point::new(p.x + d * angle.cos(), p.y + d * angle.sin()))
                                });
                                (f64::from(m) / inside.count() as f64).min(100.)
                            }
                            EdgeCorrection::Torus | EdgeCorrection::None => 1.,
                        };
                        sum += weight * k;
                    }
                }
            }
            w * h * sum / (n * (n - 1.) * TAU * r)
        })
        .collect()
}

fn worst(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0., f64::max)
}

#[test]
fn fast_sum_agrees_with_the_sum_over_all_pairs() {
    let wide = Rectangle::new(-3., 7., 7., 12.).unwrap();
    let coarse = PcfOptions { bins: 40, ..PcfOptions::default() };
    let points = points_in(&wide, 120, 1);
    for kernel in [Kernel::Gaussian, Kernel::Box, Kernel::Triangle] {
        for (window, edge) in [
            (Window::Rectangle(wide), EdgeCorrection::SetCovariance),
            (Window::Rectangle(wide), EdgeCorrection::Translation),
            (Window::Rectangle(wide), EdgeCorrection::None),
            (Window::Torus(wide), EdgeCorrection::Torus),
        ] {
            let options = PcfOptions { kernel, edge, ..coarse };
            let g = pcf(&points, &window, &options).unwrap().g;
            let difference = worst(&g, &direct(&points, &window, &options));
            assert!(difference < 1e-6, "{kernel:?} {edge:?}: {difference}");
        }
    }
}

#[test]
fn few_points_in_thin_windows_agree_with_the_sum_over_all_pairs() {
    let thin = Rectangle::new(0., 0., 3., 1.).unwrap();
    let options = PcfOptions { bins: 40, ..PcfOptions::default() };
    for n in [2, 3, 12] {
        let points = points_in(&thin, n, n as u64);
        for (window, edge) in [
            (Window::Rectangle(thin), EdgeCorrection::SetCovariance),
            (Window::Torus(thin), EdgeCorrection::Torus),
        ] {
            let options = PcfOptions { edge, ..options };
            let g = pcf(&points, &window, &options).unwrap().g;
            let difference = worst(&g, &direct(&points, &window, &options));
            assert!(difference < 1e-6, "{n} {edge:?}: {difference}");
        }
    }
}

#[test]
fn isotropic_weights_are_the_inverse_share_of_the_circle() {
    let bounds = Rectangle::new(0., 0., 2., 1.).unwrap();
    let window = Window::Rectangle(bounds);
    let options = PcfOptions { bins: 8, edge: EdgeCorrection::Isotropic, ..PcfOptions::default() };
    let points = points_in(&bounds, 20, 5);
    let difference = worst(&pcf(&points, &window, &options).unwrap().g, &direct(&points, &window, &options));
    // The arcs of the comparison are counted, not computed exactly, hence the wide tolerance.
    assert!(difference < 2e-3, "{difference}");
}

#[test]
fn triangular_lattice_has_its_shells_at_1_root_3_and_2_with_6_neighbours_each() {
    let (columns, rows) = (20, 24);
    let bounds = Rectangle::new(0., 0., 20., 12. * 3f64.sqrt()).unwrap();
    let points: Vec<Point> = (0..rows)
        .flat_map(|j| (0..columns).map(move |i| (i, j)))
        .map(|(i, j)| {
            Point::new(f64::from(i) + 0.5 * f64::from(j % 2) + 0.2, 0.1 + f64::from(j) * 3f64.sqrt() / 2.)
        })
        .collect();
    let options = PcfOptions::default();
    let curve = pcf(&points, &Window::Torus(bounds), &options).unwrap();
    assert_eq!(curve.options.edge, EdgeCorrection::Torus);
    let n = f64::from(columns * rows);
    let shells = [(1., 6.), (3f64.sqrt(), 6.), (2., 6.), (7f64.sqrt(), 12.), (3., 6.)];
    for (r, g) in curve.r.iter().zip(&curve.g) {
        let expected: f64 = shells
            .iter()
            .map(|(at, m)| m * (-((r - at) / 0.1f64).powi(2) / 2.).exp() / (0.1 * TAU.sqrt()))
            .sum::<f64>()
            * bounds.area()
            / ((n - 1.) * TAU * r);
        assert!((g - expected).abs() < 1e-6, "r {r}: {g}, expected {expected}");
    }
}

#[test]
fn independent_points_have_g_1_under_every_correction_but_none() {
    let bounds = Rectangle::new(0., 0., 1., 1.).unwrap();
    let points = points_in(&bounds, 20_000, 9);
    for edge in [EdgeCorrection::SetCovariance, EdgeCorrection::Translation, EdgeCorrection::Isotropic] {
        let options = PcfOptions { edge, ..PcfOptions::default() };
        let g = pcf(&points, &Window::Rectangle(bounds), &options).unwrap().g;
        assert!(g.iter().all(|g| (g - 1.).abs() < 0.04), "{edge:?}");
    }
    let few = &points[..300];
    let options = PcfOptions { edge: EdgeCorrection::None, ..PcfOptions::default() };
    let none = pcf(few, &Window::Rectangle(bounds), &options).unwrap().g;
    let corrected = pcf(few, &Window::Rectangle(bounds), &PcfOptions::default()).unwrap().g;
    assert!(none[199] < 0.87 * corrected[199]);
}

fn polygon_of(corners: &[(f64, f64)]) -> Window {
    let ring = corners.iter().map(|&(x, y)| Point::new(x, y)).collect();
    Window::Polygon(Polygon::new(vec![ring]).unwrap())
}

#[test]
fn a_rectangle_given_as_a_polygon_has_the_curve_of_the_rectangle() {
    let bounds = Rectangle::new(10., 0., 13., 2.).unwrap();
    let points = points_in(&bounds, 400, 6);
    let polygon = polygon_of(&[(10., 0.), (13., 0.), (13., 2.), (10., 2.)]);
    for (edge, tolerance) in [
        (EdgeCorrection::SetCovariance, 1e-4),
        (EdgeCorrection::Translation, 1e-9),
        (EdgeCorrection::Isotropic, 1e-9),
        (EdgeCorrection::None, 1e-12),
    ] {
        let options = PcfOptions { edge, ..PcfOptions::default() };
        let expected = pcf(&points, &Window::Rectangle(bounds), &options).unwrap().g;
        let difference = worst(&pcf(&points, &polygon, &options).unwrap().g, &expected);
        assert!(difference < tolerance, "{edge:?}: {difference}");
    }
}

#[test]
fn independent_points_in_an_l_have_g_1_under_every_correction_but_none() {
    let l = polygon_of(&[(0., 0.), (1., 0.), (1., 0.35), (0.35, 0.35), (0.35, 1.), (0., 1.)]);
    let mean_of = |edge: EdgeCorrection| {
        let options = PcfOptions { edge, bins: 30, r_max: 4., ..PcfOptions::default() };
        let curves: Vec<Vec<f64>> = (0..60)
            .map(|seed| {
                let mut points = points_in(&l.bounds(), 700, seed);
                points.retain(|&p| l.contains(p));
                pcf(&points, &l, &options).unwrap().g
            })
            .collect();
        (0..30).map(|b| curves.iter().map(|g| g[b]).sum::<f64>() / 60.).collect::<Vec<f64>>()
    };
    for edge in [EdgeCorrection::SetCovariance, EdgeCorrection::Translation, EdgeCorrection::Isotropic] {
        let mean = mean_of(edge);
        // The number of points varies between patterns, which biases the corrections by less than
        // the tolerance.
        assert!(mean.iter().all(|g| (g - 1.).abs() < 0.05), "{edge:?}: {mean:.3?}");
        let far = mean[10..].iter().sum::<f64>() / 20.;
        assert!((far - 1.).abs() < 0.01, "{edge:?}: {far}");
    }
    assert!(mean_of(EdgeCorrection::None)[29] < 0.75);
}

#[test]
fn torus_curve_does_not_depend_on_where_the_torus_is_cut() {
    let bounds = Rectangle::new(0., 0., 2., 1.).unwrap();
    let window = Window::Torus(bounds);
    let points = points_in(&bounds, 400, 3);
    let moved: Vec<Point> =
        points.iter().map(|p| Point::new((p.x + 1.37).rem_euclid(2.), (p.y + 0.61).rem_euclid(1.))).collect();
    let options = PcfOptions::default();
    let (a, b) = (pcf(&points, &window, &options).unwrap(), pcf(&moved, &window, &options).unwrap());
    assert!(worst(&a.g, &b.g) < 1e-9);
}

#[test]
fn curve_does_not_depend_on_the_unit_or_the_number_of_threads() {
    let bounds = Rectangle::new(0., 0., 1., 1.).unwrap();
    let points = points_in(&bounds, 20_000, 4);
    let options = PcfOptions::default();
    let window = Window::Rectangle(bounds);
    let curve = pcf(&points, &window, &options).unwrap();
    assert_eq!(curve, pcf_on_one_thread(&points, &window, &options).unwrap());
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert_eq!(curve, pool.install(|| pcf(&points, &window, &options)).unwrap());
    }
    let metres: Vec<Point> = points.iter().map(|p| Point::new(p.x * 1024. - 512., p.y * 1024.)).collect();
    let scaled = pcf(&metres, &Window::rectangle(-512., 0., 512., 1024.).unwrap(), &options).unwrap();
    assert!(worst(&curve.g, &scaled.g) < 1e-9);
    assert!((scaled.spacing / curve.spacing - 1024.).abs() < 1e-9);
}

#[test]
fn options_out_of_range_say_the_range() {
    let default = PcfOptions::default();
    assert!(default.validate().is_ok());
    for bad in [
        PcfOptions { bandwidth: 0., ..default },
        PcfOptions { bandwidth: f64::NAN, ..default },
        PcfOptions { r_min: 0.1, ..default },
        PcfOptions { r_max: 0.15, ..default },
        PcfOptions { r_max: f64::INFINITY, ..default },
        PcfOptions { bins: 0, ..default },
    ] {
        assert!(matches!(bad.validate(), Err(StatsError::Option { .. })), "{bad:?}");
    }
}

#[test]
fn what_has_no_curve_is_an_error() {
    let (window, options) = (Window::unit_square(), PcfOptions::default());
    let p = Point::new(0.5, 0.5);
    assert!(matches!(pcf(&[p], &window, &options), Err(StatsError::TooFewPoints { found: 1, .. })));
    let outside = [p, Point::new(1.5, 0.5)];
    assert!(matches!(pcf(&outside, &window, &options), Err(StatsError::Outside { index: 1, .. })));
    let not_a_number = [p, Point::new(f64::NAN, 0.5)];
    assert!(matches!(pcf(&not_a_number, &window, &options), Err(StatsError::Outside { index: 1, .. })));
    let torus = PcfOptions { edge: EdgeCorrection::Torus, ..options };
    assert_eq!(pcf(&[p, p], &window, &torus), Err(StatsError::NotATorus));
}

proptest! {
    #[test]
    fn any_small_pattern_has_a_finite_curve(
        raw in prop::collection::vec((0..6u8, 0..6u8), 2..30), torus: bool, flat in 0.001..1f64, edge in 0..4u8,
    ) {
        let bounds = Rectangle::new(0., 0., 5., 5. * flat).unwrap();
        let window = if torus { Window::Torus(bounds) } else { Window::Rectangle(bounds) };
        let points: Vec<Point> = raw
            .iter()
            .map(|&(x, y)| Point::new(f64::from(x), (f64::from(y) * flat).min(5. * flat)))
            .collect();
        let edge = [
            EdgeCorrection::SetCovariance,
            EdgeCorrection::Translation,
            EdgeCorrection::Isotropic,
            EdgeCorrection::None,
        ][edge as usize];
        let curve = pcf(&points, &window, &PcfOptions { edge, ..PcfOptions::default() }).unwrap();
        prop_assert!(curve.g.iter().all(|g| g.is_finite() && *g >= 0.));
    }
}
