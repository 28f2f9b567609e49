//! Cones that a person has corrected are used, and replaced only when that is asked for.

use crate::common::{Place, number};
use std::fs;

const RUN: [&str; 7] = ["run", "in", "--out", "out", "--samplers", "none", "-q"];
const POINTS: &str = "out/images/a/points.csv";

/// A run of one image, and the text of its cones.
fn with_results() -> (Place, String) {
    let place = Place::new();
    place.image("in/a.png", 1);
    place.ok(&RUN);
    let points = place.read(POINTS);
    (place, points)
}

fn cones(place: &Place) -> usize {
    number(&place.table("out/summary.csv")[0], "n") as usize
}

#[test]
fn corrected_cones_are_used_and_stay() {
    let (place, written) = with_results();
    let found = cones(&place);
    let rows: Vec<&str> = written.lines().collect();
    let shorter = format!("{}\n", rows[..rows.len() - 3].join("\n"));
    let without_break = rows[..rows.len() - 2].join("\n");
    let longer = format!("{written}20.5,20.5,1\n21.5,30,1\n");
    for (corrected, n) in [(shorter, found - 3), (without_break, found - 2), (longer, found + 2)] {
        place.write(POINTS, &corrected);
        for _ in 0..2 {
            place.ok(&RUN);
            assert_eq!((place.read(POINTS), cones(&place)), (corrected.clone(), n));
            assert_eq!(place.json("out/images/a/metrics.json")["cones_from"], "corrected");
        }
        assert!(place.ok(&RUN[..6]).stdout.contains("1 kept"));
    }
}

#[test]
fn corrections_are_given_up_only_when_asked() {
    let (place, written) = with_results();
    let corrected = format!("{written}20.5,20.5,1\n");
    place.write(POINTS, &corrected);
    place.write("marks/a.csv", "x,y\n10,10\n20,20\n30,10\n");
    // before a run has used them, and after
    for _ in 0..2 {
        for refused in [&["--fresh"][..], &["--cones", "marks"]] {
            let outcome = place.run(&[&RUN[..], refused].concat());
            assert_eq!(outcome.code, 2, "{refused:?}");
            assert!(outcome.stderr.contains("--replace-corrections"), "{}", outcome.stderr);
            assert_eq!(place.read(POINTS), corrected);
        }
        place.ok(&RUN);
    }
    place.ok(&[&RUN[..], &["--replace-corrections"]].concat());
    assert_eq!(place.read(POINTS), written);
    assert_eq!(place.read("out/.conemosaic/earlier/images/a/points.csv"), corrected);
    assert_eq!(place.json("out/images/a/metrics.json")["cones_from"], "detected");
}

#[test]
fn corrections_survive_the_loss_of_the_record_that_they_were_used() {
    let (place, written) = with_results();
    let corrected = format!("{written}20.5,20.5,1\n");
    place.write(POINTS, &corrected);
    place.ok(&RUN);
    fs::remove_file(place.path("out/images/a/metrics.json")).unwrap();
    place.ok(&RUN);
    assert_eq!(place.read("out/.conemosaic/earlier/images/a/points.csv"), corrected);
}

#[test]
fn detect_replaces_neither_corrections_nor_hand_marks() {
    let place = Place::new();
    place.image("in/a.png", 1);
    place.image("in/b.png", 2);
    place.write("out/b.csv", "x,y\n1,1\n");
    let detect = ["detect", "in", "--out", "out", "-q"];
    let outcome = place.run(&detect);
    assert_eq!(outcome.code, 2);
    assert!(outcome.stderr.contains("out/b.csv") && outcome.stderr.contains("--replace-corrections"));
    let corrected = format!("{}20,20,1\n", place.read("out/a.csv"));
    place.write("out/a.csv", &corrected);
    assert_eq!(place.run(&detect).code, 2);
    assert_eq!((place.read("out/a.csv"), place.read("out/b.csv")), (corrected.clone(), "x,y\n1,1\n".into()));
    place.ok(&[&detect[..], &["--replace-corrections"]].concat());
    assert_ne!(place.read("out/a.csv"), corrected);
    assert_eq!(place.read("out/.conemosaic/earlier/a.csv"), corrected);
    assert_eq!(place.read("out/.conemosaic/earlier/b.csv"), "x,y\n1,1\n");
}
