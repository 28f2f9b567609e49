//! Functions of distance and cells, compared with spatstat 3.0 and Metricks
//! (`../shared/oracle/metrics`).

use conemosaic::geometry::{Point, Window};
use conemosaic::mosaic::{LengthUnit, Mosaic};
use conemosaic::stats::{FunctionOptions, MeasureOptions, functions, measure, nearest_neighbours};
use std::collections::BTreeMap;
use std::path::PathBuf;

type Table = BTreeMap<String, Vec<Option<f64>>>;

fn table(name: &str) -> Option<Table> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/oracle/metrics").join(name);
    if !path.exists() {
        println!("SKIPPED {name}: ../shared is not here");
        return None;
    }
    let mut reader = csv::Reader::from_path(path).unwrap();
    let names: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let mut table = Table::new();
    for row in reader.records().map(Result::unwrap) {
        for (name, cell) in names.iter().zip(&row) {
            table.entry(name.clone()).or_default().push(cell.parse().ok());
        }
    }
    Some(table)
}

fn column(table: &Table, name: &str) -> Vec<f64> {
    table[name].iter().map(|v| v.unwrap_or(f64::NAN)).collect()
}

fn points(table: &Table) -> Vec<Point> {
    column(table, "x").into_iter().zip(column(table, "y")).map(|(x, y)| Point::new(x, y)).collect()
}

/// Names of the mosaics in `../shared/oracle/metrics`.
const MOSAICS: [&str; 3] = ["m1_confocal", "m3_confocal", "m4_split"];

/// Returns the oracle's window, [.5, W + .5] × [.5, H + .5]. W and H follow from the oracle's
/// distances between points and border, since some points are nearest to the right side and some to
/// the lower side.
fn window(per_point: &Table) -> Window {
    let far = |axis: &str| {
        let sums = column(per_point, axis).into_iter().zip(column(per_point, "bdist")).map(|(v, b)| v + b);
        (sums.fold(0., f64::max) - 0.5).round() + 0.5
    };
    Window::rectangle(0.5, 0.5, far("x"), far("y")).unwrap()
}

fn relative(ours: f64, theirs: f64) -> f64 {
    (ours - theirs).abs() / theirs.abs().max(1e-12)
}

#[test]
fn functions_of_distance_are_those_of_spatstat() {
    for mosaic in MOSAICS {
        for (set, suffix) in [("points", ""), ("jittered", "_jittered")] {
            let Some(sites) = table(&format!("{mosaic}.{set}.csv")) else { return };
            let theirs = table(&format!("{mosaic}.spatstat_functions{suffix}.csv")).unwrap();
            let window = window(&table(&format!("{mosaic}.spatstat_points{suffix}.csv")).unwrap());
            let r = column(&theirs, "r");
            let options = FunctionOptions { r_step: Some(r[1]), r_max: r.last().copied() };
            let sites = points(&sites);
            let ours = functions(&sites, &window, &nearest_neighbours(&sites, &window), &options).unwrap();
            assert_eq!(ours.r.len(), r.len());
            let ours: BTreeMap<_, _> = ours.columns().into_iter().collect();
            for name in theirs.keys().filter(|name| *name != "r") {
                let mut worst = (0., 0);
                for (k, (a, b)) in ours[name.as_str()].iter().zip(&theirs[name]).enumerate() {
                    // spatstat divides by r, so its value at r = 0 is infinite if a pair of points
                    // is close enough
                    let Some(b) = b.filter(|b| b.is_finite()) else {
                        assert!(a.is_nan(), "{mosaic}{suffix} {name} row {k}: {a}, spatstat has none");
                        continue;
                    };
                    let miss = match name.as_bytes()[0] {
                        // F is evaluated at 16384 positions; by rounding, one of them may fall on
                        // the other side of the end of a bin
                        b'F' => ((a - b).abs() - 2. / 16384.).max(0.) * 1e-3,
                        b'p' => (a - b).abs() * 1e-3,
                        _ if b == 0. => a.abs(),
                        _ => relative(*a, b),
                    };
                    if miss.is_nan() || miss > worst.0 {
                        worst = (miss, k);
                    }
                }
                println!("{mosaic}{suffix} {name}: {:.1e} at row {}", worst.0, worst.1);
                assert!(worst.0 <= 1e-9, "{mosaic}{suffix} {name} row {}: {}", worst.1, worst.0);
            }
        }
    }
}

