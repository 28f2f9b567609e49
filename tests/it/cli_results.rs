//! Results are never lost and never mixed: what a run leaves where earlier results are.

use crate::common::{Outcome, Place};
use std::fs;

fn two_images() -> Place {
    let place = Place::new();
    place.image("in/a.png", 1);
    place.image("in/b.png", 2);
    place
}

const RUN: [&str; 7] = ["run", "in", "--out", "out", "--samplers", "none", "-q"];

fn run(place: &Place, more: &[&str]) -> Outcome {
    place.run(&[&RUN[..], more].concat())
}

/// Moved results of earlier runs.
fn earlier(place: &Place, name: &str) -> bool {
    place.path(&format!("out/.conemosaic/earlier/{name}")).exists()
}

#[test]
fn images_that_fail_now_keep_their_results() {
    let place = two_images();
    place.write("other.csv", "file,um_per_px\nnobody,0.5\n");
    assert_eq!(run(&place, &[]).code, 0);
    let before = place.results("out");
    let whole = fs::read(place.path("in/a.png")).unwrap();
    for (options, damaged) in [
        (&["--scale-table", "other.csv"][..], false),
        (&["--crop", "900,900,990,990"][..], false),
        (&[][..], true),
    ] {
        if damaged {
            place.write("in/a.png", &whole[..whole.len() / 2]);
            place.write("in/b.png", b"");
        }
        let outcome = run(&place, options);
        assert_eq!(outcome.code, 2, "{options:?}");
        assert!(outcome.stderr.contains("its earlier results stay in images/a"), "{}", outcome.stderr);
        let after = place.results("out");
        for (name, bytes) in before.iter().filter(|(name, _)| name.starts_with("images/")) {
            assert_eq!(after.get(name), Some(bytes), "{options:?}: {name}");
        }
        assert!(place.read("out/images/a/FAILED.txt").contains("of an earlier run"));
        assert_eq!(place.table("out/failures.csv").len(), 2);
    }
    // the note goes when the image works again, whether its results still hold or are made anew
    place.write("in/a.png", whole);
    place.image("in/b.png", 3);
    assert_eq!(run(&place, &[]).code, 0);
    let names = place.names("out");
    assert!(!names.iter().any(|n| n.contains("FAILED") || n.contains("failures")), "{names:?}");
}

#[test]
fn an_image_that_is_gone_leaves_its_results_in_a_place_of_their_own() {
    let place = two_images();
    run(&place, &[]);
    fs::remove_file(place.path("in/b.png")).unwrap();
    let outcome = place.ok(&RUN[..6]);
    assert!(outcome.stdout.contains("moved to out/.conemosaic/earlier"), "{}", outcome.stdout);
    assert!(!place.path("out/images/b").exists() && earlier(&place, "images/b/points.csv"));
}

#[test]
fn tables_that_are_not_asked_for_again_do_not_stay() {
    let place = two_images();
    let verdict = ["--maps", "--verdict", "--simulations", "39", "--samplers", "uniform"];
    let asked = [&["run", "in", "--out", "out", "-q"][..], &verdict].concat();
    place.ok(&asked);
    assert!(place.path("out/landmarks.csv").exists() && place.path("out/verdicts.csv").exists());
    assert_eq!(run(&place, &[]).code, 0);
    for table in ["landmarks.csv", "verdicts.csv"] {
        assert!(!place.path("out").join(table).exists() && earlier(&place, table), "{table}");
    }
    place.ok(&["run", "in", "--out", "new", "--samplers", "none", "-q"]);
    assert_eq!(place.results("out"), place.results("new"));
}

#[test]
fn results_of_coordinates_that_fail_now_do_not_stay() {
    let points = "x,y\n1,1\n5,5\n9,1\n4,8\n";
    for command in [&["measure", "in"][..], &["compare", "in", "--samplers", "square"]] {
        let place = Place::new();
        place.write("in/a.csv", points);
        place.write("in/b.csv", points);
        let run = [command, &["--window", "10x10", "--out", "out", "-q"]].concat();
        place.ok(&run);
        place.write("in/b.csv", "x,y\n1,nothing\n");
        assert_eq!(place.run(&run).code, 2);
        assert!(place.path("out/a.pcf.csv").exists() && !place.path("out/b.pcf.csv").exists());
        assert!(earlier(&place, "b.pcf.csv"));
        assert_eq!(place.table("out/summary.csv").len(), 1);
    }
}

