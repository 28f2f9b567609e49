//! Functions of distance, neighbours, border distances, cells and Clark–Evans, compared with
//! spatstat 3.0-3 for the point sets in `fixtures/points`.
//!
//! `scripts/oracle-spatstat` made the values in `fixtures/spatstat`. Where R and spatstat are
//! installed, the last test makes them again.

use conemosaic::geometry::{Point, Polygon, Window};
use conemosaic::mosaic::{LengthUnit, Mosaic};
use conemosaic::stats::{FunctionOptions, MeasureOptions, Measures, functions, measure, nearest_neighbours};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

type Table = BTreeMap<String, Vec<Option<f64>>>;

fn fixtures(folder: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(folder)
}

fn table(path: &Path) -> Table {
    let mut reader = csv::Reader::from_path(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let names: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let mut table: Table = names.iter().map(|name| (name.clone(), Vec::new())).collect();
    for row in reader.records().map(Result::unwrap) {
        for (name, cell) in names.iter().zip(&row) {
            table.get_mut(name).unwrap().push(cell.parse().ok());
        }
    }
    table
}

fn column(table: &Table, name: &str) -> Vec<f64> {
    table[name].iter().map(|v| v.unwrap_or(f64::NAN)).collect()
}

/// Point sets in rectangles, the only windows in which spatstat has periodic functions.
const RECTANGLES: [&str; 4] = ["bnot", "gradient", "lattice", "uniform"];
/// Point set in a polygon with slanting edges, a bay and a hole.
const POLYGON: &str = "polygon";

fn sets() -> impl Iterator<Item = &'static str> {
    RECTANGLES.into_iter().chain([POLYGON])
}

fn points(name: &str) -> Vec<Point> {
    let table = table(&fixtures("points").join(format!("{name}.csv")));
    column(&table, "x").into_iter().zip(column(&table, "y")).map(|(x, y)| Point::new(x, y)).collect()
}

fn window(name: &str) -> Window {
    let table = table(&fixtures("points").join(format!("{name}.window.csv")));
    let corners = column(&table, "x").into_iter().zip(column(&table, "y")).zip(column(&table, "ring"));
    let mut rings: BTreeMap<u64, Vec<Point>> = BTreeMap::new();
    for ((x, y), ring) in corners {
        rings.entry(ring as u64).or_default().push(Point::new(x, y));
    }
    Window::polygon(rings.into_values().collect()).unwrap()
}

fn spatstat(name: &str, what: &str) -> Table {
    table(&fixtures("spatstat").join(format!("{name}.spatstat_{what}.csv")))
}

/// Returns this program's functions at spatstat's distances.
fn ours(name: &str, window: &Window, theirs: &Table) -> BTreeMap<&'static str, Vec<f64>> {
    let (points, r) = (points(name), column(theirs, "r"));
    let options = FunctionOptions { r_step: Some(r[1]), r_max: r.last().copied() };
    let found = functions(&points, window, &nearest_neighbours(&points, window), &options).unwrap();
    assert_eq!(found.r.len(), r.len(), "{name}");
    found.columns().into_iter().collect()
}

/// Returns the largest difference between two columns, as measured by `miss`, and its row. Where
/// spatstat has no finite value, this program must have NaN; otherwise the difference is infinite.
fn worst(ours: &[f64], theirs: &[Option<f64>], miss: impl Fn(f64, f64) -> f64) -> (f64, usize) {
    assert_eq!(ours.len(), theirs.len());
    let mut worst = (0., 0);
    for (row, (a, b)) in ours.iter().zip(theirs).enumerate() {
        let miss = match b {
            Some(b) => miss(*a, *b),
            None if a.is_nan() => 0.,
            None => f64::INFINITY,
        };
        if miss.is_nan() || miss > worst.0 {
            worst = (miss, row);
        }
    }
    worst
}

fn relative(a: f64, b: f64) -> f64 {
    if b == 0. { a.abs() } else { (a / b - 1.).abs() }
}

fn absolute(a: f64, b: f64) -> f64 {
    (a - b).abs()
}

fn check(name: &str, what: &str, (miss, row): (f64, usize), bar: f64) {
    println!("{name} {what}: {miss:.1e} at row {row}");
    assert!(miss <= bar, "{name} {what}: {miss:e} at row {row}, bar {bar:e}");
}

/// Effect on F of two of the 16384 positions at which F is evaluated.
const TWO_PLACES: f64 = 2. / 16384.;

