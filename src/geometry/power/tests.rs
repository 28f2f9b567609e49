use super::*;
use crate::geometry::Point;
use crate::geometry::Polygon;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};

fn uniform(n: usize, seed: u64, width: f64, height: f64) -> Vec<[f64; 2]> {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    (0..n).map(|_| [width * rng.random::<f64>(), height * rng.random::<f64>()]).collect()
}

fn total(diagram: &PowerDiagram) -> f64 {
    diagram.cells().iter().map(|c| c.mass).sum()
}

/// Returns the site with the least power distance to the point `p`, by comparing all sites.
fn owner(domain: &Domain, sites: &[[f64; 2]], weights: &[f64], p: [f64; 2]) -> usize {
    let power = |i: usize| {
        let [dx, dy] = domain.towards(sites[i], p);
        dx * dx + dy * dy - weights[i]
    };
    (0..sites.len()).min_by(|&i, &j| power(i).total_cmp(&power(j))).unwrap()
}

#[test]
fn cells_of_equal_weights_are_voronoi_cells() {
    let points: Vec<Point> = uniform(300, 4, 2., 1.).into_iter().map(Point::from).collect();
    let torus = crate::geometry::Rectangle::new(0., 0., 2., 1.).unwrap();
    let expected = crate::stats::voronoi(&points, &crate::geometry::Window::Torus(torus));
    let sites: Vec<[f64; 2]> = points.iter().map(|p| p.coordinates()).collect();
    let domain = Domain::Torus { width: 2., height: 1. };
    let diagram = PowerSites::new(&domain, None, &sites).diagram(&[3.5; 300], None);
    for (i, (ours, theirs)) in diagram.cells().iter().zip(&expected.cells).enumerate() {
        assert!((ours.mass - theirs.area.unwrap()).abs() < 1e-12);
        let sides = diagram.facets(i).iter().filter(|f| f.length > 1e-6).count();
        assert_eq!(sides, theirs.sides, "{i}");
    }
}

#[test]
fn areas_are_those_of_the_places_with_least_power() {
    let sites = uniform(60, 9, 1., 1.);
    let weights: Vec<f64> = uniform(60, 10, 0.02, 1.).iter().map(|w| w[0]).collect();
    for domain in [Domain::rectangle(1., 1.), Domain::Torus { width: 1., height: 1. }] {
        let diagram = PowerSites::new(&domain, None, &sites).diagram(&weights, None);
        let mut counted = vec![0.; 60];
        let side = 1000;
        for k in 0..side * side {
            let at = |i: usize| (i as f64 + 0.5) / side as f64;
            counted[owner(&domain, &sites, &weights, [at(k % side), at(k / side)])] += 1e-6;
        }
        assert!(counted.contains(&0.), "no site is hidden");
        for (cell, counted) in diagram.cells().iter().zip(counted) {
            assert!((cell.mass - counted).abs() < 2e-4, "{} {counted}", cell.mass);
        }
    }
}

#[test]
fn edges_are_the_derivative_of_areas_by_weights() {
    let sites = uniform(80, 2, 1., 1.);
    let mut weights: Vec<f64> = uniform(80, 3, 0.002, 1.).iter().map(|w| w[0]).collect();
    let density: Vec<f64> = (0..35).map(|k| 1. + f64::from(k * k % 7)).collect();
    for domain in [Domain::rectangle(1., 1.), Domain::Torus { width: 1., height: 1. }] {
        let raster = Raster::new(&domain, 7, 5, density.clone()).unwrap();
        for density in [None, Some(&raster)] {
            let mut sites = PowerSites::new(&domain, density, &sites);
            let before = sites.diagram(&weights, None);
            let step = 1e-7;
            weights[11] += step;
            let after = sites.diagram(&weights, Some(&before));
            weights[11] -= step;
            for facet in before.facets(11) {
                let j = facet.site as usize;
                let change = (after.cells()[j].mass - before.cells()[j].mass) / step;
                let expected = -facet.length / (2. * facet.distance);
                assert!((change - expected).abs() < 1e-4, "{change} {expected}");
            }
        }
    }
}

#[test]
fn masses_of_a_density_are_those_of_its_cells() {
    // sites in the middles of a 3 × 2 lattice, a raster twice as fine
    let sites: Vec<[f64; 2]> = (0..6).map(|k| [f64::from(k % 3) + 0.5, f64::from(k / 3) + 0.5]).collect();
    let density: Vec<f64> = (0..24).map(f64::from).collect();
    for domain in [Domain::rectangle(3., 2.), Domain::Torus { width: 3., height: 2. }] {
        let raster = Raster::new(&domain, 6, 4, density.clone()).unwrap();
        let diagram = PowerSites::new(&domain, Some(&raster), &sites).diagram(&[0.; 6], None);
        for (k, cell) in diagram.cells().iter().enumerate() {
            let corner = 2 * (k % 3) + 12 * (k / 3);
            let parts = [0, 1, 6, 7].map(|at| density[corner + at] / 23. / 4.);
            let mass: f64 = parts.iter().sum();
            assert!((cell.mass - mass).abs() < 1e-12);
            let x = 0.25 * (parts[1] + parts[3] - parts[0] - parts[2]) / mass;
            let y = 0.25 * (parts[2] + parts[3] - parts[0] - parts[1]) / mass;
            assert!((cell.centroid[0] - sites[k][0] - x).abs() < 1e-12);
            assert!((cell.centroid[1] - sites[k][1] - y).abs() < 1e-12);
        }
    }
}

