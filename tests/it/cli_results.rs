//! Results are never lost and never mixed: the content of a result folder after failures, kills,
//! other options and a person's corrections.

use crate::common::{Place, number};
use std::fs;

/// Arguments of a run without comparison with samplers.
const RUN: [&str; 6] = ["run", "in", "--out", "out", "--samplers", "none"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&RUN[..], more].concat()
}

/// Makes a folder of `n` small images.
fn images(n: u32) -> Place {
    let place = Place::new();
    for seed in 1..=n {
        place.image(&format!("in/{seed}.png"), seed);
    }
    place
}

fn append(place: &Place, file: &str, text: &str) {
    place.write(file, place.read(file) + text);
}

/// Returns the files in the folder of earlier results, by the path that they had in the result
/// folder.
fn put_away(place: &Place, out: &str) -> Vec<String> {
    place.names(&format!("{out}/.conemosaic/earlier"))
}

#[test]
fn an_image_that_fails_now_keeps_its_results_and_says_so_beside_them() {
    let place = images(3);
    place.ok(&RUN);
    let before = place.results("out");
    place.write("scales.csv", "identifier,um_per_px\nnobody,0.5\n");
    let damaged = place.read_bytes("in/1.png");
    for arguments in [with(&["--scale-table", "scales.csv"]), with(&["--crop", "500,500,600,600", "--fresh"])]
    {
        let outcome = place.run(&arguments);
        assert_eq!(outcome.code, 2, "{}", outcome.stderr);
        assert!(
            outcome.stderr.contains("the results of an earlier run stay in images/1"),
            "{}",
            outcome.stderr
        );
        for (file, bytes) in before.iter().filter(|(file, _)| file.starts_with("images/")) {
            assert_eq!(&place.read_bytes(&format!("out/{file}")), bytes, "{file}");
        }
        assert!(place.read("out/images/2/FAILED.txt").contains("missing from summary.csv"));
        assert!(place.table("out/summary.csv").is_empty());
    }
    place.write("in/1.png", &damaged[..200]);
    assert_eq!(place.run(&RUN).code, 2);
    assert_eq!(place.table("out/summary.csv").len(), 2);
    assert!(
        place.path("out/images/1/points.csv").is_file() && place.path("out/images/1/FAILED.txt").is_file()
    );
    place.write("in/1.png", &damaged);
    place.ok(&RUN);
    assert_eq!(place.results("out"), before);
}

#[test]
fn a_folder_holds_one_run() {
    let place = images(3);
    place.ok(&with(&["--maps", "--map-cells", "10"]));
    assert!(place.path("out/landmarks.csv").is_file());
    fs::remove_file(place.path("in/3.png")).unwrap();
    let outcome = place.ok(&RUN);
    assert!(outcome.stdout.contains("of earlier results that this run does not have"), "{}", outcome.stdout);
    place.ok(&["run", "in", "--out", "other", "--samplers", "none"]);
    assert_eq!(place.results("out"), place.results("other"));
    let away = put_away(&place, "out");
    assert!(away.contains(&"landmarks.csv".to_owned()) && away.contains(&"images/3/points.csv".to_owned()));
    place.write("out/images/notes/mine.txt", "a person's");
    let outcome = place.ok(&RUN);
    assert!(outcome.stdout.contains("left where they are: images/notes"), "{}", outcome.stdout);
    assert!(place.path("out/images/notes/mine.txt").is_file());
}

#[test]
fn results_of_files_that_fail_now_do_not_stand_beside_the_others() {
    let place = Place::new();
    for name in ["a", "b"] {
        place.write(&format!("in/{name}.csv"), "x,y\n1.5,1\n5,5.25\n9,1\n3,7\n");
    }
    let measure = ["measure", "in", "--window", "10x10", "--out", "out"];
    place.ok(&measure);
    place.write("in/b.csv", "x,y\n1,one\n");
    assert_eq!(place.run(&measure).code, 2);
    assert!(!place.path("out/b.pcf.csv").exists());
    assert_eq!(put_away(&place, "out"), ["b.pcf.csv"]);
    let place = images(2);
    place.ok(&["detect", "in", "--out", "out", "--overlay"]);
    place.write("in/2.png", "no image");
    assert_eq!(place.run(&["detect", "in", "--out", "out"]).code, 2);
    assert_eq!(place.names("out"), ["1.csv", "failures.csv"]);
    assert_eq!(put_away(&place, "out"), ["1.overlay.png", "2.csv", "2.overlay.png"]);
}

