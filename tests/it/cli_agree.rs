//! Graders held against each other.

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
    // differences −1, 1, −3
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
fn tables_that_cannot_be_compared_are_refused_with_a_remedy() {
    let place = Place::new();
    place.write("one.csv", "name,density\na,1\nb,2\n");
    place.write("other.csv", "name,density\nc,1\nd,2\n");
    place.write("bare.csv", "density\n1\n");
    place.write("twice.csv", "name,density\na.png,1\na.tif,2\n");
    for (second, more, words) in [
        ("other.csv", &[][..], "paired by file name"),
        ("bare.csv", &[], "name or file"),
        ("twice.csv", &[], "line 3"),
        ("none.csv", &[], "summary.csv"),
        ("other.csv", &["--columns", "age"], "no column age"),
    ] {
        let error = place.refused(&[&["agree", "one.csv", second, "--out", "out"], more].concat());
        assert!(error.contains(words), "{second}: {error}");
    }
}
