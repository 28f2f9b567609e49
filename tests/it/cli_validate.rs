//! The command `validate`, run as a user runs it: groups, intervals, FROC curves, overlays, and two
//! detectors or graders.

use crate::common::Place;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;

/// Returns the marks of a lattice, 12 px apart, on 60 × 60 px.
fn lattice() -> Vec<(f64, f64)> {
    (1..5).flat_map(|y| (1..5).map(move |x| (12. * f64::from(x), 12. * f64::from(y)))).collect()
}

fn csv(header: &str, rows: impl IntoIterator<Item = String>) -> String {
    [header.to_owned()].into_iter().chain(rows).map(|line| line + "\n").collect()
}

/// Writes marks and detections of four images of two subjects. The scores of the detections are in
/// a column `confidence`.
///
/// The detections of image k lack its first `k` marks and have one false alarm of low confidence.
fn made_up() -> Place {
    let place = Place::new();
    for (k, name) in ["s1_a", "s1_b", "s2_a", "s2_b"].into_iter().enumerate() {
        let marks = lattice();
        place.write(&format!("marks/{name}.csv"), csv("x,y", marks.iter().map(|(x, y)| format!("{x},{y}"))));
        let found = marks.iter().skip(k).map(|(x, y)| format!("{},{y},0.9", x + 0.5));
        let rows = found.chain(["18,18,0.25".to_owned()]);
        place.write(&format!("cones/{name}.csv"), csv("x,y,confidence", rows));
    }
    place
}

/// Arguments of a validation. Its cut-off distance is so short that the false alarm at (18, 18),
/// which is 8.5 px from the nearest marks, is paired with none of them.
const VALIDATE: [&str; 9] =
    ["validate", "--reference", "marks", "--detections", "cones", "--size", "60x60", "--reach", "0.5"];

fn number(row: &BTreeMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} of {row:?}"))
}

#[test]
fn a_validation_without_scores_or_groups_has_the_files_that_apply() {
    let place = made_up();
    for name in ["s1_a", "s1_b", "s2_a", "s2_b"] {
        place.copy(&format!("marks/{name}.csv"), &format!("cones/{name}.csv"));
    }
    let outcome = place.ok(&[&VALIDATE[..], &["--out", "out"]].concat());
    assert_eq!(place.names("out"), ["bland_altman.svg", "index.html", "validation.csv", "validation.json"]);
    assert!(outcome.stdout.contains("give --group-by"), "{}", outcome.stdout);
}

#[test]
fn files_may_be_given_instead_of_folders() {
    let place = made_up();
    place.copy("cones/s1_b.csv", "other.csv");
    let scored = |reference: &str, detections: &str, out: &str| {
        let given = ["validate", "--reference", reference, "--detections", detections];
        place.ok(&[&given[..], &["--size", "60x60", "--reach", "0.5", "--out", out]].concat());
        place.table(&format!("{out}/validation.csv")).remove(0)
    };
    let row = scored("marks/s1_b.csv", "other.csv", "one");
    assert_eq!(row["name"], "s1_b");
    assert_eq!(row["dice"], scored("marks/s1_b.csv", "cones", "same")["dice"]);
    // among several files of marks, a single file of detections belongs to the marks of the same
    // name
    assert_eq!(row["dice"], scored("marks", "cones/s1_b.csv", "named")["dice"]);
}

#[test]
fn groups_are_subjects_and_every_table_speaks_of_them() {
    let place = made_up();
    let grouped = [&VALIDATE[..], &["--group-by", "prefix:1", "--um-per-px", "0.5", "--out", "out"]].concat();
    let outcome = place.ok(&grouped);
    let groups = place.table("out/groups.csv");
    assert_eq!(groups.iter().map(|g| g["group"].as_str()).collect::<Vec<_>>(), ["s1", "s2"]);
    let rows = place.table("out/validation.csv");
    let dice: Vec<f64> = rows.iter().map(|r| number(r, "dice")).collect();
    // image k has 16 − k hits, k misses and one false alarm
    for (k, dice) in dice.iter().enumerate() {
        assert!((dice - 2. * (16. - k as f64) / (33. - k as f64)).abs() < 1e-12);
    }
    assert!((number(&groups[0], "dice") - (dice[0] + dice[1]) / 2.).abs() < 1e-12);
    assert!((number(&groups[0], "dice_sd") - (dice[0] - dice[1]) / 2f64.sqrt()).abs() < 1e-12);
    assert!((number(&rows[0], "localisation_um") - 0.25).abs() < 1e-12);
    let json = place.json("out/validation.json");
    let mean = json["mean_over_groups"]["dice"].as_f64().unwrap();
    assert!((mean - dice.iter().sum::<f64>() / 4.).abs() < 1e-12);
    let ends: Vec<f64> =
        json["intervals"]["dice"].as_array().unwrap().iter().filter_map(|v| v.as_f64()).collect();
    // the mean of a resample lies between the means of the two subjects
    assert!(ends[0] >= (dice[2] + dice[3]) / 2. - 1e-12 && ends[1] <= (dice[0] + dice[1]) / 2. + 1e-12);
    for words in ["mean over 2 groups", "resamples of the 2 groups", "Dice (= F1)", "localisation error, µm"]
    {
        assert!(outcome.stdout.contains(words), "{words}: {}", outcome.stdout);
    }
    assert!(!outcome.stdout.contains("give --group-by"));
}