#[test]
fn a_changed_file_of_a_result_is_made_anew() {
    let place = images(2);
    place.ok(&RUN);
    let before = place.results("out");
    for file in ["figure.svg", "pcf.csv", "overlay.png", "metrics.json", "points.csv"] {
        let path = place.path(&format!("out/images/1/{file}"));
        let bytes = fs::read(&path).unwrap();
        // a points.csv that ends within a line was cut off while it was written, and is no
        // correction
        fs::write(&path, &bytes[..bytes.len() / 2 - 3]).unwrap();
        let outcome = place.ok(&RUN);
        assert!(outcome.stdout.contains("1 kept"), "{file}: {}", outcome.stdout);
        assert_eq!(place.results("out"), before, "{file}");
    }
}

#[test]
fn a_missing_file_of_any_kind_is_made_anew() {
    let place = images(1);
    let run = with(&["--spectrum", "--functions", "--figures", "svg,pdf"]);
    place.ok(&run);
    let before = place.results("out");
    for file in ["spectrum.csv", "spectrum.png", "cells.csv", "figure.pdf"] {
        fs::remove_file(place.path(&format!("out/images/1/{file}"))).unwrap();
        assert!(!place.ok(&run).stdout.contains("kept"), "{file}");
        assert_eq!(place.results("out"), before, "{file}");
    }
    assert!(place.ok(&run).stdout.contains("1 kept"));
}

#[test]
fn corrected_cones_are_used_and_never_replaced_unasked() {
    let place = images(2);
    place.ok(&with(&["--um-per-px", "0.5"]));
    let found = number(&place.table("out/summary.csv")[0], "n");
    append(&place, "out/images/1/points.csv", "20.25,20.5\n");
    let corrected = place.read("out/images/1/points.csv");
    for more in [&["--um-per-px", "0.5"][..], &["--um-per-px", "0.4"]] {
        place.ok(&with(more));
        let row = &place.table("out/summary.csv")[0];
        assert_eq!((number(row, "n"), row["cones_from"].as_str()), (found + 1., "corrected"));
        assert_eq!(place.read("out/images/1/points.csv"), corrected);
        assert_eq!(place.json("out/images/1/metrics.json")["mosaic"]["n"], found + 1.);
    }
    assert!(place.ok(&with(&["--um-per-px", "0.4"])).stdout.contains("2 kept"));
    place.write("marks/1.csv", "x,y\n5,5\n9,9.5\n");
    for more in [&["--fresh"][..], &["--cones", "marks/1.csv"]] {
        let outcome = place.run(&with(more));
        assert!(outcome.code == 2 && outcome.stderr.contains("--replace-corrections"), "{}", outcome.stderr);
        assert_eq!(place.read("out/images/1/points.csv"), corrected);
    }
    place.ok(&with(&["--replace-corrections"]));
    let row = &place.table("out/summary.csv")[0];
    assert_eq!((number(row, "n"), row["cones_from"].as_str()), (found, "detected"));
    assert_eq!(place.read("out/.conemosaic/earlier/images/1/points.csv"), corrected);
}

#[test]
fn detection_replaces_neither_corrections_nor_hand_marks() {
    let place = images(1);
    let detect = ["detect", "in", "--out", "out"];
    place.ok(&detect);
    place.ok(&detect);
    append(&place, "out/1.csv", "20.25,20.5,1\n");
    let corrected = place.read("out/1.csv");
    let outcome = place.run(&detect);
    assert!(outcome.code == 2 && outcome.stderr.contains("--replace-corrections"), "{}", outcome.stderr);
    assert_eq!(place.read("out/1.csv"), corrected);
    place.ok(&[&detect[..], &["--replace-corrections"]].concat());
    assert_eq!(place.read("out/.conemosaic/earlier/1.csv"), corrected);
    place.write("marks/1.csv", "x,y\n5,5\n");
    assert_eq!(place.run(&["detect", "in", "--out", "marks"]).code, 2);
    assert_eq!(place.read("marks/1.csv"), "x,y\n5,5\n");
}

