//! The commands `measure`, `compare`, `validate`, `sample`, `render` and the help, run as a user
//! runs them.

use crate::common::{Place, number, shared, table};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::io::Read;
use std::process::{Command, Stdio};

fn points_of(rows: &[BTreeMap<String, String>]) -> Vec<[f64; 2]> {
    rows.iter().map(|r| [number(r, "x"), number(r, "y")]).collect()
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Returns the regularity index μ/σ of the nearest-neighbour distances, computed from all pairs of
/// points; σ has the divisor n.
fn regularity(points: &[[f64; 2]]) -> f64 {
    let n = points.len() as f64;
    let nearest: Vec<f64> = (0..points.len())
        .map(|i| {
            (0..points.len())
                .filter(|&j| j != i)
                .map(|j| distance(points[i], points[j]))
                .fold(f64::INFINITY, f64::min)
        })
        .collect();
    let mean = nearest.iter().sum::<f64>() / n;
    mean / (nearest.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n).sqrt()
}

/// Returns g(r) in the unit square, computed from all pairs of points by the definition: with a
/// Gaussian kernel of 0.1 hexagonal spacings that is not truncated, and the isotropised set
/// covariance.
fn correlation(points: &[[f64; 2]], r_in_spacings: f64) -> f64 {
    let n = points.len() as f64;
    let s = (2. / (3f64.sqrt() * n)).sqrt();
    let (r, sigma) = (r_in_spacings * s, 0.1 * s);
    let mut sum = 0.;
    for (i, &a) in points.iter().enumerate() {
        for &b in &points[..i] {
            let z = (r - distance(a, b)) / sigma;
            sum += 2. * (-0.5 * z * z).exp();
        }
    }
    let kernel = sum / (sigma * (2. * PI).sqrt());
    let covariance = 1. - 4. * r / PI + r * r / PI;
    kernel / (n * (n - 1.) * 2. * PI * r * covariance)
}

#[test]
fn measure_agrees_with_every_pair_of_the_oracle_point_sets() {
    let Some(folder) = shared("oracle/samplers", "measure against every pair") else { return };
    let place = Place::new();
    let names = ["white_1024_1", "bnot_bounded_default_1050_1", "aa_green_512_paper_exact_1"];
    let paths: Vec<_> = names.iter().map(|n| folder.join(format!("{n}.csv"))).collect();
    let mut arguments = vec!["measure", "--window", "unit", "--sd", "population", "--out", "out", "-q"];
    arguments.extend(paths.iter().map(|p| p.to_str().unwrap()));
    place.ok(&arguments);
    for (row, (path, name)) in place.table("out/summary.csv").iter().zip(paths.iter().zip(names)) {
        let points = points_of(&table(path));
        assert_eq!(row["n"], points.len().to_string());
        assert!((number(row, "ri") - regularity(&points)).abs() < 1e-9, "{name}");
        let curve = place.table(&format!("out/{name}.pcf.csv"));
        assert_eq!(curve.len(), 200);
        for bin in curve.iter().step_by(33) {
            let difference = number(bin, "g") - correlation(&points, number(bin, "r"));
            assert!(difference.abs() < 1e-6, "{name}: {difference:e} at {}", bin["r"]);
        }
    }
}

#[test]
fn the_same_window_has_three_spellings() {
    let place = Place::new();
    place.write("a.csv", "x,y\n0,0\n10,3\n149,149\n70,71\n149.6,3\n-0.4,77\n");
    place.ok(&["render", "--out", "a.png", "-q"]);
    for (out, window) in [("1", "150x150"), ("2", "-0.5,-0.5,149.5,149.5"), ("3", "image")] {
        place.ok(&["measure", "a.csv", "--window", window, "--out", out, "-q"]);
        let row = &place.table(&format!("{out}/summary.csv"))[0];
        assert_eq!((row["n"].as_str(), row["outside_window"].as_str()), ("5", "1"));
        assert!((number(row, "density") - 5. / 22500.).abs() < 1e-15);
        assert!(
            row["warnings"].contains("1 point lies outside the window and is left out"),
            "{}",
            row["warnings"]
        );
    }
    for file in ["a.pcf.csv", "summary.csv"] {
        assert_eq!(place.read(&format!("1/{file}")), place.read(&format!("2/{file}")));
        assert_eq!(place.read(&format!("1/{file}")), place.read(&format!("3/{file}")));
    }
    let said = place.ok(&["measure", "a.csv", "--window", "150x150", "--out", "1"]).stdout;
    assert!(said.contains("a.csv !") && said.contains("\n! a.csv: only 5 points"), "{said}");
}

#[test]
fn the_origin_moves_points_and_not_the_window() {
    let place = Place::new();
    place.write("matlab.csv", "1,1\n150,150\n70,80\n");
    place.write("zero.csv", "0,0\n149,149\n69,79\n");
    place.ok(&["measure", "matlab.csv", "--origin", "1", "--window", "150x150", "--out", "1", "-q"]);
    place.ok(&["measure", "zero.csv", "--window", "150x150", "--out", "0", "-q"]);
    assert_eq!(place.read("1/matlab.pcf.csv"), place.read("0/zero.pcf.csv"));
    assert_eq!(place.table("1/summary.csv")[0]["outside_window"], "0");
}

#[test]
fn micrometres_need_no_scale_and_a_scale_turns_pixels_into_them() {
    let place = Place::new();
    place.write("um.csv", "x_um,y_um\n1,1\n20,1\n5,5\n");
    place.write("px.csv", "x_px,y_px\n1.5,1.5\n39.5,1.5\n9.5,9.5\n");
    place.ok(&["measure", "um.csv", "--window", "30x30", "--out", "um", "-q"]);
    place.ok(&["measure", "px.csv", "--window", "60x60", "--um-per-px", "0.5", "--out", "px", "-q"]);
    let (um, px) = (&place.table("um/summary.csv")[0], &place.table("px/summary.csv")[0]);
    assert_eq!((um["unit"].as_str(), px["unit"].as_str()), ("um", "px"));
    for column in ["density_per_mm2", "nn_mean_um", "nn_sd_um", "ri"] {
        assert!((number(um, column) / number(px, column) - 1.).abs() < 1e-12, "{column}");
    }
}

#[test]
fn standard_deviations_differ_by_bessels_correction() {
    let place = Place::new();
    place.ok(&["sample", "uniform", "-n", "50", "--out", "a.csv", "-q"]);
    place.ok(&["measure", "a.csv", "--window", "unit", "--out", "sample", "-q"]);
    place.ok(&["measure", "a.csv", "--window", "unit", "--sd", "population", "--out", "population", "-q"]);
    let sd = |out: &str| number(&place.table(&format!("{out}/summary.csv"))[0], "nn_sd");
    assert!((sd("sample") / sd("population") - (50f64 / 49.).sqrt()).abs() < 1e-12);
}

#[test]
fn compare_keeps_the_samplers_asked_for_in_their_order() {
    let place = Place::new();
    place.ok(&["sample", "jittered", "-n", "100", "--seed", "3", "--out", "a.csv", "-q"]);
    place.ok(&["compare", "a.csv", "--window", "unit", "--samplers", "square,jittered", "--out", "out"]);
    let header = place.header("out/l_infinity.csv");
    assert_eq!(header[..3], ["file", "square", "jittered"]);
    let row = &place.table("out/l_infinity.csv")[0];
    assert_eq!((row["file"].as_str(), row["closest_sampler"].as_str()), ("a.csv", "jittered"));
    assert!(number(row, "jittered") < number(row, "square"));
    let files = [
        "a.envelope.csv",
        "a.pcf.csv",
        "a.verdict.svg",
        "finding.csv",
        "l_infinity.csv",
        "options.json",
        "regularity.csv",
        "summary.csv",
        "summary.json",
        "verdicts.csv",
    ];
    assert_eq!(place.names("out"), files);
}

#[test]
fn every_sampler_makes_points_of_the_unit_square() {
    let place = Place::new();
    let list = place.ok(&["sample", "--list"]).stdout;
    for name in ["uniform", "jittered", "triangular", "square", "dart-throwing", "bridson", "lloyd"] {
        assert!(list.contains(name));
        for n in ["0", "1", "2", "1024"] {
            for torus in [&[][..], &["--torus"]] {
                let arguments = [&["sample", name, "-n", n, "--seed", "5"][..], torus].concat();
                let text = place.ok(&arguments).stdout;
                assert!(text.starts_with("x,y\n"));
                let rows: Vec<Vec<f64>> = text
                    .lines()
                    .skip(1)
                    .map(|line| line.split(',').map(|v| v.parse().unwrap()).collect())
                    .collect();
                assert!(rows.iter().flatten().all(|v| (0. ..1.).contains(v)), "{name} {n}");
                let wanted: f64 = n.parse().unwrap();
                assert!((rows.len() as f64 - wanted).abs() <= 1. + 0.08 * wanted, "{name}: {}", rows.len());
            }
        }
        place.ok(&["sample", name, "-n", "64", "--seed", "5", "--out", "a.csv", "-q"]);
        assert_eq!(place.read("a.csv"), place.ok(&["sample", name, "-n", "64", "--seed", "5"]).stdout);
    }
    let other = place.ok(&["sample", "uniform", "-n", "64", "--seed", "6"]).stdout;
    assert_ne!(place.ok(&["sample", "uniform", "-n", "64", "--seed", "5"]).stdout, other);
    assert!(place.refused(&["sample", "octopus", "-n", "4"]).contains("dart-throwing"));
    assert!(place.refused(&["sample", "uniform", "-n", "-4"]).contains("whole number"));
}

#[test]
fn parameters_are_listed_set_and_refused_with_what_is_possible() {
    let place = Place::new();
    let list = place.ok(&["sample", "--list"]).stdout;
    assert!(list.contains("bnot") && list.contains("whole, 0 to 100000") && list.contains("spacings"));
    let sampled = |arguments: &[&str]| place.ok(&[&["sample"], arguments].concat()).stdout;
    let short = sampled(&["bnot", "-n", "90", "--steps", "3"]);
    assert_eq!(short, sampled(&["bnot", "-n", "90", "--set", "steps=3", "--threads", "1"]));
    assert_ne!(short, sampled(&["bnot", "-n", "90", "--steps", "4"]));
    for n in ["0", "1", "2"] {
        for torus in [&[][..], &["--torus"]] {
            let text = sampled(&[&["bnot", "-n", n], torus].concat());
            assert_eq!(text.lines().count().to_string(), (n.parse::<usize>().unwrap() + 1).to_string());
        }
    }
    let refused = |arguments: &[&str]| place.refused(&[&["sample"], arguments].concat());
    assert!(refused(&["bnot", "-n", "9", "--set", "step=3"]).contains("did you mean steps?"));
    assert!(refused(&["bnot", "-n", "9", "--set", "tolerance=-1"]).contains("0.000000001 to 1 spacings"));
    assert!(refused(&["bnot", "-n", "9", "--set", "steps"]).contains("NAME=VALUE"));
    assert!(refused(&["uniform", "-n", "9", "--steps", "3"]).contains("no parameters"));
}

#[test]
fn points_are_as_dense_as_a_picture_is_bright() {
    let place = Place::new();
    let plane = conemosaic::image::Plane::from_shape_fn((10, 20), |(_, x)| if x < 5 { 0.9 } else { 0.1 });
    let path = place.path("bright.png");
    conemosaic::image::write_png(&path, &plane, conemosaic::image::BitDepth::Eight).unwrap();
    for name in ["bnot", "lloyd"] {
        let text =
            place.ok(&["sample", name, "-n", "400", "--steps", "10", "--density", "bright.png"]).stdout;
        let left =
            text.lines().skip(1).filter(|line| line.starts_with("0.0") || line.starts_with("0.1")).count();
        assert!(left > 150, "{name}: {left} of 400 points on the left fifth");
    }
    let even = place.refused(&["sample", "jittered", "-n", "9", "--density", "bright.png"]);
    assert!(even.contains("bnot, lloyd"), "{even}");
    assert!(place.refused(&["sample", "bnot", "-n", "9", "--density", "no.png"]).contains("no.png"));
}

#[test]
fn a_reader_that_stops_listening_is_no_error() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_conemosaic"))
        .args(["sample", "uniform", "-n", "50000"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut first = [0; 4];
    child.stdout.take().unwrap().read_exact(&mut first).unwrap();
    assert_eq!(&first, b"x,y\n");
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn what_render_draws_detect_finds() {
    let place = Place::new();
    for modality in ["confocal", "split"] {
        let (image, truth) = (format!("in/{modality}.tif"), format!("in/{modality}_coords.csv"));
        std::fs::create_dir_all(place.path("in")).unwrap();
        let spacing = if modality == "split" { "14" } else { "9" };
        place.ok(&[
            "render",
            "--modality",
            modality,
            "--spacing",
            spacing,
            "--bits",
            "16",
            "--width",
            "128",
            "--height",
            "128",
            "--out",
            &image,
            "--truth",
            &truth,
            "-q",
        ]);
    }
    place.ok(&["validate", "--reference", "in", "--images", "in", "--out", "images", "-q"]);
    let rows = place.table("images/validation.csv");
    assert_eq!(rows.len(), 2);
    for row in &rows {
        assert!(number(row, "dice") > 0.85, "{row:?}");
        for column in ["tp", "fn", "fp", "sensitivity", "fdr"] {
            number(row, column);
        }
    }
    place.ok(&["detect", "in", "--out", "cones", "-q"]);
    place.ok(&["validate", "--reference", "in", "--detections", "cones", "--out", "cones_scored", "-q"]);
    assert_eq!(place.read("images/validation.csv"), place.read("cones_scored/validation.csv"));
}

#[test]
fn render_takes_cones_from_a_file_or_a_sampler() {
    let place = Place::new();
    place.write("three.csv", "x_px,y_px\n20,20\n40,40\n30.5,50\n");
    let size = ["--width", "64", "--height", "64", "--truth", "truth.csv", "-q"];
    place
        .ok(&[&["render", "--points", "three.csv", "--spacing", "10", "--out", "a.png"][..], &size].concat());
    let places = |file: &str| -> Vec<(f64, f64)> {
        place.table(file).iter().map(|row| (number(row, "x_px"), number(row, "y_px"))).collect()
    };
    assert_eq!(places("truth.csv"), places("three.csv"));
    assert!(place.table("truth.csv").iter().all(|row| row["class"] == "cone" || row["class"] == "dim"));
    let sampler = ["render", "--mosaic", "jittered", "--spacing", "8", "--out", "b.png"];
    place.ok(&[&sampler[..], &size].concat());
    let cones = place.table("truth.csv").len() as f64;
    assert!((cones / (64. * 64. / (8. * 8. * 3f64.sqrt() / 2.)) - 1.).abs() < 0.15, "{cones}");
}

#[test]
fn render_makes_many_images_and_says_what_each_is_made_from() {
    let place = Place::new();
    let size = ["--width", "64", "--height", "60", "-q"];
    let set =
        ["render", "--preset", "parafovea", "--count", "3", "--noise", "0.01..0.05", "--out", "sim.png"];
    let files = ["--truth", "sim.csv", "--truth-of", "seen", "--um-per-px", "0.5", "--manifest", "all.csv"];
    place.ok(&[&set[..], &files, &size].concat());
    let rows = place.table("all.csv");
    assert_eq!(rows.len(), 3);
    for (k, row) in rows.iter().enumerate() {
        assert_eq!(row["image"], format!("sim_00{}.png", k + 1));
        assert_eq!(row["psf"], "airy");
        let truth = place.table(&row["truth"]);
        assert_eq!(truth.len() as f64, number(row, "cones"));
        assert!(truth.iter().all(|cone| cone["class"] == "cone"));
        assert_eq!(number(&truth[0], "x_um"), 0.5 * number(&truth[0], "x_px"));
        assert!((0.01..0.05).contains(&number(row, "noise")));
    }
    assert_ne!(rows[0]["noise"], rows[1]["noise"]);
    // every image can be made again from its own seed
    let again =
        ["render", "--preset", "parafovea", "--noise", "0.01..0.05", "--seed", "2", "--out", "again.png"];
    place.ok(&[&again[..], &size].concat());
    assert_eq!(
        std::fs::read(place.path("again.png")).unwrap(),
        std::fs::read(place.path("sim_002.png")).unwrap()
    );
    let error = place.refused(&["render", "--modality", "split", "--outline", "1", "--out", "b.png"]);
    assert!(error.contains("--outline does not exist in split images"), "{error}");
}

#[test]
fn validate_says_what_it_leaves_out_and_what_is_missing() {
    let place = Place::new();
    let marks = "10,10\n20,10\n10,20\n20,20\n15,30\n30,30\n";
    place.write("marks/a_coords.csv", marks);
    place.write("marks/b.csv", marks);
    place.write("marks/gone_coords.csv", marks);
    place.write("marks/scales.csv", "a,0.4\nb,0.5\n");
    place.write("cones/a.csv", marks);
    place.write("cones/b.csv", "x,y\n9,9\n19,9\n9,19\n");
    let arguments = ["validate", "--reference", "marks", "--detections", "cones", "--out", "out"];
    let sized = [&arguments[..], &["--size", "40x40", "--border", "0"]].concat();
    let outcome = place.run(&sized);
    assert_eq!(outcome.code, 2);
    assert!(outcome.stdout.contains("left out: marks/scales.csv"), "{}", outcome.stdout);
    let failures = place.table("out/failures.csv");
    assert_eq!(failures.len(), 1);
    assert!(failures[0]["reason"].contains("no detections gone.csv in cones"));
    let rows = place.table("out/validation.csv");
    assert_eq!(rows[0]["file"], "marks/a_coords.csv");
    assert_eq!(["tp", "fn", "fp"].map(|c| rows[0][c].as_str()), ["6", "0", "0"]);
    assert_eq!(["tp", "fn", "fp"].map(|c| rows[1][c].as_str()), ["3", "3", "0"]);
    assert!((number(&rows[1], "dice") - 2. / 3.).abs() < 1e-12);
    // the mean is taken over images, not over cones
    let mean = format!("{:.4}", (1. + 2. / 3.) / 2.);
    assert!(outcome.stdout.contains(&mean), "{}", outcome.stdout);
    let unsized_run = place.run(&arguments);
    assert!(unsized_run.stderr.contains("give --size WxH"), "{}", unsized_run.stderr);
}

#[test]
fn the_origin_of_marks_moves_them_onto_the_detections() {
    let place = Place::new();
    place.write("marks/a.csv", "11,11\n21,11\n11,21\n21,21\n");
    place.write("cones/a.csv", "x_px,y_px\n10,10\n20,10\n10,20\n20,20\n");
    let shift = |origin: &str| {
        let size = ["--size", "40x40", "--origin", origin, "--out", "out", "-q"];
        place.ok(&[&["validate", "--reference", "marks", "--detections", "cones"][..], &size].concat());
        number(&place.table("out/validation.csv")[0], "localisation_px")
    };
    assert!(shift("1") < 1e-12);
    assert!((shift("0") - 2f64.sqrt()).abs() < 1e-12);
    assert!((shift("0.5") - 0.5f64.sqrt()).abs() < 1e-12);
}

#[test]
fn published_marks_are_found_as_well_as_is_asked() {
    for (modality, images, least, step) in [("confocal", 200, 0.988, 20), ("split", 184, 0.955, 23)] {
        let Some(folder) = shared(&format!("data/aoslo/{modality}"), "Dice on published marks") else {
            return;
        };
        // an optimised build is fast enough for all images; any other build tests a part of them,
        // with a lower bar
        let (step, least) = if cfg!(debug_assertions) { (step, least - 0.01) } else { (1, least) };
        let place = Place::new();
        let mut marks: Vec<_> = std::fs::read_dir(&folder)
            .unwrap()
            .map(|e| e.unwrap().path())
            .filter(|p| p.to_str().unwrap().ends_with("_coords.csv"))
            .collect();
        marks.sort();
        assert_eq!(marks.len(), images);
        for path in marks.iter().step_by(step) {
            let name = path.file_name().unwrap().to_str().unwrap();
            place.write(&format!("marks/{name}"), std::fs::read(path).unwrap());
        }
        let images = folder.to_str().unwrap();
        let arguments = ["validate", "--reference", "marks", "--origin", "1", "--images", images];
        let outcome = place.ok(&[&arguments[..], &["--out", "out"]].concat());
        let dice = place.json("out/validation.json")["dice"].as_f64().unwrap();
        println!("{modality}: mean Dice {dice:.4} of {} images", marks.len().div_ceil(step));
        assert!(dice >= least, "{modality}: {dice}");
        assert!(outcome.stdout.contains("mean over images"), "{}", outcome.stdout);
    }
}

/// Commands whose names and help are checked.
const COMMANDS: [&str; 9] =
    ["run", "detect", "measure", "compare", "validate", "sample", "paper", "render", "completions"];

#[test]
fn every_command_has_help_with_an_example_that_fits_a_terminal() {
    let place = Place::new();
    let overview = place.ok(&["--help"]).stdout;
    for command in COMMANDS {
        assert!(overview.contains(command));
        let help = place.ok(&[command, "--help"]).stdout;
        assert!(help.contains(&format!("  conemosaic {command} ")) && help.contains("Example"), "{help}");
        let common = &help[help.find("Common options:").unwrap()..];
        for option in ["--seed", "--threads", "--quiet", "--verbose"] {
            assert!(common.contains(option), "{command} {option}");
        }
        assert!(!help.contains('\u{1b}'));
        for line in help.lines() {
            assert!(line.chars().count() <= 110, "{command}: {line}");
        }
    }
}

#[test]
fn common_options_may_stand_before_and_after_the_command() {
    let place = Place::new();
    let before = place.ok(&["--seed", "4", "--threads", "2", "sample", "uniform", "-n", "9"]).stdout;
    let after = place.ok(&["sample", "uniform", "-n", "9", "--seed", "4", "--threads", "2"]).stdout;
    assert_eq!(before, after);
}

#[test]
fn quiet_success_prints_nothing() {
    let place = Place::new();
    place.image("in/a.png", 1);
    place.write("marks/a.csv", "x,y\n10,10\n20,20\n30,30\n");
    for arguments in [
        &["run", "in", "--samplers", "square", "--out", "1"][..],
        &["detect", "in", "--out", "2"],
        &["measure", "marks", "--window", "64x56", "--out", "3"],
        &["compare", "marks", "--window", "64x56", "--samplers", "square", "--out", "4"],
        &["validate", "--reference", "marks", "--images", "in", "--out", "5"],
        &["sample", "uniform", "-n", "3", "--out", "6.csv"],
        &["render", "--width", "32", "--height", "32", "--out", "7.png"],
    ] {
        let outcome = place.ok(&[arguments, &["--quiet"]].concat());
        assert_eq!((outcome.stdout.as_str(), outcome.stderr.as_str()), ("", ""), "{arguments:?}");
        let outcome = place.ok(arguments);
        assert!(!outcome.stdout.is_empty() && !outcome.stdout.contains('\u{1b}'));
    }
    place.write("in/bad.png", "text");
    let outcome = place.run(&["detect", "in", "--out", "2", "--quiet"]);
    assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""));
    assert!(outcome.stderr.contains("in/bad.png"), "failures are not kept quiet");
}

#[test]
fn shells_get_completions() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = place.ok(&["completions", shell]).stdout;
        for command in COMMANDS {
            assert!(text.contains(command), "{shell} {command}");
        }
        assert!(text.contains("scale-table"));
    }
}

