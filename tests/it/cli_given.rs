//! Marks from anywhere get what detections get, and every option works in every command.

use crate::common::{Place, number};

const RUN: [&str; 6] = ["run", "in", "--samplers", "none", "-q", "--out"];

fn marks(place: &Place, folder: &str, factor: f64, header: &str) {
    for (name, seed) in [("a", "1"), ("b", "2")] {
        place.write("raw/.keep", "");
        let raw = format!("raw/{name}.csv");
        place.ok(&[
            "sample",
            "dart-throwing",
            "-n",
            "60",
            "--window",
            "64x56",
            "--seed",
            seed,
            "--out",
            &raw,
        ]);
        let columns = place.header(&raw);
        let of = |row, column: usize| factor * number(row, &columns[column]);
        let rows = place.table(&raw);
        let rows: String = rows.iter().map(|row| format!("{},{}\n", of(row, 0), of(row, 1))).collect();
        place.write(&format!("{folder}/{name}_coords.csv"), format!("{header}\n{rows}"));
    }
}

fn two_images() -> Place {
    let place = Place::new();
    place.image("in/a.png", 1);
    place.image("in/b.png", 2);
    place
}

#[test]
fn given_cones_get_the_whole_report() {
    let place = two_images();
    marks(&place, "marks", 1., "x,y");
    place.ok(&[&RUN[..], &["out", "--cones", "marks"]].concat());
    let rows = place.table("out/summary.csv");
    assert!(rows.iter().all(|row| row["n"] == "60"), "{rows:?}");
    for file in ["figure.svg", "overlay.png", "pcf.csv", "points.csv", "metrics.json"] {
        assert!(place.path("out/images/a").join(file).exists(), "{file}");
    }
    assert_eq!(place.json("out/images/a/metrics.json")["cones_from"], "given");
    // the folder of a report serves as marks, and so does one file
    place.ok(&[&RUN[..], &["again", "--cones", "out/images"]].concat());
    assert_eq!(place.files("again")["images/b/points.csv"], place.files("out")["images/b/points.csv"]);
    let one = ["run", "in/a.png", "--samplers", "none", "-q", "--out", "one"];
    place.ok(&[&one[..], &["--cones", "marks/b_coords.csv"]].concat());
    assert_eq!(place.files("one")["images/a/points.csv"], place.files("out")["images/b/points.csv"]);
    // as measure sees the same marks
    place.ok(&["measure", "marks", "--images", "in", "--window", "image", "--out", "measured", "-q"]);
    let measured = place.table("measured/summary.csv");
    assert_eq!(measured[0]["ri"], rows[0]["ri"]);
}

#[test]
fn marks_in_micrometres_need_a_scale() {
    let place = two_images();
    marks(&place, "marks", 0.5, "x_um,y_um");
    let run = [&RUN[..], &["out", "--cones", "marks"]].concat();
    let outcome = place.run(&run);
    assert!(outcome.code == 2 && outcome.stderr.contains("--um-per-px"), "{}", outcome.stderr);
    place.ok(&[&run[..], &["--um-per-px", "0.5"]].concat());
    let row = &place.table("out/summary.csv")[0];
    assert!(number(row, "n") == 60. && (number(row, "density_per_px2") - 60. / (64. * 56.)).abs() < 1e-9);
}

#[test]
fn marks_that_are_missing_or_not_the_only_ones_are_failures_of_their_image() {
    let place = two_images();
    marks(&place, "marks", 1., "x,y");
    place.copy("marks/a_coords.csv", "marks/old/a.csv");
    std::fs::remove_file(place.path("marks/b_coords.csv")).unwrap();
    let outcome = place.run(&[&RUN[..], &["out", "--cones", "marks"]].concat());
    assert_eq!(outcome.code, 2);
    let failures = place.table("out/failures.csv");
    assert!(failures[0]["reason"].contains("leave one of them"), "{failures:?}");
    assert!(failures[1]["reason"].contains("no file of cones for it"), "{failures:?}");
}

#[test]
fn options_work_in_every_command() {
    let place = two_images();
    marks(&place, "marks", 1., "x,y");
    let out = |name: &'static str| ["--out", name, "-q", "--samplers", "uniform"];
    let more = ["--functions", "--spectrum", "--roi-side", "28", "--maps", "--map-cells", "5"];
    place.ok(&[&["run", "in"][..], &out("run"), &more].concat());
    for file in
        ["functions.csv", "density_recovery.csv", "cells.csv", "spectrum.csv", "spectrum.png", "maps.csv"]
    {
        assert!(place.path("run/images/a").join(file).exists(), "{file}");
    }
    let verdict = ["--images", "in", "--verdict", "--simulations", "39"];
    place.ok(&[&["measure", "marks"][..], &out("measure"), &more, &verdict].concat());
    place.ok(&[&["compare", "marks", "--images", "in"][..], &out("compare"), &more].concat());
    for folder in ["run", "measure", "compare"] {
        for table in ["landmarks.csv", "rois.csv", "summary.csv"] {
            assert!(place.path(folder).join(table).exists(), "{folder}/{table}");
        }
    }
    assert_eq!(place.table("measure/verdicts.csv").len(), 2);
    assert_eq!(place.names("compare").iter().filter(|n| n.ends_with(".maps.csv")).count(), 2);
}