#[test]
fn groups_by_pattern_and_by_table_are_the_same_groups() {
    let place = made_up();
    place.write("groups.csv", "name,group\ns1,s1\ns2_a,s2\ns2_b,s2\n");
    let of = |rule: &[&str]| {
        place.ok(&[&VALIDATE[..], rule, &["--out", "out", "-q"]].concat());
        place.files("out")
    };
    let by_prefix = of(&["--group-by", "prefix:1"]);
    assert_eq!(by_prefix, of(&["--group-by", r"^(s\d)_"]));
    assert_eq!(by_prefix, of(&["--group-table", "groups.csv"]));
}

#[test]
fn images_without_a_group_fail_alone_and_broken_tables_are_refused() {
    let place = made_up();
    place.write("groups.csv", "s1,one\ns2_a,two\n");
    let table = [&VALIDATE[..], &["--group-table", "groups.csv", "--out", "out"]].concat();
    assert_eq!(place.run(&table).code, 2);
    let failures = place.table("out/failures.csv");
    assert_eq!(failures.len(), 1);
    assert!(
        failures[0]["reason"].contains("“s2_b” has no group, because no name in groups.csv is the beginning")
    );
    place.write("groups.csv", "s1,one\ns2\n");
    assert!(place.refused(&table).contains("groups.csv, line 2: expected 2 cells"));
    let refused = place.refused(&[&VALIDATE[..], &["--group-by", "(", "--out", "out"]].concat());
    assert!(refused.contains("neither prefix:N nor a regular expression"), "{refused}");
    let both = ["--group-by", "prefix:1", "--group-table", "groups.csv", "--out", "out"];
    place.refused(&[&VALIDATE[..], &both].concat());
}

#[test]
fn the_score_makes_a_curve_and_its_best_threshold_leaves_the_false_alarms_out() {
    let place = made_up();
    place.ok(&[&VALIDATE[..], &["--um-per-px", "0.5", "--out", "out", "-q"]].concat());
    let curve = place.table("out/froc.csv");
    assert_eq!(curve.iter().map(|p| number(p, "threshold")).collect::<Vec<_>>(), [0.9, 0.25]);
    assert_eq!(number(&curve[1], "false_alarms_per_image"), 1.);
    let area = 46. * 46. * 0.25e-6;
    assert!((number(&curve[1], "false_alarms_per_mm2") - 1. / area).abs() < 1e-6);
    let best = &place.json("out/validation.json")["best_threshold"];
    assert_eq!((best["threshold"].as_f64(), best["precision"].as_f64()), (Some(0.9), Some(1.)));

    // there are 58 hits with a score of 0.9 and 4 false alarms with a score of 0.25
    let bins = place.table("out/reliability.csv");
    assert_eq!((bins[9]["n"].as_str(), bins[2]["n"].as_str()), ("58", "4"));
    let record = &place.json("out/validation.json")["reliability"];
    let brier = (58. * 0.01 + 4. * 0.0625) / 62.;
    assert!((record["brier"].as_f64().unwrap() - brier).abs() < 1e-12);
    let alarms = &place.json("out/validation.json")["false_alarms_per_image"];
    assert!((alarms["expected"].as_f64().unwrap() - (58. * 0.1 + 4. * 0.75) / 4.).abs() < 1e-12);
    assert_eq!(alarms["observed"].as_f64(), Some(1.));
}

#[test]
fn scores_that_are_no_probabilities_have_a_curve_and_no_reliability() {
    let place = made_up();
    place.ok(&[&VALIDATE[..], &["--out", "out", "-q"]].concat());
    assert!(place.path("out/reliability.svg").exists());
    for name in ["s1_a", "s1_b", "s2_a", "s2_b"] {
        let text = place.read(&format!("cones/{name}.csv")).replace(",0.9\n", ",90\n");
        place.write(&format!("cones/{name}.csv"), text.replace("confidence", "score"));
    }
    let outcome = place.ok(&[&VALIDATE[..], &["--out", "out"]].concat());
    assert!(outcome.stdout.contains("scores are not all between 0 and 1"), "{}", outcome.stdout);
    assert!(place.path("out/froc.svg").exists());
    assert!(!place.path("out/reliability.svg").exists(), "left over from the validation before");
    place.write("cones/s1_a.csv", "x,y,score\n12,12,high\n");
    let outcome = place.run(&[&VALIDATE[..], &["--out", "out"]].concat());
    assert!(
        outcome.stderr.contains("cones/s1_a.csv, line 2: expected a number for score"),
        "{}",
        outcome.stderr
    );
}