#[test]
fn neighbours_borders_and_cells_are_those_of_spatstat() {
    for mosaic in MOSAICS {
        for (set, suffix) in [("points", ""), ("jittered", "_jittered")] {
            let Some(sites) = table(&format!("{mosaic}.{set}.csv")) else { return };
            let theirs = table(&format!("{mosaic}.spatstat_points{suffix}.csv")).unwrap();
            let window = window(&theirs);
            let found = Mosaic::new(points(&sites), window.clone(), LengthUnit::Pixel, None).unwrap().0;
            let ours = measure(&found, &MeasureOptions::default());
            for (k, p) in found.points().iter().enumerate() {
                let checks = [
                    ("nndist", ours.neighbours.distances[k]),
                    ("bdist", window.border_distance(*p)),
                    ("dirichlet_area", ours.cells.cells[k].clipped_area.unwrap()),
                ];
                for (name, value) in checks {
                    let miss = relative(value, theirs[name][k].unwrap());
                    // spatstat's areas differ by up to 1.5e-7 from areas computed in rational
                    // arithmetic
                    let bound = if name == "dirichlet_area" { 2e-7 } else { 1e-9 };
                    assert!(miss <= bound, "{mosaic}{suffix} {name} of point {k}: {value}, {miss:.1e} off");
                }
            }
        }
    }
}

#[test]
fn clark_evans_is_that_of_spatstat() {
    for (mosaic, [naive, donnelly, cdf]) in
        [("m1_confocal", [1.824949, 1.773727, 1.808302]), ("m3_confocal", [1.830052, 1.791241, 1.835098])]
    {
        let Some(sites) = table(&format!("{mosaic}.points.csv")) else { return };
        let window = Window::rectangle(0.5, 0.5, 150.5, 150.5).unwrap();
        let found = Mosaic::new(points(&sites), window, LengthUnit::Pixel, None).unwrap().0;
        let ours = measure(&found, &MeasureOptions::default()).summary.clark_evans;
        // the oracle's values have six decimals
        assert!((ours.naive.unwrap() - naive).abs() < 1e-6, "{ours:?}");
        assert!((ours.donnelly.unwrap() - donnelly).abs() < 1e-6, "{ours:?}");
        assert!((ours.cdf.unwrap() - cdf).abs() < 1e-6, "{ours:?}");
    }
}

#[test]
fn cells_and_neighbours_are_those_of_metricks() {
    // values in the order of the assertions below; lengths in µm, densities per mm²
    let expected = [
        (
            "m1_confocal",
            0.3936,
            218,
            164,
            [
                60596.9816831,
                3.55264699409,
                4.44185011501,
                5.40018871648,
                16.5024721071,
                73.1707317073,
                8.20684575219,
                11.5141453007,
                8.28504951371,
                14.6383623542,
                3.60845942521,
                4.97936863242,
                7.29561519581,
            ],
        ),
        (
            "m3_confocal",
            0.4746,
            381,
            311,
            [
                73145.6339033,
                3.28574171709,
                4.02103116216,
                4.79091756692,
                13.6713559872,
                80.0643086817,
                6.9715993504,
                13.4034183306,
                7.85341064153,
                13.4117506601,
                3.28474099284,
                4.50553753515,
                6.47923007518,
            ],
        ),
    ];
    for (mosaic, um, n, bound, values) in expected {
        let Some(sites) = table(&format!("{mosaic}.jittered.csv")) else { return };
        let inside: Vec<Point> =
            points(&sites).into_iter().filter(|p| p.x > 0. && p.x < 150. && p.y > 0. && p.y < 150.).collect();
        let window = Window::rectangle(0., 0., 150., 150.).unwrap();
        let found = Mosaic::new(inside, window, LengthUnit::Pixel, None).unwrap().0;
        let ours = measure(&found, &MeasureOptions::default());
        let cells = &ours.summary.voronoi;
        assert_eq!((found.len(), cells.bound), (n, bound));
        let ours = [
            cells.density.unwrap() * 1e6 / (um * um),
            ours.summary.nearest_bound.mean.unwrap() * um,
            cells.inter_cell.mean.unwrap() * um,
            cells.furthest.mean.unwrap() * um,
            cells.area.mean.unwrap() * um * um,
            cells.six_sided_percent.unwrap(),
            cells.area.ri.unwrap(),
            cells.sides.ri.unwrap(),
            ours.summary.nearest.ri.unwrap(),
            cells.inter_cell.ri.unwrap(),
            ours.summary.nearest.mean.unwrap() * um,
            cells.inter_cell_all.mean.unwrap() * um,
            cells.furthest_all.mean.unwrap() * um,
        ];
        for (k, (a, b)) in ours.iter().zip(values).enumerate() {
            assert!(relative(*a, b) < 1e-6, "{mosaic} value {k}: {a}, Metricks {b}");
        }
    }
}
