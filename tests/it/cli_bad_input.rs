//! Wrong arguments and broken files give one clear line and the right exit code, and leave nothing
//! half written.

use crate::common::Place;
use std::fs;

/// Returns a PNG in which all pixels have the same grey value.
fn flat_png(width: u32, height: u32, value: u8) -> Vec<u8> {
    let mut bytes = Vec::new();
    let image = image::GrayImage::from_pixel(width, height, image::Luma([value]));
    image.write_to(&mut std::io::Cursor::new(&mut bytes), image::ImageFormat::Png).unwrap();
    bytes
}

fn float_tiff(pages: usize, value: impl Fn(usize) -> f32) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut bytes).unwrap();
    let pixels: Vec<f32> = (0..64 * 64).map(value).collect();
    for _ in 0..pages {
        encoder.write_image::<tiff::encoder::colortype::Gray32Float>(64, 64, &pixels).unwrap();
    }
    bytes.into_inner()
}

/// Makes a folder with one good image and one bad image of every kind in [`BAD`].
fn mixed() -> Place {
    let place = Place::new();
    place.image("mixed/good.png", 1);
    let good = fs::read(place.path("mixed/good.png")).unwrap();
    place.write("mixed/truncated.png", &good[..good.len() / 2]);
    place.write("mixed/text.png", "x,y\n1,2\n");
    place.write("mixed/nothing.png", "");
    place.write("mixed/three.png", flat_png(3, 3, 9));
    place.write("mixed/black.png", flat_png(64, 64, 0));
    place.write("mixed/constant.png", flat_png(64, 64, 77));
    place.write("mixed/nan.tif", float_tiff(1, |i| if i == 70 { f32::NAN } else { i as f32 }));
    place.write("mixed/pages.tif", float_tiff(3, |i| i as f32));
    // a PNG of 0 × 0 px: the size in its header is set to zero
    let mut zero = flat_png(1, 1, 0);
    zero[16..24].fill(0);
    place.write("mixed/zero.png", zero);
    place
}

/// Names of the bad images, without extension.
const BAD: [&str; 9] = ["black", "constant", "nan", "nothing", "pages", "text", "three", "truncated", "zero"];

#[test]
fn one_bad_image_never_stops_the_others() {
    let place = mixed();
    for command in ["run", "detect"] {
        let outcome = place.run(&[command, "mixed", "--out", command]);
        assert_eq!(outcome.code, 2, "{}", outcome.stderr);
        let failures = place.table(&format!("{command}/failures.csv"));
        assert_eq!(failures.len(), BAD.len());
        for (failure, name) in failures.iter().zip(BAD) {
            let file = &failure["file"];
            assert!(file.starts_with(&format!("mixed/{name}.")), "{file}");
            let reason = &failure["reason"];
            assert!(reason.contains(file.as_str()) && reason.lines().count() == 1, "{reason}");
            assert!(reason.len() > file.len() + 15, "{reason}");
        }
        assert_eq!(outcome.stderr.lines().count(), BAD.len() + 1, "{}", outcome.stderr);
    }
    assert_eq!(place.names("detect"), ["failures.csv", "good.csv"]);
    assert!(place.names("run").iter().all(|f| !f.starts_with("images") || f.starts_with("images/good/")));
    assert_eq!(place.table("run/summary.csv").len(), 1);
}

#[test]
fn the_reasons_say_what_is_wrong() {
    let place = mixed();
    place.run(&["detect", "mixed", "--out", "out", "-q"]);
    let reasons = place.table("out/failures.csv");
    let says = |name: &str, words: &str| {
        let failure = reasons.iter().find(|f| f["file"].contains(name)).unwrap();
        assert!(failure["reason"].contains(words), "{}", failure["reason"]);
    };
    says("black", "every pixel");
    says("constant", "every pixel");
    says("nan", "NaN");
    says("nothing", "empty");
    says("pages", "3 pages");
    says("text", "found text");
    says("three", "3 × 3 px");
    says("truncated", "damaged or incomplete");
}