#[test]
fn two_detectors_are_compared_image_by_image() {
    let place = made_up();
    for name in ["s1_a", "s1_b", "s2_a", "s2_b"] {
        place.copy(&format!("marks/{name}.csv"), &format!("other/{name}_coords.csv"));
    }
    let versus = ["--versus", "other", "--group-by", "prefix:1", "--out", "out"];
    let outcome = place.ok(&[&VALIDATE[..], &versus].concat());
    let rows = place.table("out/comparison.csv");
    let measures: Vec<_> = rows.iter().map(|r| r["measure"].as_str()).collect();
    assert_eq!(measures, ["dice", "sensitivity", "fdr", "count", "density_per_px2"]);
    // the images have 0, 1, 2 and 3 misses of 16
    assert!((number(&rows[1], "difference") + 1.5 / 16.).abs() < 1e-12);
    assert_eq!(number(&rows[3], "first") - number(&rows[3], "second"), -0.5);
    // both subjects are worse, so two of the four choices of signs are as extreme
    assert_eq!((number(&rows[1], "p"), number(&rows[1], "p_least")), (0.5, 0.5));
    let note = "the p-value of the comparison cannot fall below 0.5000";
    assert!(
        outcome.stdout.contains(note) && place.read("out/index.html").contains(note),
        "{}",
        outcome.stdout
    );
    assert!(outcome.stdout.contains("smallest possible p"));
    let images = place.table("out/validation.csv");
    assert!(images.iter().all(|r| number(r, "versus_dice") == 1.));
    // the second detections are the marks themselves, so a comparison with them is a comparison
    // with the marks
    assert!(images.iter().all(|r| r["between_dice"] == r["dice"]));
    assert!(outcome.stdout.contains("sign-flip permutation") && place.path("out/comparison.svg").exists());

    place.ok(&[&VALIDATE[..], &["--versus", "cones", "--out", "out", "-q"]].concat());
    for row in place.table("out/comparison.csv") {
        let values = ["difference", "low", "high", "p"].map(|c| number(&row, c));
        assert_eq!(values, [0., 0., 0., 1.], "{row:?}");
    }
    place.ok(&[&VALIDATE[..], &["--out", "out", "-q"]].concat());
    assert!(!place.path("out/comparison.csv").exists());
}

#[test]
fn images_are_scored_drawn_and_listed_worst_first() {
    let place = Place::new();
    std::fs::create_dir(place.path("in")).unwrap();
    for (name, noise) in [("s1_clear", "0"), ("s2_noisy", "0.3")] {
        let (image, truth) = (format!("in/{name}.png"), format!("in/{name}_coords.csv"));
        let arguments = ["render", "--width", "96", "--height", "80", "--noise", noise];
        place.ok(&[&arguments[..], &["--out", &image, "--truth", &truth, "-q"]].concat());
    }
    let arguments = ["validate", "--reference", "in", "--images", "in", "--versus-detector", "classical"];
    let arguments = [&arguments[..], &["--overlay", "--out", "out", "-q"]].concat();
    place.ok(&arguments);
    place.copy("in/s2_noisy.png", "elsewhere.png");
    let one =
        ["validate", "--reference", "in/s2_noisy_coords.csv", "--images", "elsewhere.png", "--out", "one"];
    place.ok(&one);
    let dice = |folder: &str| place.table(&format!("{folder}/validation.csv")).pop().unwrap()["dice"].clone();
    assert_eq!(dice("one"), dice("out"), "a single image, called otherwise");
    let page = place.read("out/index.html");
    let list = &page[page.rfind("<tbody>").unwrap()..];
    assert!(list.find("s2_noisy").unwrap() < list.find("s1_clear").unwrap(), "{list}");
    for name in ["s1_clear", "s2_noisy"] {
        let overlay = image::open(place.path(&format!("out/{name}.overlay.png"))).unwrap().to_rgb8();
        assert_eq!(overlay.width() * 80, overlay.height() * 96);
        assert!(
            overlay.pixels().any(|p| p.0[2] > p.0[0].saturating_add(60)),
            "no blue ring of a hit on {name}"
        );
        assert!(page.contains(&format!("{name}.overlay.png")));
    }
    let record = place.json("out/validation.json");
    assert_eq!(record["comparison"]["second"], "detector classical");
    for file in place.names("out").iter().filter(|f| f.ends_with(".svg")) {
        roxmltree::Document::parse(&place.read(&format!("out/{file}"))).expect(file);
        assert!(page.contains(&format!("src=\"{file}\"")), "{file} is not on the page");
    }
    // overlays are not taken for images of a retina
    let again = place.ok(&["detect", "out", "in", "--out", "cones"]);
    assert!(again.stdout.contains("in 2 images"), "{}", again.stdout);
}

