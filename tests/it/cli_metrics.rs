//! Columns of summaries: their definitions, choice and units; manifests and groups.

use crate::common::{self, Place, number};
use std::path::Path;

/// Writes two files of marks in windows of 60 × 60. One has twice as many marks along each axis as
/// the other.
fn two_files() -> Place {
    let place = Place::new();
    for (name, step) in [("A1_sparse", 10.), ("B2_dense", 5.)] {
        let mut text = String::from("x,y\n");
        let side = (60. / step) as usize;
        for k in 0..side * side {
            let (i, j) = ((k % side) as f64, (k / side) as f64);
            // a perfect lattice would have no regularity index
            let shift = 0.1 * ((7 * k % 5) as f64 - 2.);
            text.push_str(&format!("{},{}\n", step * (i + 0.5) + shift, step * (j + 0.5) - shift));
        }
        place.write(&format!("in/{name}.csv"), text);
    }
    place
}

/// Arguments that measure the two files of marks.
const MEASURE: [&str; 6] = ["measure", "in", "--window", "0,0,60,60", "--out", "out"];

fn measured(place: &Place, more: &[&str]) -> common::Outcome {
    place.ok(&[&MEASURE[..], more].concat())
}

#[test]
fn the_data_dictionary_is_the_programs_own() {
    let place = Place::new();
    let page = place.ok(&["metrics", "--markdown"]).stdout;
    let kept =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("DATA_DICTIONARY.md")).unwrap();
    assert_eq!(kept, page, "make it anew: conemosaic metrics --markdown > DATA_DICTIONARY.md");
    let list = place.ok(&["metrics", "--list"]).stdout;
    place.write("dictionary.csv", place.ok(&["metrics", "--csv"]).stdout);
    let rows = place.table("dictionary.csv");
    for row in &rows {
        assert!(
            list.contains(&row["column"]) && page.contains(&row["column"]) && !row["definition"].is_empty(),
            "{}",
            row["column"]
        );
    }
    let place = two_files();
    measured(&place, &["--functions", "--spectrum", "--maps", "--roi-side", "30", "--group-by", "^(.)"]);
    let told = |table: &str, column: &str| {
        let row = rows.iter().find(|r| {
            r["table"] == table
                && r["column"] == column
                && (table != "summary.csv" || r["commands"].contains("measure"))
        });
        row.is_some_and(|r| !r["definition"].is_empty() && !r["unit"].is_empty())
    };
    for column in place.header("out/summary.csv") {
        assert!(told("summary.csv", &column), "{column}");
    }
    let own = ["pcf", "functions", "points", "density_recovery", "spectrum", "maps", "profiles"]
        .map(|kind| (format!("NAME.{kind}.csv"), format!("out/B2_dense.{kind}.csv")));
    let of_all = ["landmarks.csv", "groups.csv"].map(|name| (name.to_owned(), format!("out/{name}")));
    for (table, file) in own.into_iter().chain(of_all) {
        for column in place.header(&file) {
            assert!(told(&table, &column), "{table}: {column}");
        }
    }
    let places = rows.iter().filter(|r| r["table"] == "rois.csv").map(|r| &r["column"]);
    assert!(place.header("out/rois.csv").iter().zip(places).all(|(a, b)| a == b));
}

#[test]
fn lengths_areas_and_densities_come_in_all_units() {
    let place = two_files();
    measured(&place, &["--um-per-px", "0.5", "--um-per-degree", "300"]);
    for row in place.table("out/summary.csv") {
        let value = |name: &str| number(&row, name);
        let close = |a: f64, b: f64| assert!((a / b - 1.).abs() < 1e-12, "{a} {b}");
        close(value("nn_mean_um"), 0.5 * value("nn_mean"));
        close(value("nn_mean_deg"), value("nn_mean_um") / 300.);
        close(value("nn_mean_arcmin"), 60. * value("nn_mean_deg"));
        close(value("density_per_mm2"), value("density") * 1e6 / 0.25);
        close(value("density_per_deg2"), value("density_per_mm2") * 0.09);
        close(value("density_per_arcmin2"), value("density_per_deg2") / 3600.);
        close(value("window_area_mm2"), 3600. * 0.25e-6);
        close(value("window_area_deg2"), value("window_area_mm2") / 0.09);
    }
    let objects = place.json("out/summary.json");
    let rows = place.table("out/summary.csv");
    for (object, row) in objects.as_array().unwrap().iter().zip(&rows) {
        assert_eq!(object["nn_mean_deg"].as_f64().unwrap(), number(row, "nn_mean_deg"));
        assert_eq!(object.as_object().unwrap().len(), row.len());
    }
    measured(&place, &[]);
    let row = &place.table("out/summary.csv")[0];
    assert!(row["nn_mean_um"].is_empty() && row["density_per_deg2"].is_empty() && !row["nn_mean"].is_empty());
}