#[test]
fn marks_from_anywhere_get_what_detections_get() {
    let place = images(2);
    place.ok(&RUN);
    fs::create_dir_all(place.path("marks")).unwrap();
    place.write("marks/1_coords.csv", "x,y\n6,6\n12.5,6\n9.25,12\n30,30.5\n70,3\n");
    place.write("marks/2.csv", "x_um,y_um\n3,3\n6,3\n9,3.5\n");
    let given =
        ["run", "in", "--cones", "marks", "--um-per-px", "0.5", "--samplers", "none", "--out", "by_hand"];
    place.ok(&given);
    let rows = place.table("by_hand/summary.csv");
    assert_eq!((rows[0]["n"].as_str(), rows[1]["n"].as_str()), ("4", "3"));
    assert_eq!((rows[0]["cones_from"].as_str(), rows[0]["detector"].as_str()), ("given", ""));
    assert!(rows[0]["warnings"].contains("1 point lies outside the window"), "{}", rows[0]["warnings"]);
    assert_eq!(place.table("by_hand/images/2/points.csv")[1]["x_px"], "12");
    for file in ["figure.svg", "overlay.png", "pcf.csv", "metrics.json"] {
        assert!(place.path(&format!("by_hand/images/1/{file}")).is_file(), "{file}");
    }
    // the cones that a run has written can be read by another run, and lead to the same numbers
    place.ok(&["run", "in", "--cones", "out/images", "--samplers", "none", "--out", "again"]);
    for column in ["n", "nn_mean_px", "ri", "density_per_px2"] {
        let of = |folder: &str| place.table(&format!("{folder}/summary.csv"))[1][column].clone();
        assert_eq!(of("out"), of("again"), "{column}");
    }
    fs::remove_file(place.path("marks/2.csv")).unwrap();
    let outcome = place.run(&["run", "in", "--cones", "marks", "--samplers", "none", "--out", "fewer"]);
    assert!(outcome.code == 2 && outcome.stderr.contains("its cones are not in marks"), "{}", outcome.stderr);
    place.write("marks/1.csv", "x,y\n1,1\n");
    let outcome = place.run(&["run", "in/1.png", "--cones", "marks", "--samplers", "none", "--out", "two"]);
    assert!(outcome.code == 2 && outcome.stderr.contains("have its name"), "{}", outcome.stderr);
}