#[test]
fn results_of_images_that_fail_now_do_not_stay_in_detect_and_validate() {
    let place = two_images();
    place.ok(&["detect", "in", "--out", "out", "-q"]);
    let validate = ["validate", "--reference", "out", "--images", "in", "--overlay", "--out", "scores", "-q"];
    place.ok(&validate);
    place.write("in/b.png", b"no image");
    assert_eq!(place.run(&["detect", "in", "--out", "out", "-q"]).code, 2);
    assert!(!place.path("out/b.csv").exists() && earlier(&place, "b.csv"));
    place.copy("out/.conemosaic/earlier/b.csv", "out/b.csv");
    assert_eq!(place.run(&validate).code, 2);
    assert!(!place.path("scores/b.overlay.png").exists());
    assert!(place.path("scores/.conemosaic/earlier/b.overlay.png").exists());
}

#[test]
fn every_file_of_a_result_that_is_cut_or_edited_is_made_anew() {
    let place = two_images();
    run(&place, &[]);
    let before = place.results("out");
    for file in ["figure.svg", "pcf.csv", "overlay.png", "metrics.json", "points.csv"] {
        let path = format!("out/images/a/{file}");
        let whole = fs::read(place.path(&path)).unwrap();
        let mut edited = whole.clone();
        edited.push(b' ');
        // cut within a row: points that end with a whole one are corrections
        let mut damaged = vec![whole[..whole.len() - 2].to_vec(), Vec::new()];
        if file != "points.csv" {
            damaged.push(edited);
        }
        for bytes in damaged {
            place.write(&path, &bytes);
            let outcome = place.ok(&RUN[..6]);
            assert!(outcome.stdout.contains("1 kept"), "{file}: {}", outcome.stdout);
            assert_eq!(place.results("out"), before, "{file}");
        }
        assert!(earlier(&place, &format!("images/a/{file}")), "{file} may have been a person's work");
    }
}

#[test]
fn files_of_a_person_are_never_removed() {
    let place = two_images();
    place.write("out/notes.txt", "mine");
    place.write("out/images/a/sketch.png", "mine");
    place.write("out/images/z/points.csv", "mine");
    place.write("out/summary.csv", "mine");
    let outcome = run(&place, &[]);
    assert_eq!(outcome.code, 2);
    assert!(outcome.stderr.contains("sketch.png"), "{}", outcome.stderr);
    for file in ["notes.txt", "images/a/sketch.png", "images/z/points.csv", ".conemosaic/earlier/summary.csv"]
    {
        assert_eq!(place.read(&format!("out/{file}")), "mine", "{file}");
    }
    // what file managers leave is no work of a person
    place.write("out/images/b/.DS_Store", "");
    assert_eq!(run(&place, &["--fresh"]).code, 2);
    assert!(!place.path("out/images/b/FAILED.txt").exists());
}

#[test]
fn notes_that_are_lost_make_all_files_a_persons() {
    let place = two_images();
    run(&place, &[]);
    let before = place.results("out");
    place.write("out/.conemosaic/files.sha256", b"\xff\xfe no list");
    let outcome = run(&place, &["--fresh"]);
    assert_eq!(outcome.code, 2);
    assert!(outcome.stderr.contains("which is no result of this program"), "{}", outcome.stderr);
    let after = place.results("out");
    assert!(before.iter().filter(|(n, _)| n.starts_with("images/")).all(|(n, b)| after.get(n) == Some(b)));
}

#[test]
fn names_may_hold_anything_that_the_system_allows() {
    let place = Place::new();
    place.image("first.png", 1);
    let mut names = vec!["a  b", "..c", "d..", "ä"];
    if cfg!(unix) {
        names.extend(["e\nf", "g\\n", "h\r"]);
    }
    names.iter().for_each(|name| place.copy("first.png", &format!("in/{name}.png")));
    assert_eq!(run(&place, &[]).code, 0);
    let before = place.results("out");
    let kept = place.ok(&RUN[..6]);
    assert!(kept.stdout.contains(&format!("{} kept", names.len() - 1)), "{}", kept.stdout);
    assert_eq!(run(&place, &["--fresh"]).code, 0);
    assert_eq!(place.results("out"), before);
}