#[test]
fn metrics_are_chosen_by_group_metric_or_column_and_shown() {
    let place = two_files();
    let outcome = measured(&place, &["--metrics", "regularity,nn_mean_um,density", "--um-per-px", "0.5"]);
    let header = place.header("out/summary.csv");
    let expected = [
        "file",
        "unit",
        "n",
        "warnings",
        "density",
        "density_per_px2",
        "density_per_mm2",
        "density_per_deg2",
        "density_per_arcmin2",
    ];
    assert!(header.starts_with(&expected.map(str::to_owned)), "{header:?}");
    assert!(header.contains(&"clark_evans_naive".to_owned()) && header.contains(&"nn_mean_um".to_owned()));
    assert!(!header.contains(&"nn_mean".to_owned()) && !header.contains(&"n_bound".to_owned()));
    for words in ["nn_mean_um (µm)", "density_per_mm2 (1/mm²)", "clark_evans_donnelly"] {
        assert!(outcome.stdout.contains(words), "{}", outcome.stdout);
    }
    let complaint = place.refused(&[&MEASURE[..], &["--metrics", "nearest,beauty"]].concat());
    assert!(complaint.contains("beauty") && complaint.contains("voronoi"), "{complaint}");
}

#[test]
fn a_manifest_is_carried_through_and_brings_what_is_expected_there() {
    let place = two_files();
    place.write(
        "manifest.csv",
        "identifier,subject,eccentricity_deg,meridian,n\nA1,s1,2.5,temporal,x\nB2,s2,,,y\n",
    );
    measured(&place, &["--manifest", "manifest.csv", "--um-per-px", "0.5", "--um-per-degree", "400"]);
    let rows = place.table("out/summary.csv");
    assert_eq!((rows[0]["subject"].as_str(), rows[1]["subject"].as_str()), ("s1", "s2"));
    assert_eq!(rows[0]["manifest_n"], "x");
    // the manifest puts the image 1 mm temporal of the fovea
    assert_eq!((number(&rows[0], "eccentricity_mm"), rows[0]["meridian"].as_str()), (1., "temporal"));
    assert_eq!(number(&rows[0], "density_expected_per_mm2"), 21_000.);
    let spacing = number(&rows[0], "spacing_expected_um");
    assert!((3f64.sqrt() / 2. * spacing * spacing * 21_000e-6 - 1.).abs() < 1e-12);
    let share = number(&rows[0], "density_per_mm2") / 21_000.;
    assert!((number(&rows[0], "density_of_expected_percent") / share - 100.).abs() < 1e-9);
    assert!(rows[1]["density_expected_per_mm2"].is_empty());
    // 40 000 cones per mm² are 1.9 times the expected density; with half the scale the density is
    // four times as high
    assert_eq!(rows[0]["warnings"].matches("average eye").count(), 0, "{}", rows[0]["warnings"]);
    measured(&place, &["--manifest", "manifest.csv", "--um-per-px", "0.25", "--um-per-degree", "400"]);
    let warnings = &place.table("out/summary.csv")[0]["warnings"];
    assert!(warnings.contains("7.6 times that of the average eye"), "{warnings}");

    place.write("manifest.csv", "identifier,subject\nA1,s1\n");
    measured(&place, &["--manifest", "manifest.csv"]);
    let rows = place.table("out/summary.csv");
    assert!(rows[1]["subject"].is_empty() && rows[1]["warnings"].contains("manifest.csv"), "{:?}", rows[1]);
    place.write("manifest.csv", "identifier,meridian\nA1,sideways\n");
    let complaint = place.refused(&[&MEASURE[..], &["--manifest", "manifest.csv"]].concat());
    assert!(complaint.contains("manifest.csv") && complaint.contains("line 2"), "{complaint}");
}

