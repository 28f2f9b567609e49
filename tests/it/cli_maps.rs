//! The commands `measure --maps` and `run --maps`, run as a user runs them.

use crate::common::{FEW_POINTS, Place, number};

/// Writes `bump.png`, a density that peaks at (80, 90), on 200 × 160 px.
fn bump(place: &Place) {
    let level = |x: u32, y: u32| {
        let r2 = (f64::from(x) - 80.).powi(2) + (f64::from(y) - 90.).powi(2);
        (255. * (0.25 + 0.75 * (-r2 / (2. * 45. * 45.)).exp())).round() as u8
    };
    let picture = image::GrayImage::from_fn(200, 160, |x, y| image::Luma([level(x, y)]));
    picture.save(place.path("bump.png")).unwrap();
}

fn sampled(place: &Place, n: &str, name: &str) {
    bump(place);
    place.ok(&[
        "sample",
        "bnot",
        "-n",
        n,
        "--steps",
        "10",
        "--density",
        "bump.png",
        "--window",
        "200x160",
        "--out",
        name,
    ]);
}

#[test]
fn peak_and_centroid_of_a_sampled_density_are_found() {
    let place = Place::new();
    sampled(&place, "1500", "cones.csv");
    let measure =
        ["measure", "cones.csv", "--window", "200x160", "--um-per-px", "0.5", "--maps", "--map-cells", "60"];
    place.ok(&[&measure[..], &["--out", "one", "--threads", "1"]].concat());
    place.ok(&[&measure[..], &["--out", "three", "--threads", "3"]].concat());
    assert_eq!(place.files("one"), place.files("three"), "the number of threads changes the files");

    let landmarks = &place.table("one/landmarks.csv")[0];
    let off = |x: &str, y: &str| (number(landmarks, x) - 80.).hypot(number(landmarks, y) - 90.);
    // the picture has the proportions of the density, in points per px²
    let picture = image::open(place.path("bump.png")).unwrap().to_luma8();
    let mass: f64 = picture.pixels().map(|p| f64::from(p.0[0])).sum();
    let peak = 1500. * 255. / mass;
    let spacing = (2. / (3f64.sqrt() * peak)).sqrt();
    println!(
        "peak {:.4} off {:.2} s, CDC off {:.2} s, ellipse off {:.2} s; {landmarks:?}",
        number(landmarks, "pcd") / peak,
        off("pcd_x", "pcd_y") / spacing,
        off("cdc_x", "cdc_y") / spacing,
        off("ellipse_x", "ellipse_y") / spacing,
    );
    assert!((number(landmarks, "pcd") / peak - 1.).abs() < 0.06, "{landmarks:?}");
    assert!(off("cdc_x", "cdc_y") < spacing && off("ellipse_x", "ellipse_y") < spacing, "{landmarks:?}");
    assert_eq!((landmarks["local_window"].as_str(), landmarks["note"].as_str()), ("60 cells", ""));
    let per_mm2 = number(landmarks, "pcd_per_mm2") / number(landmarks, "pcd");
    assert!((per_mm2 / 4e6 - 1.).abs() < 1e-12);

    let rows = place.table("one/cones.maps.csv");
    assert_eq!(rows.len(), 1500);
    let whole = rows.iter().filter(|r| r["flag"].is_empty()).count();
    assert_eq!(whole as f64, number(landmarks, "n_whole"));
    for row in &rows {
        assert!(number(row, "bound") >= 60. && number(row, "density") > 0. && number(row, "ri") > 1.);
        let (x, y, half) = (number(row, "x"), number(row, "y"), number(row, "side") / 2.);
        let fits = x - half >= -0.5 && y - half >= -0.5 && x + half <= 199.5 && y + half <= 159.5;
        assert_eq!(row["flag"], if fits { "" } else { "edge" });
    }
    let profile = place.table("one/cones.profiles.csv");
    for along in ["ring", "right", "down", "left", "up"] {
        assert!(profile.iter().filter(|r| r["along"] == along).count() > 3, "{along}");
    }
    let options = &place.json("one/options.json")["maps"];
    assert_eq!((&options["window"]["cells"], &options["isodensity"]), (&60.into(), &0.8.into()));
    let figure = place.read("one/cones.maps.svg");
    roxmltree::Document::parse(&figure).unwrap();
    for words in
        ["cones/mm²", "inter-cell distance (µm)", "peak (PCD)", "60 bound cells", "six-sided cells (%)"]
    {
        assert!(figure.contains(words), "{words}");
    }
    // files that the program wrote are not taken for input
    place.copy("cones.csv", "one/cones.csv");
    place.ok(&["measure", "one", "--window", "200x160", "--out", "again"]);
    assert_eq!(place.table("again/summary.csv").len(), 1);
}