#[test]
fn a_run_without_any_success_still_leaves_whole_tables() {
    let place = Place::new();
    place.write("in/text.png", "text");
    let outcome = place.run(&["run", "in", "--out", "out"]);
    assert_eq!(outcome.code, 2);
    assert_eq!(place.names("out"), ["failures.csv", "index.html", "run.json", "summary.csv"]);
    assert!(place.table("out/summary.csv").is_empty());
    assert!(place.header("out/summary.csv").starts_with(&["file".to_owned()]));
    assert!(place.read("out/index.html").contains("in/text.png"));
    assert!(outcome.stdout.contains("1 image failed: out/failures.csv"), "{}", outcome.stdout);
}

#[test]
fn a_later_run_without_failures_takes_the_list_of_failures_away() {
    let place = Place::new();
    place.image("in/a.png", 1);
    place.write("in/b.png", "text");
    assert_eq!(place.run(&["detect", "in", "--out", "out"]).code, 2);
    place.image("in/b.png", 2);
    place.ok(&["detect", "in", "--out", "out"]);
    assert_eq!(place.names("out"), ["a.csv", "b.csv"]);
}

#[test]
fn broken_links_and_loops_stop_nobody() {
    #[cfg(unix)]
    {
        let place = Place::new();
        place.image("in/a.png", 1);
        std::os::unix::fs::symlink("nowhere", place.path("in/broken.png")).unwrap();
        std::os::unix::fs::symlink("nowhere", place.path("in/notes")).unwrap();
        std::os::unix::fs::symlink("../in", place.path("in/loop")).unwrap();
        std::os::unix::fs::symlink("a.png", place.path("in/same.png")).unwrap();
        let outcome = place.run(&["detect", "in", "--out", "out"]);
        assert_eq!(outcome.code, 2, "{}", outcome.stderr);
        assert_eq!(place.names("out"), ["a.csv", "failures.csv"]);
        assert_eq!(place.table("out/failures.csv").len(), 1);
    }
}

#[test]
fn nothing_to_do_is_said_and_nothing_written() {
    let place = Place::new();
    fs::create_dir(place.path("empty")).unwrap();
    place.write("file", "");
    place.image("a.png", 1);
    for command in ["run", "detect"] {
        assert!(place.refused(&[command, "empty", "--out", "out"]).contains("no images in empty"));
        assert!(
            place
                .refused(&[command, "gone.png", "--out", "out"])
                .contains("gone.png: cannot be read (No such file")
        );
        assert!(place.refused(&[command, "a.png", "--out", "file"]).contains("cannot write to file"));
        assert!(place.refused(&[command, "a.png", "--out", "file/sub"]).contains("choose another --out"));
        #[cfg(target_os = "linux")]
        place.refused(&[command, "a.png", "--out", "/proc/out"]);
    }
    for command in ["measure", "compare"] {
        assert!(place.refused(&[command, "empty", "--out", "out"]).contains("no coordinate files in empty"));
        place.refused(&[command, "gone.csv", "--out", "out"]);
    }
    place.refused(&["validate", "--reference", "empty", "--images", "empty", "--out", "out"]);
    assert!(!place.path("out").exists());
}

#[test]
fn a_cause_is_told_once() {
    let place = Place::new();
    let error = place.refused(&["run", "gone.png", "--out", "out"]);
    assert_eq!(error.matches("No such file").count(), 1, "{error}");
}