#[test]
fn groups_have_means_deviations_and_numbers() {
    let place = two_files();
    place.write("manifest.csv", "identifier,eye,subject\nA1,OD,s1\nB2,OD,s2\n");
    measured(&place, &["--manifest", "manifest.csv", "--group-by", "column:eye"]);
    let summary = place.table("out/summary.csv");
    let densities = [number(&summary[0], "density"), number(&summary[1], "density")];
    let groups = place.table("out/groups.csv");
    let row = groups.iter().find(|r| r["column"] == "density").unwrap();
    assert_eq!((row["group"].as_str(), row["images"].as_str(), row["n"].as_str()), ("OD", "2", "2"));
    assert!((number(row, "mean") - (densities[0] + densities[1]) / 2.).abs() < 1e-15);
    let sd = (densities[0] - densities[1]).abs() / 2f64.sqrt();
    assert!((number(row, "sd") - sd).abs() < 1e-15);
    // each of the two subjects has one image, so the standard error is that of the subjects' means
    assert_eq!(row["subjects"], "2");
    assert!((number(row, "se") - sd / 2f64.sqrt()).abs() < 1e-15);
    assert!(number(row, "mean_low") < number(row, "mean_of_subjects"), "{row:?}");
    measured(&place, &["--manifest", "manifest.csv", "--group-by", "column:eye,subject"]);
    let groups = place.table("out/groups.csv");
    assert!(groups.iter().any(|r| r["group"] == "OD, s2" && r["n"] == "1" && r["sd"].is_empty()));
    measured(&place, &["--group-by", "^(.)"]);
    assert!(place.table("out/groups.csv").iter().any(|r| r["group"] == "A"));
    for (rule, words) in [("column:age", "eye, subject"), ("column:", "column:NAME")] {
        let arguments = ["--manifest", "manifest.csv", "--group-by", rule];
        let complaint = place.refused(&[&MEASURE[..], &arguments].concat());
        assert!(complaint.contains(words), "{complaint}");
    }
    let complaint = place.refused(&[&MEASURE[..], &["--group-by", "column:eye"]].concat());
    assert!(complaint.contains("--manifest"), "{complaint}");
    measured(&place, &[]);
    assert!(!place.path("out/groups.csv").exists());
}

#[test]
fn a_run_takes_manifest_groups_and_metrics_and_resumes_by_them() {
    let place = Place::new();
    place.image("in/a_1.png", 1);
    place.image("in/b_1.png", 2);
    place.write("m.csv", "identifier,subject,eccentricity_mm\na_,s1,1\nb_,s2,3\n");
    let run = [
        "run",
        "in",
        "--out",
        "out",
        "--samplers",
        "jittered",
        "--um-per-px",
        "0.5",
        "--resume",
        "--manifest",
        "m.csv",
    ];
    let more = ["--group-by", "column:subject", "--metrics", "expected,samplers,density_per_mm2,fourier"];
    let outcome = place.ok(&[&run[..], &more].concat());
    assert!(outcome.stdout.contains("density_per_mm2 (1/mm²)"), "{}", outcome.stdout);
    let rows = place.table("out/summary.csv");
    assert_eq!(number(&rows[1], "density_expected_per_mm2"), (8700f64 + 9000. + 7600. + 7600.) / 4.);
    assert!(!rows[0]["l_infinity_jittered"].is_empty() && !rows[0].contains_key("nn_mean_px"));
    assert!(place.table("out/groups.csv").iter().any(|r| r["group"] == "s2" && r["column"] == "n"));
    assert!(place.ok(&run).stdout.contains("2 kept"));
    assert_eq!(place.table("out/summary.csv")[0]["subject"], "s1");
    // a number is computed only if a column needs it, and then also for results kept from an
    // earlier run
    let spacing = |out: &str| {
        place.json(&format!("{out}/images/a_1/metrics.json"))["fourier"]["all"]["spacing"].as_f64()
    };
    assert!(spacing("out").is_some());
    let few = ["run", "in", "--samplers", "jittered", "--resume", "--out", "few"];
    place.ok(&[&few[..], &["--metrics", "density"]].concat());
    assert_eq!(spacing("few"), None);
    assert!(place.ok(&[&few[..], &["--metrics", "nearest"]].concat()).stdout.contains("2 kept"));
    assert!(!place.ok(&[&few[..], &["--metrics", "fourier_spacing"]].concat()).stdout.contains("kept"));
    assert!(spacing("few").is_some());
    place.write("m.csv", "identifier,subject,eccentricity_mm\na_,s1,1\nb_,s3,3\n");
    assert!(place.ok(&run).stdout.contains("1 kept"));
    assert_eq!(place.table("out/summary.csv")[1]["subject"], "s3");
}