#[test]
fn the_estimator_of_the_pair_correlation_function_can_be_chosen_and_is_recorded() {
    let place = Place::new();
    place.ok(&["sample", "uniform", "-n", "300", "--out", "a.csv", "-q"]);
    let common = ["measure", "a.csv", "--window", "unit", "-q", "--out"];
    place.ok(&[&common[..], &["1"]].concat());
    place.ok(&[&common[..], &["2", "--edge", "translation"]].concat());
    place.ok(&[
        &common[..],
        &["3", "--kernel", "box", "--bandwidth", "0.2", "--r-min", "0.3", "--bins", "50"],
    ]
    .concat());
    assert_ne!(place.read("1/a.pcf.csv"), place.read("2/a.pcf.csv"));
    assert_eq!(place.table("3/a.pcf.csv").len(), 50);
    assert!(place.read("2/options.json").contains("\"edge\": \"translation\""));
}

#[test]
fn detections_are_never_the_marks_themselves_and_must_be_in_px() {
    let place = Place::new();
    std::fs::create_dir(place.path("in")).unwrap();
    place.ok(&["render", "--out", "in/a.png", "--truth", "in/a_coords.csv", "-q"]);
    place.ok(&["detect", "in", "--out", "in", "-q"]);
    place.ok(&["validate", "--reference", "in", "--detections", "in", "--out", "v", "-q"]);
    let row = &place.table("v/validation.csv")[0];
    assert_eq!(place.table("v/validation.csv").len(), 1);
    assert!(number(row, "localisation_px") > 0., "marks were scored against themselves");
    place.write("um/a.csv", "x_um,y_um\n1,1\n2,2\n");
    place.write("px/a_coords.csv", "1,1\n2,2\n");
    let outcome =
        place.run(&["validate", "--reference", "px", "--detections", "um", "--size", "20x20", "--out", "w"]);
    assert_eq!(outcome.code, 2);
    assert!(place.read("w/failures.csv").contains("expected px"));
}