#[test]
fn options_out_of_range_are_refused_before_anything_is_written() {
    let place = Place::new();
    place.image("a.png", 1);
    for (options, word) in [
        (&["--spacing", "200"][..], "4 to 160 px"),
        (&["--spacing", "nan"], "4 to 160 px"),
        (&["--spacing", "-3"], "4 to 160 px"),
        (&["--spacing", "wide"], "expected a number"),
        (&["--threads", "0"], "1..=1024"),
        (&["--threads", "many"], "whole number"),
        (&["--seed", "-1"], "whole number"),
        (&["--crop", "nonsense"], "X0,Y0,X1,Y1"),
        (&["--crop", "0x3"], "WxH"),
        (&["--crop", "9x9um"], "--um-per-px"),
        (&["--um-per-px", "0"], "positive"),
        (&["--um-per-px", "-0.4"], "positive"),
        (&["--um-per-px", "1", "--field-um", "60"], "cannot be used with"),
        (&["--field-degrees", "0"], "positive"),
        (&["--axial-length", "24"], "--px-per-degree"),
        (&["--unscaled"], "--scale-table"),
        (&["--scale-table", "gone.csv"], "gone.csv"),
        (&["--modality", "octopus"], "confocal, split, histology"),
        (&["--samplers", "uniform,octopus"], "jittered, bridson"),
        (&["--spacin", "9"], "--spacing"),
        (&["--bogus"], "run --help"),
        (&["-q", "-v"], "cannot be used with"),
    ] {
        let error = place.refused(&[&["run", "a.png", "--out", "out"], options].concat());
        assert!(error.contains(word), "{options:?}: {error}");
        assert!(!place.path("out").exists(), "{options:?}");
    }
}

#[test]
fn wrong_usage_is_one_line_that_names_the_help() {
    let place = Place::new();
    for arguments in [&["run"][..], &["octopus"], &["sample"], &["measure", "--window"], &["--octopus"]] {
        assert!(place.refused(arguments).contains("--help"), "{arguments:?}");
    }
    let outcome = place.run(&[]);
    assert_eq!((outcome.code, outcome.stdout.as_str()), (1, ""));
    assert!(outcome.stderr.contains("Usage:"));
}

#[test]
fn coordinate_files_that_are_none_name_file_and_line() {
    let place = Place::new();
    place.write("csv/letters.csv", "x,y\n1,2\n3,four\n");
    place.write("csv/nan.csv", "x,y\n1,2\nNaN,4\n");
    place.write("csv/one.csv", "x\n1\n2\n");
    place.write("csv/empty.csv", "");
    place.write("csv/header.csv", "x,y\n");
    place.write("csv/good.csv", "x,y\n1,2\n5,5\n9,1\n");
    let outcome = place.run(&["measure", "csv", "--window", "20x20", "--out", "out"]);
    assert_eq!(outcome.code, 2);
    let failures = place.table("out/failures.csv");
    let reasons: Vec<&str> = failures.iter().map(|f| f["reason"].as_str()).collect();
    assert_eq!(reasons.len(), 4);
    assert!(reasons[0].starts_with("csv/empty.csv"));
    assert!(reasons[1].starts_with("csv/letters.csv, line 3") && reasons[1].contains("“four”"));
    assert!(reasons[2].starts_with("csv/nan.csv, line 3"));
    assert!(reasons[3].starts_with("csv/one.csv, line 1"));
    let rows = place.table("out/summary.csv");
    assert_eq!(rows.iter().map(|r| r["n"].as_str()).collect::<Vec<_>>(), ["3", "0"]);
    assert_eq!(place.read("out/header.pcf.csv"), "r,g\n");
}

#[test]
fn windows_that_are_none_are_refused() {
    let place = Place::new();
    place.write("a.csv", "x,y\n1,2\n5,5\n");
    for window in ["0x0", "-1x3", "nonsense", "1,2", "nan,0,1,1", "5,5,1,1", ""] {
        let error = place.refused(&["measure", "a.csv", "--window", window, "--out", "out"]);
        assert!(error.contains("auto, image, unit, WxH, X0,Y0,X1,Y1 or a file of corners"), "{error}");
    }
    let outcome = place.run(&["measure", "a.csv", "--out", "out"]);
    assert_eq!(outcome.code, 2);
    assert!(
        outcome
            .stderr
            .contains("a.csv: the window is taken from the image of the same name, but there is none"),
        "{}",
        outcome.stderr
    );
}