#[test]
fn everything_is_the_same_for_any_number_of_threads_and_chance_follows_the_seed() {
    let place = made_up();
    let of = |more: &[&str]| {
        place.ok(&[&VALIDATE[..], &["--versus", "marks2", "--out", "out", "-q"], more].concat());
        place.files("out")
    };
    for name in ["s1_a", "s1_b", "s2_a", "s2_b"] {
        place.write(
            &format!("marks2/{name}.csv"),
            place.read(&format!("marks/{name}.csv")).replace("12,12\n", ""),
        );
    }
    let one = of(&["--threads", "1"]);
    assert_eq!(one, of(&["--threads", "3"]));
    let other = of(&["--seed", "2"]);
    assert_ne!(one["validation.json"], other["validation.json"]);
    assert_eq!(one["validation.csv"], other["validation.csv"]);
}

#[test]
fn an_origin_that_was_forgotten_is_suspected() {
    let place = made_up();
    for name in ["s1_a", "s1_b", "s2_a", "s2_b"] {
        let shifted = lattice().into_iter().map(|(x, y)| format!("{},{}", x + 1., y + 1.));
        place.write(&format!("cones/{name}.csv"), csv("x,y", shifted));
    }
    let outcome = place.ok(&[&VALIDATE[..], &["--out", "out"]].concat());
    assert!(outcome.stdout.contains("+1.00 px in x and +1.00 px in y"), "{}", outcome.stdout);
    let outcome = place.ok(&[&VALIDATE[..], &["--detections-origin", "1", "--out", "out"]].concat());
    assert!(!outcome.stdout.contains("different pixel origins"), "{}", outcome.stdout);
}

#[test]
fn what_cannot_be_is_refused_in_one_line() {
    let place = made_up();
    let refused = |more: &[&str]| place.refused(&[&VALIDATE[..], more, &["--out", "out"]].concat());
    assert!(refused(&["--resamples", "100"]).contains("2000"));
    assert!(refused(&["--versus", "nowhere"]).contains("nowhere"));
    assert!(refused(&["--border", "-1"]).contains("border"));
    refused(&["--versus", "cones", "--versus-detector", "classical"]);
    let outcome = place.run(&[&VALIDATE[..], &["--versus-detector", "classical", "--out", "out"]].concat());
    assert_eq!(outcome.code, 2);
    assert!(outcome.stderr.contains("give --images"), "{}", outcome.stderr);
}

/// Returns 225 random points on 150 × 150 px.
fn scattered() -> Vec<(f64, f64)> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    (0..225).map(|_| (rng.random_range(0. ..149.), rng.random_range(0. ..149.))).collect()
}

#[test]
fn exchanged_coordinates_are_noticed_and_the_strict_reach_is_reported() {
    let place = Place::new();
    let points = scattered();
    place.write("cones/a.csv", csv("x,y", points.iter().map(|(x, y)| format!("{x},{y}"))));
    place.write("right/a.csv", csv("x,y", points.iter().map(|(x, y)| format!("{x},{y}"))));
    place.write("turned/a.csv", csv("x,y", points.iter().map(|(x, y)| format!("{y},{x}"))));
    let score = |marks: &str, more: &[&str]| {
        let given =
            ["validate", "--reference", marks, "--detections", "cones", "--size", "150x150", "--out", "out"];
        [&given[..], more].concat().iter().map(|s| (*s).to_owned()).collect::<Vec<String>>()
    };
    let words = |given: &[String]| place.ok(&given.iter().map(String::as_str).collect::<Vec<_>>()).stdout;
    let said = words(&score("turned", &[]));
    assert!(said.contains("look turned over") && said.contains("exchange the columns x and y"), "{said}");
    let row = place.table("out/validation.csv").remove(0);
    assert!(number(&row, "dice_strict") < number(&row, "dice") - 0.05, "{row:?}");
    let said = words(&score("right", &[]));
    assert!(!said.contains("turned over") && said.contains("Dice, strict (0.4)"), "{said}");
    assert_eq!(place.json("out/validation.json")["dice_strict"], 1.);
    let given = score("right", &["--border", "90"]);
    let refused = place.run(&given.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(
        refused.stderr.contains("nothing to score") && refused.stderr.contains("--border"),
        "{}",
        refused.stderr
    );
}
