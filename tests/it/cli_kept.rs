//! Result folders that contain a person's files, whose ledger is lost, or whose images have odd
//! names.

use crate::common::{Outcome, Place};

fn two_images() -> Place {
    let place = Place::new();
    place.image("in/a.png", 1);
    place.image("in/b.png", 2);
    place
}

/// Arguments of a run without comparison with samplers and without output to the terminal.
const RUN: [&str; 7] = ["run", "in", "--out", "out", "--samplers", "none", "-q"];

fn run(place: &Place, more: &[&str]) -> Outcome {
    place.run(&[&RUN[..], more].concat())
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
    // files that file managers create are no work of a person, so they do not count
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
    assert!(outcome.stderr.contains("which is not a result of this program"), "{}", outcome.stderr);
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