#[test]
fn an_image_missing_from_the_scale_table_fails_unless_told_otherwise() {
    let place = Place::new();
    place.image("in/AB_1.png", 1);
    place.image("in/other.png", 2);
    place.write("scales.csv", "identifier,um_per_px\nAB,0.5\n");
    let run = ["run", "in", "--scale-table", "scales.csv", "--out", "out", "--samplers", "jittered"];
    assert_eq!(place.run(&run).code, 2);
    let failure = &place.table("out/failures.csv")[0];
    assert_eq!(failure["file"], "in/other.png");
    assert!(failure["reason"].contains("“AB”") && failure["reason"].contains("--unscaled"));
    place.ok(&[&run[..], &["--unscaled"]].concat());
    let rows = place.table("out/summary.csv");
    assert_eq!([rows[0]["um_per_px"].as_str(), rows[1]["um_per_px"].as_str()], ["0.5", ""]);
    assert_eq!(place.header("out/images/AB_1/points.csv"), ["x_px", "y_px", "score", "x_um", "y_um"]);
    assert_eq!(place.header("out/images/other/points.csv"), ["x_px", "y_px", "score"]);
}

#[test]
fn a_bad_scale_table_stops_everything_before_it_starts() {
    let place = Place::new();
    place.image("a.png", 1);
    for (text, word) in [
        ("", "scales.csv"),
        ("AB,zero\n", "line 1"),
        ("AB,-1\n", "positive"),
        ("AB,0.4\nAB,0.5\n", "line 2"),
        ("identifier,colour\nAB,1\n", "um_per_px"),
    ] {
        place.write("scales.csv", text);
        let error = place.refused(&["detect", "a.png", "--scale-table", "scales.csv", "--out", "out"]);
        assert!(error.contains(word), "{error}");
        assert!(!place.path("out").exists());
    }
}

#[test]
fn a_crop_that_leaves_nothing_names_the_image() {
    let place = Place::new();
    place.image("a.png", 1);
    let outcome = place.run(&["run", "a.png", "--crop", "500,500,600,600", "--out", "out"]);
    assert_eq!(outcome.code, 2);
    let failure = &place.table("out/failures.csv")[0];
    assert!(failure["reason"].contains("a.png: the crop") && failure["reason"].contains("64 × 56 px"));
}

#[test]
fn hand_marks_are_never_replaced_by_detections() {
    let place = Place::new();
    place.image("in/a.png", 1);
    place.write("in/a.csv", "x,y\n1,2\n");
    assert_eq!(place.run(&["detect", "in", "--out", "in"]).code, 2);
    assert_eq!(place.read("in/a.csv"), "x,y\n1,2\n");
    fs::remove_file(place.path("in/a.csv")).unwrap();
    place.ok(&["detect", "in", "--out", "in"]);
    place.ok(&["detect", "in", "--out", "in"]);
}

#[test]
fn images_are_never_replaced_by_their_results() {
    let place = Place::new();
    place.image("data/images/a/a.png", 1);
    let error = place.refused(&["run", "data/images/a/a.png", "--out", "data"]);
    assert!(error.contains("choose another --out"), "{error}");
    assert_eq!(place.names("data"), ["images/a/a.png"]);
}

#[test]
fn a_simulated_image_and_its_truth_come_together_or_not_at_all() {
    let place = Place::new();
    fs::create_dir(place.path("here")).unwrap();
    place.refused(&["render", "--out", "here/a.png", "--truth", "gone/a.csv"]);
    place.refused(&["render", "--out", "gone/a.png", "--truth", "here/a.csv"]);
    place.refused(&["render", "--out", "here/a.jpg", "--truth", "here/a.csv"]);
    place.refused(&["render", "--out", "here/a.png", "--truth", "here/a.png"]);
    assert!(place.names("here").is_empty());
}