#[test]
fn windows_of_a_side_may_be_in_micrometres() {
    let place = Place::new();
    place.ok(&["sample", "jittered", "-n", "900", "--window", "120x120", "--out", "a.csv"]);
    let measure = ["measure", "a.csv", "--window", "120x120", "--maps", "--out"];
    place.ok(&[&measure[..], &["px", "--map-side", "30", "--profile-step", "10"]].concat());
    place.ok(&[&measure[..], &["um", "--map-side", "15um", "--profile-step", "5um", "--um-per-px", "0.5"]]
        .concat());
    let columns = |out: &str| {
        let rows = place.table(&format!("{out}/a.maps.csv"));
        rows.iter().map(|r| (r["side"].clone(), r["density"].clone(), r["ri"].clone())).collect::<Vec<_>>()
    };
    assert_eq!(columns("px"), columns("um"));
    let first = |out: &str, column: &str| place.table(&format!("{out}/a.profiles.csv"))[0][column].clone();
    assert_eq!(
        (first("px", "r"), first("um", "r"), first("um", "r_um")),
        ("5.0".into(), "5.0".into(), "2.5".into())
    );
    let unscaled = place.run(&[&measure[..], &["none", "--map-side", "15um"]].concat());
    assert_eq!(unscaled.code, 2);
    assert!(
        unscaled.stderr.contains("a.csv") && unscaled.stderr.contains("--um-per-px"),
        "{}",
        unscaled.stderr
    );
}

#[test]
fn few_points_have_maps_without_values_and_a_reason() {
    let place = Place::new();
    for (k, rows) in FEW_POINTS.iter().enumerate() {
        place.write(&format!("marks/{k}.csv"), format!("x,y\n{rows}"));
    }
    place.ok(&["measure", "marks", "--window", "0,0,10,10", "--maps", "--out", "out", "-q"]);
    let landmarks = place.table("out/landmarks.csv");
    assert_eq!(landmarks.len(), FEW_POINTS.len());
    for row in &landmarks {
        assert!(
            row["pcd"].is_empty() && row["cdc_x"].is_empty() && row["note"].starts_with("no map"),
            "{row:?}"
        );
    }
    for k in 0..FEW_POINTS.len() {
        assert!(place.table(&format!("out/{k}.maps.csv")).iter().all(|r| r["flag"] == "few"));
        assert!(place.table(&format!("out/{k}.profiles.csv")).is_empty());
        roxmltree::Document::parse(&place.read(&format!("out/{k}.maps.svg"))).unwrap();
    }
}

#[test]
fn options_of_maps_that_cannot_be_are_refused() {
    let place = Place::new();
    place.write("a.csv", "x,y\n1,1\n");
    let measure = ["measure", "a.csv", "--window", "unit", "--out", "out"];
    for (extra, words) in [
        (&["--maps", "--map-cells", "2"][..], "3 to 100000"),
        (&["--maps", "--map-side", "0"], "positive number"),
        (&["--maps", "--map-side", "5mm"], "5um (in µm)"),
        (&["--maps", "--isodensity", "1"], "0.01 to 0.99"),
        (&["--maps", "--map-side", "5", "--map-cells", "50"], "cannot be used with"),
        (&["--map-cells", "50"], "--maps"),
    ] {
        let error = place.refused(&[&measure[..], extra].concat());
        assert!(error.contains(words), "{extra:?}: {error}");
    }
}

#[test]
fn a_run_maps_every_image_and_keeps_what_is_done() {
    let place = Place::new();
    place.image_of("images/a.png", 110, 100, 1);
    place.image_of("images/b.png", 100, 110, 2);
    let run = ["run", "images", "--samplers", "jittered", "--out", "out"];
    let maps = [&run[..], &["--maps", "--map-cells", "25", "--resume"]].concat();
    place.ok(&maps);
    let first = place.files("out");
    for image in ["a", "b"] {
        for file in ["maps.csv", "maps.svg", "profiles.csv"] {
            assert!(first.contains_key(&format!("images/{image}/{file}")), "{image} {file}");
        }
    }
    let landmarks = place.table("out/landmarks.csv");
    assert_eq!(landmarks.len(), 2);
    assert!(landmarks[0]["file"].ends_with("a.png") && number(&landmarks[0], "pcd") > 0.);
    assert_eq!(place.json("out/run.json")["options"]["maps"]["window"]["cells"], 25);
    let page = place.read("out/index.html");
    assert!(page.contains("images/a/maps.svg") && page.contains("Peak density"), "{page}");

    let again = place.ok(&maps);
    assert!(again.stdout.contains("2 kept from an earlier run"), "{}", again.stdout);
    let second = place.files("out");
    let same = |file: &str| assert_eq!(first[file], second[file], "{file}");
    ["landmarks.csv", "summary.csv", "images/a/maps.svg", "images/b/metrics.json"].into_iter().for_each(same);

    std::fs::remove_file(place.path("out/images/a/maps.svg")).unwrap();
    let mended = place.ok(&maps);
    assert!(mended.stdout.contains("1 kept from an earlier run"), "{}", mended.stdout);
    assert_eq!(place.files("out")["images/a/maps.svg"], first["images/a/maps.svg"]);
    // other local windows give other results; a run without maps removes the files of the maps
    let other = place.ok(&[&run[..], &["--maps", "--map-cells", "30", "--resume"]].concat());
    assert!(!other.stdout.contains("kept"), "{}", other.stdout);
    place.ok(&[&run[..], &["--resume"]].concat());
    assert!(!place.path("out/images/a/maps.csv").exists());
}
