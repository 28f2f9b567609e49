//! The options `--rois`, `--roi-side` and `--roi-cells` of `measure`, run as a user runs them.

use crate::common::{FEW_POINTS, Place, number};
use std::collections::BTreeMap;

type Row = BTreeMap<String, String>;

fn cones(place: &Place, name: &str, seed: &str) {
    place.ok(&["sample", "dart-throwing", "-n", "800", "--window", "120x100", "--seed", seed, "--out", name]);
}

/// Returns the values that must be equal for a region and for a mosaic whose window is that region:
/// all but those that name or describe the region.
fn values(row: &Row) -> Row {
    let other = ["file", "roi", "flag", "x0", "y0", "x1", "y1", "outside_window", "warnings"];
    row.iter()
        .filter(|(name, _)| !other.contains(&name.as_str()))
        .map(|(k, v)| (k.clone(), v.clone()))
        .collect()
}

#[test]
fn a_region_is_measured_as_a_mosaic_of_its_own() {
    let place = Place::new();
    cones(&place, "cones.csv", "1");
    place.write(
        "rois.csv",
        "name,x0,y0,x1,y1\nleft,0,0,50,60\nright,60.5,10,110,95\nbeyond,90,70,150,120\nfar,500,500,600,600\n",
    );
    place.write("sides.csv", "name,x,y,width,height\nleft,0,0,50,60\nright,60.5,10,49.5,85\nbeyond,90,70,60,50\nfar,500,500,100,100\n");
    place.write("um.csv", "name,x0_um,y0_um,x1_um,y1_um\nleft,0,0,25,30\nright,30.25,5,55,47.5\nbeyond,45,35,75,60\nfar,250,250,300,300\n");
    let measure = ["measure", "cones.csv", "--window", "120x100", "--um-per-px", "0.5", "-q"];
    for (table, threads) in [("rois", "1"), ("sides", "2"), ("um", "3")] {
        let file = format!("{table}.csv");
        place.ok(&[&measure[..], &["--rois", &file, "--out", table, "--threads", threads]].concat());
        assert_eq!(place.read(&format!("{table}/rois.csv")), place.read("rois/rois.csv"), "{table}");
    }
    let rows = place.table("rois/rois.csv");
    let flags: Vec<_> = rows.iter().map(|r| (r["roi"].as_str(), r["flag"].as_str())).collect();
    assert_eq!(flags, [("left", ""), ("right", ""), ("beyond", "edge"), ("far", "outside")]);
    for (row, window) in rows.iter().zip(["0,0,50,60", "60.5,10,110,95", "90,70,119.5,99.5"]) {
        let out = format!("own-{}", row["roi"]);
        place.ok(&["measure", "cones.csv", "--window", window, "--um-per-px", "0.5", "-q", "--out", &out]);
        let own = place.table(&format!("{out}/summary.csv")).remove(0);
        assert_eq!(values(row), values(&own), "{window}");
        assert!(number(row, "n") > 30. && row["file"] == "cones.csv");
    }
    assert!(rows[3]["n"].is_empty() && number(&rows[3], "x0") == 500.);
    let header = place.header("rois/rois.csv");
    assert_eq!(header[..7], ["file", "roi", "x0", "y0", "x1", "y1", "flag"]);
    assert_eq!(place.json("rois/options.json")["rois"]["source"]["table"], "rois.csv");
}

#[test]
fn one_table_serves_a_folder() {
    let place = Place::new();
    place.write("marks/.keep", "");
    for (name, seed) in [("JC_10.csv", "1"), ("JC_2.csv", "2"), ("AD_1.csv", "3")] {
        cones(&place, &format!("marks/{name}"), seed);
    }
    place.write("rois.csv", "file,name,x,y,width,height\nJC,A,0,0,40,40\nJC_10,A,20,20,40,40\nJC_10,B,60,20,40,40\n,all,0,0,119,99\n");
    let measure = ["measure", "marks", "--window", "120x100", "--rois", "rois.csv", "-q", "--out"];
    place.ok(&[&measure[..], &["out"]].concat());
    let rows = place.table("out/rois.csv");
    let names: Vec<_> = rows
        .iter()
        .map(|r| format!("{} {} {}", r["file"].replace("marks/", ""), r["roi"], number(r, "x0")))
        .collect();
    let expected = [
        "AD_1.csv all 0",
        "JC_10.csv A 20",
        "JC_10.csv B 60",
        "JC_10.csv all 0",
        "JC_2.csv A 0",
        "JC_2.csv all 0",
    ];
    assert_eq!(names, expected);

    place.write("rois.csv", "file,name,x,y,width,height\nJC,A,0,0,40,40\n");
    let outcome = place.run(&[&measure[..], &["missing"]].concat());
    assert_eq!(outcome.code, 2);
    let failure = &place.table("missing/failures.csv")[0];
    assert!(failure["file"].contains("AD_1") && failure["reason"].contains("“JC”"), "{failure:?}");
    assert_eq!(place.table("missing/rois.csv").len(), 2);
}