#[test]
fn hints_and_threads_change_nothing_but_rounding_and_nothing_at_all() {
    let sites = uniform(3000, 1, 1., 1.);
    let domain = Domain::Torus { width: 1., height: 1. };
    let weights: Vec<f64> = uniform(3000, 5, 1e-4, 1.).iter().map(|w| w[0]).collect();
    let make = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| PowerSites::new(&domain, None, &sites).diagram(&weights, None))
    };
    let whole = make(1);
    assert_eq!(whole, make(5));
    let mut fresh = PowerSites::new(&domain, None, &sites);
    let plain = fresh.diagram(&vec![0.; 3000], None);
    let hinted = fresh.diagram(&weights, Some(&plain));
    for (a, b) in whole.cells().iter().zip(hinted.cells()) {
        assert!((a.mass - b.mass).abs() < 1e-15);
    }
}

#[test]
fn a_convex_polygon_is_filled_and_others_are_not_taken() {
    let ring = |corners: &[(f64, f64)]| {
        let ring = corners.iter().map(|&(x, y)| Point::new(x, y)).collect();
        Domain::convex(&Polygon::new(vec![ring]).unwrap())
    };
    let triangle = ring(&[(5., 5.), (8., 5.), (6., 7.)]).unwrap();
    let diagram = PowerSites::new(&triangle, None, &uniform(50, 1, 3., 2.)).diagram(&[0.; 50], None);
    assert!((total(&diagram) - 3.).abs() < 1e-12);
    assert!(ring(&[(0., 0.), (2., 0.), (2., 2.), (1., 0.5)]).is_none());
}

proptest! {
    #[test]
    fn any_sites_and_weights_fill_the_domain(
        raw in prop::collection::vec((0..6u8, 0..6u8, 0..4u8), 1..40), torus: bool, stretch in -6..=6i32, spread in 0..3i32,
    ) {
        // lattices with coincident sites and slivers, and weights that hide sites
        let stretch = 10f64.powi(stretch);
        let sites: Vec<[f64; 2]> =
            raw.iter().map(|r| [f64::from(r.0) * stretch, f64::from(r.1)]).collect();
        let weights: Vec<f64> = raw.iter().map(|r| f64::from(r.2) * f64::from(spread)).collect();
        let domain = match torus {
            true => Domain::Torus { width: 6. * stretch, height: 6. },
            false => Domain::rectangle(6. * stretch, 6.),
        };
        let diagram = PowerSites::new(&domain, None, &sites).diagram(&weights, None);
        prop_assert!((total(&diagram) / domain.area() - 1.).abs() < 1e-9, "{}", total(&diagram) / domain.area());
    }

    #[test]
    fn densities_add_up_over_any_cells(seed: u64, n in 1..30usize, torus: bool, columns in 1..9usize, rows in 1..9usize) {
        let domain = match torus {
            true => Domain::Torus { width: 1., height: 2. },
            false => Domain::rectangle(1., 2.),
        };
        let density: Vec<f64> = uniform(columns * rows, seed ^ 1, 1., 1.).iter().map(|v| v[0]).collect();
        let greatest = density.iter().copied().fold(0., f64::max);
        let raster = Raster::new(&domain, columns, rows, density.clone()).unwrap();
        let weights: Vec<f64> = uniform(n, seed ^ 2, 0.3, 1.).iter().map(|w| w[0]).collect();
        let diagram = PowerSites::new(&domain, Some(&raster), &uniform(n, seed, 1., 2.)).diagram(&weights, None);
        let expected = density.iter().sum::<f64>() / greatest * 2. / (columns * rows) as f64;
        prop_assert!((total(&diagram) / expected - 1.).abs() < 1e-9, "{} {expected}", total(&diagram));
        let shared = |i: usize, j: usize| -> f64 {
            diagram.facets(i).iter().filter(|f| f.site as usize == j).map(|f| f.length).sum()
        };
        for (i, j) in (0..n).flat_map(|i| (0..i).map(move |j| (i, j))) {
            prop_assert!((shared(i, j) - shared(j, i)).abs() < 1e-9, "{i} {j}");
        }
    }
}