#[test]
fn functions_in_rectangles_are_those_of_spatstat() {
    for name in RECTANGLES {
        let theirs = spatstat(name, "functions");
        let ours = ours(name, &window(name), &theirs);
        for (what, values) in theirs.iter().filter(|(what, _)| !matches!(what.as_str(), "r" | "K_periodic")) {
            let of = |miss: fn(f64, f64) -> f64| worst(&ours[what.as_str()], values, miss);
            match what.as_bytes()[0] {
                // rounding may move a position to the other side of the end of a bin; border rules
                // use fewer positions, so that each weighs more
                b'F' if what == "F_none" => check(name, what, of(absolute), TWO_PLACES),
                b'F' => check(name, what, of(absolute), 2e-4),
                b'J' => {
                    // J divides by 1 − F, so the tolerance is that of F divided by the smallest 1 −
                    // F compared
                    let f = column(&theirs, &what.replace('J', "F"));
                    let kept: Vec<Option<f64>> =
                        values.iter().zip(f).map(|(v, f)| v.filter(|_| 1. - f > 0.02)).collect();
                    let ours: Vec<f64> = ours[what.as_str()]
                        .iter()
                        .zip(&kept)
                        .map(|(a, b)| if b.is_some() { *a } else { f64::NAN })
                        .collect();
                    check(name, what, worst(&ours, &kept, relative), 0.01);
                }
                b'p' => check(name, what, of(absolute), 1e-6),
                _ => check(name, what, of(relative), 1e-9),
            }
        }
    }
}

#[test]
fn k_on_a_torus_is_that_of_spatstat() {
    for name in RECTANGLES {
        let theirs = spatstat(name, "functions");
        let torus = Window::Torus(window(name).bounds());
        let ours = ours(name, &torus, &theirs);
        for what in ["K_none", "K_border", "K_iso", "K_trans"] {
            let n = points(name).len() as f64;
            // K with border correction divides by n², the others by n(n − 1)
            let factor = if what == "K_border" { n / (n - 1.) } else { 1. };
            let values: Vec<f64> = ours[what].iter().map(|k| k * factor).collect();
            check(name, what, worst(&values, &theirs["K_periodic"], relative), 1e-9);
        }
    }
}

/// Not all functions of spatstat are exact in polygons. Exact are G except for its Hanisch
/// estimate, and K except with translation correction.
///
/// For the others spatstat uses pixels: the border distances of F are those to the nearest pixel
/// outside, and set covariances are looked up in an image.
#[test]
fn functions_in_polygons_are_those_of_spatstat_where_it_is_exact() {
    let theirs = spatstat(POLYGON, "functions");
    let ours = ours(POLYGON, &window(POLYGON), &theirs);
    for what in ["G_none", "G_rs", "G_km", "K_none", "K_border", "K_iso", "L_none", "L_border", "L_iso"] {
        check(POLYGON, what, worst(&ours[what], &theirs[what], relative), 1e-9);
    }
    for what in ["pcf_iso_divr", "pcf_iso_divd"] {
        check(POLYGON, what, worst(&ours[what], &theirs[what], absolute), 1e-6);
    }
    // only two thirds of the 16384 positions lie inside the polygon, so each weighs 1.5 times as
    // much
    check(POLYGON, "F_none", worst(&ours["F_none"], &theirs["F_none"], absolute), 1.5 * TWO_PLACES);
    for (what, exact) in [("F_rs", "F_rs_exact"), ("F_km", "F_km_exact")] {
        check(POLYGON, exact, worst(&ours[what], &theirs[exact], absolute), 5e-4);
    }
    // this program interpolates its set covariance too; the error is largest at short distances,
    // near the tip of the covariance
    let (ours, exact) = (&ours["K_trans"], &theirs["K_trans_exact"]);
    check(POLYGON, "K_trans_exact", worst(ours, exact, relative), 2e-3);
}

/// spatstat's approximation by pixels deviates more from its own exact values than this program's
/// interpolation in tables does.
#[test]
fn in_polygons_pixels_cost_spatstat_more_than_our_tables_cost_us() {
    let theirs = spatstat(POLYGON, "functions");
    let ours = ours(POLYGON, &window(POLYGON), &theirs);
    for (what, exact) in [("F_rs", "F_rs_exact"), ("F_km", "F_km_exact"), ("K_trans", "K_trans_exact")] {
        let exact = &theirs[exact];
        let (we, _) = worst(&ours[what], exact, absolute);
        let (they, _) = worst(&column(&theirs, what), exact, absolute);
        println!("{what}: {we:.1e} off, spatstat's {they:.1e}");
        assert!(we < they, "{what}: {we} {they}");
    }
    // spatstat has no exact values of these functions
    for (what, bar) in [("G_han", 0.01), ("F_han", 0.01), ("pcf_trans_divr", 0.01), ("pcf_trans_divd", 0.01)]
    {
        check(POLYGON, what, worst(&ours[what], &theirs[what], absolute), bar);
    }
}

fn measured(name: &str) -> (Mosaic, Measures) {
    let (mosaic, outside) = Mosaic::new(points(name), window(name), LengthUnit::Pixel, None).unwrap();
    assert_eq!(outside, 0);
    let measures = measure(&mosaic, &MeasureOptions::default());
    (mosaic, measures)
}

