//! The commands `measure --spectrum` and `sample --target-pcf`, `--target-spectrum`, run as a user
//! runs them.

use crate::common::{Place, number, table};
use std::path::Path;

/// Returns the columns named `x` and `y` of a table, in the rows whose x lies between `low` and
/// `high`.
fn curve(file: &Path, x: &str, y: &str, low: f64, high: f64) -> Vec<(f64, f64)> {
    let rows = table(file);
    rows.iter().map(|r| (number(r, x), number(r, y))).filter(|(x, _)| (low..high).contains(x)).collect()
}

fn farthest(a: &[(f64, f64)], b: &[(f64, f64)]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a.1 - b.1).abs()).fold(0., f64::max)
}

#[test]
fn what_measure_writes_is_a_target_that_sample_reaches() {
    let place = Place::new();
    place.ok(&["sample", "dart-throwing", "-n", "900", "--torus", "--out", "darts.csv"]);
    let measure = ["--window", "unit", "--torus", "--spectrum=db"];
    place.ok(&[&["measure", "darts.csv", "--out", "first"][..], &measure].concat());
    place.ok(&[
        "sample",
        "--target-pcf",
        "first/darts.pcf.csv",
        "-n",
        "900",
        "--seed",
        "5",
        "--out",
        "by_pcf.csv",
    ]);
    place.ok(&[&["measure", "by_pcf.csv", "--out", "second"][..], &measure].concat());

    let g = |file: &str| curve(&place.path(file), "r", "g", 0.15, 2.5);
    let distance = farthest(&g("first/darts.pcf.csv"), &g("second/by_pcf.pcf.csv"));
    assert!(distance < 0.08, "{distance}");
}

#[test]
fn the_miss_of_a_target_is_told_written_and_warned_of() {
    let place = Place::new();
    place.ok(&["sample", "dart-throwing", "-n", "900", "--torus", "--out", "darts.csv"]);
    place.ok(&["measure", "darts.csv", "--out", "measured", "--window", "unit", "--torus"]);
    let reached = |target: &str, n: &str| {
        let outcome = place.run(&["sample", "--target-pcf", target, "-n", n, "--torus", "--out", "made.csv"]);
        assert_eq!(outcome.code, 0, "{}", outcome.stderr);
        let fit: serde_json::Value =
            serde_json::from_slice(&std::fs::read(place.path("made.fit.json")).unwrap()).unwrap();
        assert_eq!(fit["g_wanted"].as_array().unwrap().len(), fit["r"].as_array().unwrap().len());
        (outcome.stderr, fit["l_infinity"].as_f64().unwrap())
    };
    let (words, miss) = reached("measured/darts.pcf.csv", "900");
    assert!(miss < 0.1 && words.contains("l∞") && !words.contains("warning"), "{miss}: {words}");
    // the target has pairs at one distance only, which no pattern has
    place.write("spike.csv", "r,g\n0.15,0\n0.9,0\n1,9\n1.1,0\n2.5,0\n");
    let (words, miss) = reached("spike.csv", "900");
    assert!(miss > 0.1 && words.contains("warning"), "{miss}: {words}");
    // standard output holds points only; remarks go to standard error
    let outcome = place.run(&["sample", "--target-pcf", "measured/darts.pcf.csv", "-n", "50"]);
    assert!(!outcome.stdout.contains("l∞") && outcome.stderr.contains("l∞"), "{}", outcome.stderr);
}

#[test]
fn a_given_spectrum_is_reached() {
    let place = Place::new();
    place.write("ramp.csv", "frequency,power\n0.4,0.1\n0.7,1\n");
    place.ok(&["sample", "--target-spectrum", "ramp.csv", "-n", "1500", "--out", "points.csv"]);
    place.ok(&["measure", "points.csv", "--window", "unit", "--torus", "--spectrum", "--out", "measured"]);
    let mean = |low, high| {
        let rows = curve(&place.path("measured/points.spectrum.csv"), "frequency", "power", low, high);
        rows.iter().map(|r| r.1).sum::<f64>() / rows.len() as f64
    };
    for (low, high, expected) in [(0.01, 0.2, 0.1), (0.2, 0.38, 0.1), (0.5, 0.6, 0.55), (0.75, 2., 1.)] {
        let found = mean(low, high);
        assert!((found - expected).abs() < 0.05, "{low}–{high} √n: {found}, wanted {expected}");
    }
    assert!(std::fs::read(place.path("measured/points.spectrum.png")).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn targets_that_are_none_are_refused_with_file_line_and_reason() {
    let place = Place::new();
    place.write("words.csv", "r,g\n0.1,0.2\n0.2,much\n");
    place.write("short.csv", "r,g\n0.1,0.2\n0.2,1\n");
    for (file, reason) in [("words.csv", "line 3"), ("short.csv", "ends at 0.2"), ("none.csv", "cannot read")]
    {
        let outcome = place.run(&["sample", "--target-pcf", file, "-n", "100"]);
        assert_eq!(outcome.code, 1);
        assert!(outcome.stderr.contains(file) && outcome.stderr.contains(reason), "{}", outcome.stderr);
    }
    let both = place.run(&["sample", "green", "--target-pcf", "words.csv", "-n", "100"]);
    assert_eq!(both.code, 1);
}

#[test]
fn polygons_get_a_warning_instead_of_a_spectrum() {
    let place = Place::new();
    place.ok(&["sample", "uniform", "-n", "200", "--out", "points.csv"]);
    place.write("outline.csv", "0,0\n1,0\n0,1\n");
    place.ok(&["measure", "points.csv", "--window", "outline.csv", "--spectrum", "--out", "measured"]);
    let rows = table(&place.path("measured/summary.csv"));
    assert!(rows[0]["warnings"].contains("no spectrum"), "{}", rows[0]["warnings"]);
    assert!(!place.path("measured/points.spectrum.csv").exists());
}
