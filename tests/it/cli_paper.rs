//! The command `paper`: the results of Lanaro et al. about samplers, made again.

use crate::common::{Place, number};

#[test]
fn paper_agrees_with_what_is_printed_and_stands_on_one_page() {
    let place = Place::new();
    let text = place.ok(&["paper", "--patterns", "3", "--threads", "2", "--out", "out"]).stdout;
    assert!(text.contains("20 of 20 rows of Table 2"), "{text}");
    let rows = place.table("out/table1.csv");
    // the ranges hold for means of ten sets; those of three sets scatter half as much again
    for (row, (low, high)) in rows.iter().zip([
        (1.28, 1.43),
        (1.31, 1.41),
        (1.33, 1.47),
        (1.34, 1.46),
        (20.7, 22.8),
        (21.4, 23.7),
        (22.2, 24.1),
    ]) {
        let ri = number(row, "ri");
        assert!((low..high).contains(&ri), "{}: {ri}", row["printed_as"]);
    }
    for (row, expected) in place.table("out/table2_samplers.csv").iter().zip([1.01, 1.38, 0.73]) {
        assert!((number(row, "l_infinity") - expected).abs() < 0.05, "{row:?}");
    }
    let page = place.read("out/index.html");
    assert_eq!(page.matches("<svg xmlns").count(), 1);
    assert!(!page.contains("<img") && !page.contains("<link") && !page.contains("<script"));
    assert_eq!(place.table("out/triangle.csv").len(), 20);
    assert_eq!(place.table("out/pcf.csv").len(), 200);
    // all printed rows satisfy the triangle inequality at the default bandwidth, but not at half or
    // twice this bandwidth
    let holds = |width: &str| {
        let rows = place.table("out/bandwidths.csv");
        rows.iter().find(|r| r["bandwidth_in_spacings"] == width).map(|r| number(r, "rows_that_hold"))
    };
    assert_eq!(holds("0.1"), Some(20.));
    assert!(holds("0.05") < Some(5.) && holds("0.2") < Some(15.));
    let markdown = place.read("out/paper.md");
    assert!(markdown.contains("| BNOT_1050 |") && markdown.contains("(figure1.svg)"));
    place.ok(&["paper", "--patterns", "3", "--threads", "1", "--out", "again", "-q"]);
    assert_eq!(place.files("out"), place.files("again"));
}