#[test]
fn neighbours_borders_and_cells_are_those_of_spatstat() {
    for name in sets() {
        let theirs = spatstat(name, "points");
        let (mosaic, ours) = measured(name);
        let borders: Vec<f64> = mosaic.points().iter().map(|p| mosaic.window().border_distance(*p)).collect();
        let areas: Vec<f64> = ours.cells.cells.iter().map(|c| c.clipped_area.unwrap()).collect();
        let which: Vec<f64> = ours.neighbours.indices.iter().map(|j| (j + 1) as f64).collect();
        check(name, "nndist", worst(&ours.neighbours.distances, &theirs["nndist"], relative), 1e-9);
        check(name, "nnwhich", worst(&which, &theirs["nnwhich"], absolute), 0.);
        check(name, "bdist", worst(&borders, &theirs["bdist"], relative), 1e-9);
        // in rectangles, spatstat's areas (by deldir) are rounded to six decimals; in polygons they
        // are up to 2e-7 off, whereas the areas of this program add up to the area of the window
        let beyond_rounding = |a: f64, b: f64| ((a - b).abs() - 1e-6).max(0.) / b;
        check(name, "dirichlet_area", worst(&areas, &theirs["dirichlet_area"], beyond_rounding), 2e-7);
        assert!(relative(areas.iter().sum(), mosaic.window().area()) < 1e-12, "{name}");
    }
}

#[test]
fn clark_evans_is_that_of_spatstat() {
    for name in sets() {
        let theirs = spatstat(name, "summary");
        let (mosaic, ours) = measured(name);
        let ours = [
            ("n", Some(mosaic.len() as f64)),
            ("area", Some(mosaic.window().area())),
            ("perimeter", Some(mosaic.window().perimeter())),
            ("clark_evans_naive", ours.summary.clark_evans.naive),
            ("clark_evans_donnelly", ours.summary.clark_evans.donnelly),
            ("clark_evans_cdf", ours.summary.clark_evans.cdf),
        ];
        for (what, value) in ours {
            let Some(theirs) = theirs[what][0] else {
                assert_eq!((name, what), (POLYGON, "clark_evans_donnelly"));
                continue;
            };
            assert!(relative(value.unwrap(), theirs) < 1e-9, "{name} {what}: {value:?}, spatstat {theirs}");
        }
    }
}

/// The script makes the shipped values again with spatstat: they were not typed by hand.
#[test]
fn the_script_has_the_same_values_from_spatstat_again() {
    let there = Command::new("Rscript").args(["-e", "library(spatstat)"]).output();
    if !there.is_ok_and(|o| o.status.success()) {
        println!("SKIPPED: Rscript with spatstat is not here (apt-get install r-cran-spatstat)");
        return;
    }
    let again = tempfile::tempdir().unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/oracle-spatstat");
    let done =
        Command::new("Rscript").arg(script).arg(fixtures("points")).arg(again.path()).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    for name in sets() {
        for what in ["functions", "points", "summary"] {
            let file = format!("{name}.spatstat_{what}.csv");
            let (new, shipped) = (table(&again.path().join(&file)), spatstat(name, what));
            assert!(new.keys().eq(shipped.keys()), "{file}");
            for (column, values) in &shipped {
                let new: Vec<f64> = new[column].iter().map(|v| v.unwrap_or(f64::NAN)).collect();
                // pcf.ppp uses a Fourier transform: where there is no pair of points, its rounding
                // errors remain
                let (miss, row) = worst(&new, values, |a, b| (a - b).abs() / b.abs().max(1e-3));
                assert!(miss < 1e-9, "{file} {column}: {miss:e} at row {row}");
            }
        }
    }
}

/// A polygon with the corners of a rectangle has the functions of the rectangle.
#[test]
fn a_rectangle_as_a_polygon_has_the_functions_of_the_rectangle() {
    let theirs = spatstat("lattice", "functions");
    let rectangle = window("lattice");
    let b = rectangle.bounds();
    let corners = [(b.x0(), b.y0()), (b.x1(), b.y0()), (b.x1(), b.y1()), (b.x0(), b.y1())];
    let ring = corners.map(|(x, y)| Point::new(x, y)).to_vec();
    let polygon = Window::Polygon(Polygon::new(vec![ring]).unwrap());
    let (a, b) = (ours("lattice", &rectangle, &theirs), ours("lattice", &polygon, &theirs));
    for (what, values) in &a {
        let values: Vec<Option<f64>> = values.iter().map(|v| Some(*v).filter(|v| v.is_finite())).collect();
        // Hanisch estimates need areas of eroded polygons, which are counted in pixels
        let bar = if what.ends_with("han") { 0.02 } else { 1e-9 };
        // translation weights are interpolated from a table
        let bar = if what.contains("trans") { 1e-6 } else { bar };
        check(
            "rectangle as polygon",
            what,
            worst(&b[what], &values, |x, y| (x - y).abs() / y.abs().max(1.)),
            bar,
        );
    }
}