#[test]
fn squares_slide_and_grow_and_say_where_they_cannot() {
    let place = Place::new();
    cones(&place, "cones.csv", "4");
    let measure = ["measure", "cones.csv", "--window", "120x100", "-q", "--out"];
    place.ok(&[&measure[..], &["tiles", "--roi-side", "30"]].concat());
    let tiles = place.table("tiles/rois.csv");
    let names: Vec<_> = tiles.iter().map(|r| r["roi"].as_str()).collect();
    assert_eq!(names.len(), 12);
    assert_eq!((names[0], names[1], names[4]), ("r1c1", "r1c2", "r2c1"));
    assert!(tiles.iter().all(|r| number(r, "window_area") == 900. && r["flag"].is_empty()));

    let grow = ["--roi-side", "20", "--roi-step", "25", "--roi-cells", "60"];
    place.ok(&[&measure[..], &["one", "--threads", "1"], &grow].concat());
    place.ok(&[&measure[..], &["three", "--threads", "3"], &grow].concat());
    assert_eq!(place.files("one"), place.files("three"), "the number of threads changes the files");
    let grown = place.table("one/rois.csv");
    assert_eq!(grown.len(), 20);
    let enough: Vec<_> = grown.iter().filter(|r| r["flag"].is_empty()).collect();
    assert!(enough.len() >= 4 && enough.len() < 20, "{}", enough.len());
    for row in &grown {
        let full = (60. ..64.).contains(&number(row, "n_bound"));
        assert_eq!(row["flag"], if full { "" } else { "few" }, "{row:?}");
        let inside = number(row, "x0") >= -0.5 && number(row, "y1") <= 99.5;
        assert!(inside && number(row, "x1") - number(row, "x0") >= 20. - 1e-9, "{row:?}");
    }
    let wide = place.run(&[&measure[..], &["wide", "--roi-side", "130"]].concat());
    assert!(wide.code == 2 && wide.stderr.contains("smaller --roi-side"), "{}", wide.stderr);
}

#[test]
fn a_region_in_a_polygon_is_the_part_of_it_in_the_box() {
    let place = Place::new();
    cones(&place, "cones.csv", "5");
    place.write("triangle.csv", "x,y\n0,0\n100,0\n0,90\n");
    place.write("rois.csv", "x0,y0,x1,y1\n0,0,20,20\n50,0,100,45\n80,60,100,80\n");
    place.ok(&[
        "measure",
        "cones.csv",
        "--window",
        "triangle.csv",
        "--rois",
        "rois.csv",
        "--out",
        "out",
        "-q",
    ]);
    let rows = place.table("out/rois.csv");
    assert_eq!((rows[0]["flag"].as_str(), number(&rows[0], "window_area")), ("", 400.));
    assert_eq!(rows[1]["flag"], "edge");
    assert!((number(&rows[1], "window_area") - 50. * 45. / 2.).abs() < 1e-6);
    assert_eq!((rows[2]["flag"].as_str(), rows[2]["n"].as_str()), ("outside", ""));
}

#[test]
fn few_points_are_measured_as_far_as_they_go() {
    let place = Place::new();
    for (k, rows) in FEW_POINTS.iter().enumerate() {
        place.write(&format!("marks/{k}.csv"), format!("x,y\n{rows}"));
    }
    let measure = ["measure", "marks", "--window", "0,0,10,10", "-q", "--out"];
    place.ok(&[&measure[..], &["tiles", "--roi-side", "5"]].concat());
    let rows = place.table("tiles/rois.csv");
    assert_eq!(rows.len(), 4 * FEW_POINTS.len());
    // points on a shared border belong to both regions
    assert!(rows[4..8].iter().all(|r| number(r, "n") == 1.) && number(&rows[0], "n") == 0.);
    place.ok(&[&measure[..], &["grown", "--roi-side", "5", "--roi-cells", "1"]].concat());
    assert!(place.table("grown/rois.csv").iter().all(|r| r["flag"] == "few" && number(r, "n_bound") == 0.));
}

#[test]
fn regions_that_cannot_be_are_refused() {
    let place = Place::new();
    place.write("a.csv", "x,y\n1,1\n");
    place.write("twice.csv", "name,x0,y0,x1,y1\nA,0,0,1,1\nA,0,0,2,2\n");
    place.write("flat.csv", "x0,y0,x1,y1\n0,0,1,1\n\n0,0,0,2\n");
    place.write("bare.csv", "0,0,1,1\n");
    let measure = ["measure", "a.csv", "--window", "unit", "--out", "out"];
    for (extra, words) in [
        (&["--rois", "twice.csv"][..], &["twice.csv, line 3", "line 2"][..]),
        (&["--rois", "flat.csv"], &["flat.csv, line 4", "area"]),
        (&["--rois", "bare.csv"], &["bare.csv, line 1", "x0, y0"]),
        (&["--rois", "none.csv"], &["none.csv", "cannot be read"]),
        (&["--roi-cells", "50"], &["--rois"]),
        (&["--roi-step", "5", "--rois", "flat.csv"], &["--roi-step", "cannot be used with"]),
        (&["--roi-step", "5"], &["--roi-side"]),
        (&["--roi-side", "5", "--rois", "flat.csv"], &["cannot be used with"]),
        (&["--roi-side", "5", "--roi-cells", "0"], &["1 to 100000"]),
        (&["--roi-side", "much"], &["5um (in µm)"]),
    ] {
        let error = place.refused(&[&measure[..], extra].concat());
        assert!(words.iter().all(|w| error.contains(w)), "{extra:?}: {error}");
    }
    // results never overwrite the table of regions that was read
    place.write("here/rois.csv", "x0,y0,x1,y1\n0,0,1,1\n");
    let error =
        place.refused(&["measure", "a.csv", "--window", "unit", "--rois", "here/rois.csv", "--out", "here"]);
    assert!(error.contains("another --out"), "{error}");
    assert!(place.read("here/rois.csv").starts_with("x0"));
}
