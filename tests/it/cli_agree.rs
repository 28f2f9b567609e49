//! The command `agree`: graders compared with each other.

use crate::common::{Place, number};

#[test]
fn graders_are_paired_by_image_and_their_differences_told() {
    let place = Place::new();
    place.write("one.csv", "name,density,note\na.png,10,x\nb.png,20,y\nc.png,30,z\nd.png,40,z\n");
    place.write("two/summary.csv", "file,density\nx/a_coords.csv,11\nx/b.csv,19\nx/c.csv,33\nx/e.csv,7\n");
    let outcome = place.ok(&["agree", "one.csv", "two", "--out", "out"]);
    assert!(outcome.stdout.contains("2 images without a partner"), "{}", outcome.stdout);
    let row = place.table("out/agreement.csv").remove(0);
    assert_eq!(
        (row["column"].as_str(), row["first"].as_str(), row["second"].as_str()),
        ("density", "one", "two")
    );
    // the differences are −1, 1 and −3
    assert!(number(&row, "n") == 3. && (number(&row, "difference") + 1.).abs() < 1e-12);
    assert!((number(&row, "sd") - 2.).abs() < 1e-12);
    assert!((number(&row, "limit_low") + 1. + 1.96 * 2.).abs() < 1e-12);
    assert!(
        (number(&row, "mean_first") - 20.).abs() < 1e-12 && (number(&row, "mean_second") - 21.).abs() < 1e-12
    );
    assert!(number(&row, "icc_consistency") > 0.9);
    let differences = place.table("out/differences.csv");
    assert_eq!(differences.len(), 3);
    assert_eq!(number(&differences[2], "difference"), -3.);
    let unpaired = place.table("out/unpaired.csv");
    assert_eq!((unpaired[0]["image"].as_str(), unpaired[0]["missing_from"].as_str()), ("d", "two"));
    roxmltree::Document::parse(&place.read("out/agreement.svg")).unwrap();
}

#[test]
fn summaries_of_this_program_and_more_than_two_graders_can_be_compared() {
    let place = Place::new();
    for (folder, seed) in [("one", "1"), ("two", "2"), ("three", "3")] {
        for name in ["a", "b", "c"] {
            let n = ["100", "200", "400"][usize::from(name.as_bytes()[0] - b'a')];
            let file = format!("{folder}-{name}.csv");
            place.ok(&["sample", "jittered", "-n", n, "--seed", seed, "--window", "60x60", "--out", &file]);
            place.write(&format!("{folder}/{name}.csv"), place.read(&file));
        }
        let out = format!("m{folder}");
        place.ok(&["measure", folder, "--window", "60x60", "--um-per-px", "0.5", "--out", &out]);
    }
    place.ok(&["agree", "mone", "mtwo", "mthree", "--out", "out"]);
    let rows = place.table("out/agreement.csv");
    let of = |column: &str| rows.iter().filter(|r| r["column"] == column).count();
    assert_eq!((of("nn_mean_um"), of("density_per_mm2")), (4, 4));
    let all = rows.iter().find(|r| r["column"] == "nn_mean_um" && r["first"] == "all").unwrap();
    assert!(number(all, "icc_agreement") > 0.9 && number(all, "icc_agreement") < 1.);
    let (low, high) = (number(all, "icc_agreement_low"), number(all, "icc_agreement_high"));
    assert!(low < number(all, "icc_agreement") && number(all, "icc_agreement") < high);
    assert!(!rows.iter().any(|r| r["column"] == "um_per_unit"));
}

#[test]
fn a_run_and_a_grader_are_compared_by_names_without_units() {
    let place = Place::new();
    for (name, seed) in [("a", 1), ("b", 2), ("c", 3)] {
        place.image(&format!("in/{name}.png"), seed);
    }
    place.ok(&["run", "in", "--detector", "classical", "--samplers", "jittered", "--out", "run", "-q"]);
    for name in ["a", "b", "c"] {
        place.copy(&format!("run/images/{name}/points.csv"), &format!("marks/{name}_coords.csv"));
    }
    place.ok(&["measure", "marks", "--window", "64x56", "--out", "marked", "-q"]);
    place.ok(&["agree", "run", "marked", "--metrics", "density,nn_mean,spacing", "--out", "out", "-q"]);
    let rows = place.table("out/agreement.csv");
    let columns: Vec<&str> = rows.iter().map(|r| r["column"].as_str()).collect();
    assert_eq!(columns, ["density_per_px2", "nn_mean_px", "spacing_density_px"]);
    assert!(rows.iter().all(|r| r["n"] == "3" && number(r, "difference").abs() < 1e-12), "{rows:?}");
    place.ok(&["agree", "run", "marked", "--out", "all", "-q"]);
    let all = place.table("all/agreement.csv");
    assert!(all.iter().any(|r| r["column"] == "nn_mean_px") && !all.iter().any(|r| r["column"] == "nn_mean"));
    // a table of an earlier version has other names of columns; a grader in µm without a scale
    // cannot be compared
    place.write("old.csv", "file,unit,spacing,density\na,px,7,0.02\nb,px,7.5,0.019\nc,px,8,0.017\n");
    place.ok(&["agree", "run", "old.csv", "--metrics", "spacing_density,density", "--out", "old", "-q"]);
    assert_eq!(place.table("old/agreement.csv")[1]["column"], "density_per_px2");
    place.write("um.csv", "file,unit,density\na,um,0.02\nb,um,0.019\n");
    let complaint = place.refused(&["agree", "run", "um.csv", "--metrics", "density", "--out", "no"]);
    assert!(complaint.contains("unit"), "{complaint}");
}