#[test]
fn a_window_that_samplers_cannot_fill_costs_the_comparison_and_not_the_mosaic() {
    let place = Place::new();
    let points: String = (0..40).map(|k| format!("{},{}\n", 120 * k + 7, k % 4)).collect();
    place.write("thin.csv", format!("x,y\n{points}"));
    place.ok(&["compare", "thin.csv", "--window", "5000x4", "--out", "out", "-q"]);
    let row = &place.table("out/l_infinity.csv")[0];
    assert_eq!(row["n"], "40");
    let warnings = &row["warnings"];
    assert!(
        warnings
            .contains("not compared with triangular (its l-infinity stays empty): it placed fewer than 2 of"),
        "{warnings}"
    );
}

#[test]
fn samples_are_drawn_in_the_window_asked_for() {
    let place = Place::new();
    place.write("corners.csv", "x,y\n0,0\n40,0\n0,30\n");
    let list = place.ok(&["sample", "--list"]).stdout;
    let names = list.lines().skip(2).take_while(|line| !line.starts_with('*'));
    let names: Vec<&str> = names.filter_map(|line| line.split_whitespace().next()).collect();
    assert!(names.len() >= 17, "{names:?}");
    for name in names {
        for (window, x, y) in [
            ("150x90", (-0.5, 149.5), (-0.5, 89.5)),
            ("-7,2,-3,5", (-7., -3.), (2., 5.)),
            ("corners.csv", (0., 40.), (0., 30.)),
        ] {
            let text = place.ok(&["sample", name, "-n", "80", "--window", window]).stdout;
            let points: Vec<(f64, f64)> = text
                .lines()
                .skip(1)
                .map(|line| line.split_once(',').unwrap())
                .map(|(x, y)| (x.parse().unwrap(), y.parse().unwrap()))
                .collect();
            assert!((60..=100).contains(&points.len()), "{name} {window}: {}", points.len());
            let within = |v: f64, (low, high): (f64, f64)| v >= low && v < high;
            assert!(points.iter().all(|p| within(p.0, x) && within(p.1, y)), "{name} {window}");
            let reach = points.iter().map(|p| p.0).fold(f64::NEG_INFINITY, f64::max);
            assert!(reach > x.0 + 0.6 * (x.1 - x.0), "{name} {window}: {reach}");
        }
    }
    place.ok(&[
        "sample",
        "bridson",
        "-n",
        "80",
        "--window",
        "150x90",
        "--torus",
        "--out",
        "points.csv",
        "-q",
    ]);
    place.ok(&["measure", "points.csv", "--window", "150x90", "--out", "measured", "-q"]);
    let refused = |window: &[&str]| place.refused(&[&["sample", "uniform", "-n", "9"], window].concat());
    assert!(refused(&["--window", "corners.csv", "--torus"]).contains("--torus"));
    assert!(refused(&["--window", "image"]).contains("WxH"));
    assert!(refused(&["--window", "1e9,0,2e9,1"]).contains("times as long as wide"));
}