#[test]
fn every_option_works_in_every_command() {
    let place = images(1);
    let asked = ["--functions", "--spectrum", "--roi-side", "30", "--maps", "--map-cells", "10", "--verdict"];
    let quick = ["--simulations", "39", "--samplers", "uniform"];
    place.ok(&[&["run", "in", "--out", "run"][..], &asked, &quick].concat());
    place.ok(&["run", "in", "--out", "plain", "--samplers", "none"]);
    let points = "plain/images/1/points.csv";
    place.copy(points, "cones/1.csv");
    place.ok(&[&["measure", "cones", "--images", "in", "--out", "measured"][..], &asked, &quick].concat());
    place.ok(&[&["compare", "cones", "--images", "in", "--out", "compared"][..], &asked[..7], &quick].concat());
    let of = |folder: &str, row: usize, column: &str| {
        place.table(&format!("{folder}/summary.csv"))[row][column].clone()
    };
    for column in ["n", "nn_mean_px", "ri", "l_infinity_uniform", "closest_sampler", "window_area_px2"] {
        assert_eq!(of("run", 0, column), of("measured", 0, column), "{column}");
        assert_eq!(of("run", 0, column), of("compared", 0, column), "{column}");
    }
    for (mine, theirs) in [
        ("pcf.csv", "1.pcf.csv"),
        ("functions.csv", "1.functions.csv"),
        ("density_recovery.csv", "1.density_recovery.csv"),
        ("cells.csv", "1.points.csv"),
        ("spectrum.csv", "1.spectrum.csv"),
        ("maps.csv", "1.maps.csv"),
        ("envelope.csv", "1.envelope.csv"),
    ] {
        let run = place.read(&format!("run/images/1/{mine}"));
        assert_eq!(run, place.read(&format!("measured/{theirs}")), "{mine}");
        assert_eq!(run, place.read(&format!("compared/{theirs}")), "{mine}");
    }
    for table in ["landmarks.csv", "verdicts.csv", "rois.csv"] {
        assert_eq!(
            place.table(&format!("run/{table}")).len(),
            place.table(&format!("measured/{table}")).len()
        );
    }
    place.ok(&["run", "in", "--out", "drawn", "--samplers", "none", "--figures", "svg,pdf,png"]);
    assert!(place.read_bytes("drawn/images/1/figure.pdf").starts_with(b"%PDF"));
    assert!(place.read_bytes("drawn/images/1/figure.png").starts_with(b"\x89PNG"));
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::process::{Child, Command, Stdio};
    use std::time::{Duration, Instant};

    /// Starts a batch that takes some seconds, and returns as soon as it has begun to write
    /// results.
    fn begun(place: &Place) -> Child {
        let child = Command::new(env!("CARGO_BIN_EXE_conemosaic"))
            .current_dir(place.path(""))
            .args(with(&[
                "--threads",
                "1",
                "--verdict",
                "--simulations",
                "199",
                "--samplers",
                "dart-throwing",
            ]))
            .args(["-q"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let started = Instant::now();
        while !place.path("out/images/1/metrics.json").is_file() {
            assert!(started.elapsed() < Duration::from_secs(60), "nothing was written");
            std::thread::sleep(Duration::from_millis(5));
        }
        child
    }

    fn signal(child: &Child, name: &str) {
        let sent = Command::new("kill").args([format!("-{name}"), child.id().to_string()]).status().unwrap();
        assert!(sent.success());
    }

    fn many() -> Place {
        let place = images(1);
        for copy in 2..=40 {
            place.copy("in/1.png", &format!("in/{copy}.png"));
        }
        place
    }

    #[test]
    fn a_killed_run_is_marked_and_ends_like_an_undisturbed_one() {
        let place = many();
        let mut child = begun(&place);
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(place.read("out/INCOMPLETE.txt").contains("run the same command again"));
        let arguments = with(&["--verdict", "--simulations", "199", "--samplers", "dart-throwing"]);
        let outcome = place.ok(&arguments);
        assert!(outcome.stdout.contains("kept from an earlier run"), "{}", outcome.stdout);
        assert!(!place.path("out/INCOMPLETE.txt").exists());
        let elsewhere: Vec<&str> =
            arguments.iter().map(|a| if *a == "out" { "undisturbed" } else { *a }).collect();
        place.ok(&elsewhere);
        assert_eq!(place.results("out"), place.results("undisturbed"));
        let ledger = |out: &str| place.read(&format!("{out}/.conemosaic/files.sha256"));
        assert_eq!(ledger("out"), ledger("undisturbed"));
    }

    #[test]
    fn a_second_run_into_the_same_folder_is_refused_at_once() {
        let place = many();
        let mut child = begun(&place);
        let complaint = place.refused(&RUN);
        assert!(complaint.contains("another command is writing into this folder"), "{complaint}");
        child.kill().unwrap();
        child.wait().unwrap();
        place.ok(&RUN);
    }

    #[test]
    fn signals_end_a_run_with_the_tables_of_what_is_done() {
        let place = many();
        for (name, code) in [("INT", 130), ("TERM", 143)] {
            let child = begun(&place);
            signal(&child, name);
            let output = child.wait_with_output().unwrap();
            assert_eq!(output.status.code(), Some(code), "{}", String::from_utf8_lossy(&output.stderr));
            let done = place.table("out/summary.csv").len();
            assert!((1..40).contains(&done), "{done}");
            assert!(place.path("out/INCOMPLETE.txt").is_file());
            fs::remove_dir_all(place.path("out")).unwrap();
        }
    }
}