#[test]
fn tables_that_cannot_be_compared_are_refused_with_a_remedy() {
    let place = Place::new();
    place.write("one.csv", "name,density\na,1\nb,2\n");
    place.write("other.csv", "name,density\nc,1\nd,2\n");
    place.write("bare.csv", "density\n1\n");
    place.write("twice.csv", "name,density\na.png,1\na.tif,2\n");
    for (second, more, words) in [
        ("other.csv", &[][..], "paired by file name"),
        ("bare.csv", &[], "name, file, image or identifier"),
        ("twice.csv", &[], "line 3"),
        ("none.csv", &[], "summary.csv"),
        ("other.csv", &["--columns", "age"], "no column age"),
    ] {
        let error = place.refused(&[&["agree", "one.csv", second, "--out", "out"], more].concat());
        assert!(error.contains(words), "{second}: {error}");
    }
}

/// Numbers by the first grader for three eyes with three images each. The graders differ by the
/// same amount in all images of an eye.
const FIRST: &str =
    "name,nn_mean_um\nA_1,10\nA_2,12\nA_3,14\nB_1,20\nB_2,22\nB_3,24\nC_1,30\nC_2,32\nC_3,34\n";
/// Numbers by the second grader for the same images.
const SECOND: &str =
    "name,nn_mean_um\nA_1,9\nA_2,11\nA_3,13\nB_1,22\nB_2,24\nB_3,26\nC_1,25\nC_2,27\nC_3,29\n";

#[test]
fn images_of_one_subject_do_not_count_as_independent() {
    let place = Place::new();
    place.write("one.csv", FIRST);
    place.write("two.csv", SECOND);
    let alone = place.ok(&["agree", "one.csv", "two.csv", "--out", "alone"]);
    assert!(alone.stdout.contains("treat images as independent"), "{}", alone.stdout);
    let grouped = place.ok(&["agree", "one.csv", "two.csv", "--group-by", "prefix:1", "--out", "grouped"]);
    assert!(grouped.stdout.contains("9 images of 3 groups"), "{}", grouped.stdout);
    let [alone, grouped] =
        ["alone", "grouped"].map(|out| place.table(&format!("{out}/agreement.csv")).remove(0));
    // the differences are 1, −2 and 5 for the three eyes, so the bias is 4/3 whether or not images
    // are grouped
    for row in [&alone, &grouped] {
        assert!((number(row, "difference") - 4. / 3.).abs() < 1e-12);
    }
    assert_eq!((number(&alone, "groups"), number(&grouped, "groups")), (9., 3.));
    let width = |row: &std::collections::BTreeMap<String, String>| {
        number(row, "difference_high") - number(row, "difference_low")
    };
    // the half-width of the interval is t(2) √(1/3) SD with groups and t(8) √(1/9) SD without; the
    // two standard deviations SD differ only in their divisor
    assert!(width(&grouped) > 3. * width(&alone), "{} {}", width(&grouped), width(&alone));
    assert!(grouped["icc_agreement_low"].is_empty() && !alone["icc_agreement_low"].is_empty());
    let error = place.refused(&["agree", "one.csv", "two.csv", "--group-by", "X", "--out", "out"]);
    assert!(error.contains("A_1"), "{error}");
}

#[test]
fn axes_say_in_words_what_is_compared_and_in_which_unit() {
    let place = Place::new();
    place.write("one.csv", FIRST);
    place.write("two.csv", SECOND);
    place.ok(&["agree", "one.csv", "two.csv", "--out", "out"]);
    assert_eq!(place.names("out"), ["agreement.csv", "agreement.svg", "differences.csv", "unpaired.csv"]);
    let figure = place.read("out/agreement.svg");
    for words in ["mean of nearest-neighbour distance (µm)", ">difference (µm)<"] {
        assert!(figure.contains(words), "{words}");
    }
}

#[test]
fn figures_come_as_pdf_and_png_too() {
    let place = Place::new();
    place.write("one.csv", FIRST);
    place.write("two.csv", SECOND);
    place.ok(&["agree", "one.csv", "two.csv", "--figures", "pdf,png", "--out", "out"]);
    for (file, start) in [("svg", &b"<svg"[..]), ("pdf", b"%PDF"), ("png", b"\x89PNG")] {
        let bytes = std::fs::read(place.path(&format!("out/agreement.{file}"))).unwrap();
        assert!(bytes.starts_with(start), "{file}");
    }
    let error = place.refused(&["agree", "one.csv", "two.csv", "--figures", "eps", "--out", "out"]);
    assert!(error.contains("svg, pdf or png"), "{error}");
}
