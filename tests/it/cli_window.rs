//! The option `--window` of `run` and `measure`: the area that counts.

use crate::common::{Place, number};

/// Writes a simulated image of 120 × 100 px that is black outside an L-shaped area. The L consists
/// of two tiles, of which the right one lies lower.
fn montage(place: &Place) {
    place.image_of("whole.png", 120, 100, 3);
    let mut image = image::open(place.path("whole.png")).unwrap().to_luma8();
    for (x, y, pixel) in image.enumerate_pixels_mut() {
        let imaged = x < 70 || y >= 50;
        pixel.0[0] = if imaged { pixel.0[0].max(1) } else { 0 };
    }
    image.save(place.path("montage.png")).unwrap();
}

/// Area of the imaged part in px²: the L without the 1 px along its black edges, that is x ≤ 68.5
/// or y ≥ 50.5.
const AREA: f64 = 120. * 100. - 51. * 51.;

#[test]
fn what_was_imaged_is_what_counts() {
    let place = Place::new();
    montage(&place);
    let options = ["--samplers", "jittered", "--um-per-px", "0.5", "-q"];
    place.ok(&[&["run", "montage.png", "--out", "auto"], &options[..]].concat());
    place.ok(&[&["run", "montage.png", "--window", "image", "--out", "image"], &options[..]].concat());
    let (auto, image) = (&place.table("auto/summary.csv")[0], &place.table("image/summary.csv")[0]);
    assert_eq!(number(auto, "window_area_px2"), AREA);
    assert!((number(auto, "window_area_mm2") - AREA * 0.25e-6).abs() < 1e-12);
    assert_eq!(number(image, "window_area_px2"), 12_000.);
    assert!((number(auto, "density_per_px2") / (number(auto, "n") / AREA) - 1.).abs() < 1e-12);
    assert!(number(auto, "density_per_px2") > 1.1 * number(image, "density_per_px2"));
    let metrics = place.json("auto/images/montage/metrics.json");
    assert_eq!(metrics["mosaic"]["outline"][0].as_array().unwrap().len(), 6);
    assert_eq!(place.json("auto/run.json")["options"]["window"], "auto");
    assert!(place.read("auto/index.html").contains("78 % of the image"));
    assert!(place.json("image/images/montage/metrics.json")["mosaic"].get("outline").is_none());
    // the figure draws the outline twice: on the picture and around the points
    let lines = |file: &str| place.read(file).matches("<path").count();
    assert!(lines("auto/images/montage/figure.svg") >= lines("image/images/montage/figure.svg") + 2);
}

#[test]
fn a_file_of_corners_a_rectangle_and_a_crop_say_the_same() {
    let place = Place::new();
    montage(&place);
    place.write("corners.csv", "x_px,y_px\n10,10\n60,10\n60,90\n10,90\n");
    place.write("corners_um.csv", "x_um,y_um\n5,5\n30,5\n30,45\n5,45\n");
    let windows = [
        &["--window", "corners.csv"][..],
        &["--window", "10,10,60,90"],
        &["--window", "5,5,30,45um"],
        &["--window", "corners_um.csv"],
        &["--crop", "10,10,60,90"],
        &["--window", "corners.csv", "--crop", "120x100"],
    ];
    let rows: Vec<_> = windows
        .iter()
        .enumerate()
        .map(|(i, window)| {
            let out = i.to_string();
            let options =
                ["run", "montage.png", "--um-per-px", "0.5", "--samplers", "square", "--out", &out, "-q"];
            place.ok(&[&options[..], window].concat());
            place.table(&format!("{out}/summary.csv")).remove(0)
        })
        .collect();
    for row in &rows {
        assert_eq!(row, &rows[0]);
        assert_eq!(number(row, "window_area_px2"), 4000.);
    }
}

#[test]
fn measure_takes_the_same_windows() {
    let place = Place::new();
    montage(&place);
    let points: String = (0..30).map(|i| format!("{},{}\n", 5 + 20 * (i % 6), 5 + 20 * (i / 6))).collect();
    place.write("montage.csv", format!("x,y\n{points}"));
    place.write(
        "hole.csv",
        "ring,x,y\na,0,0\na,100,0\na,100,80\na,0,80\nb,20,20\nb,60,20\nb,60,60\nb,20,60\n",
    );
    let measured = |out: &str, window: &[&str]| {
        place.ok(&[&["measure", "montage.csv", "--out", out, "-q"], window].concat());
        place.table(&format!("{out}/summary.csv")).remove(0)
    };
    // of the 30 points, those at x = 85 and 105 with y = 5, 25 or 45 lie outside
    let auto = measured("1", &[]);
    assert_eq!(
        (number(&auto, "window_area"), number(&auto, "n"), number(&auto, "outside_window")),
        (AREA, 24., 6.)
    );
    assert_eq!(number(&measured("2", &["--window", "image"]), "n"), 30.);
    // of the 5 × 4 points, four lie in the hole
    let hole = measured("3", &["--window", "hole.csv"]);
    assert_eq!((number(&hole, "window_area"), number(&hole, "n")), (8000. - 1600., 16.));
    for edge in ["set-covariance", "translation", "isotropic", "none"] {
        measured(edge, &["--window", "hole.csv", "--edge", edge]);
        let curve = place.table(&format!("{edge}/montage.pcf.csv"));
        assert!(curve.iter().all(|row| number(row, "g").is_finite()));
    }
    place.ok(&[
        "compare",
        "montage.csv",
        "--window",
        "hole.csv",
        "--samplers",
        "jittered",
        "--out",
        "4",
        "-q",
    ]);
    assert!(number(&place.table("4/l_infinity.csv")[0], "jittered") > 0.);
    let torus = place.run(&["measure", "montage.csv", "--window", "hole.csv", "--torus", "--out", "5"]);
    assert!(
        torus.code == 2 && torus.stderr.contains("--torus needs a rectangular window"),
        "{}",
        torus.stderr
    );
}

#[test]
fn windows_that_cannot_be_say_why() {
    let place = Place::new();
    montage(&place);
    place.write("bow.csv", "x,y\n0,0\n50,50\n50,0\n0,50\n");
    place.write("word.csv", "x,y\n0,0\n50,fifty\n50,0\n");
    place.write("far.csv", "500,500\n600,500\n600,600\n");
    place.write("um.csv", "x_um,y_um\n0,0\n50,0\n50,50\n");
    for (file, words) in
        [("bow.csv", "crosses itself at (25"), ("word.csv", "line 3"), ("none.csv", "is neither a window")]
    {
        let error = place.refused(&["run", "montage.png", "--window", file, "--out", "out"]);
        assert!(error.contains(file) && error.contains(words), "{error}");
    }
    let error = place.refused(&["run", "montage.png", "--window", "50x50um", "--out", "out"]);
    assert!(error.contains("--um-per-px"), "{error}");
    for (file, words) in [("far.csv", "does not overlap"), ("um.csv", "--um-per-px")] {
        let outcome = place.run(&["run", "montage.png", "--window", file, "--out", "out"]);
        assert!(outcome.code == 2 && outcome.stderr.contains(words), "{}", outcome.stderr);
    }
}

#[test]
fn measure_crops_about_the_middle_of_the_window() {
    let place = Place::new();
    let mut marks = String::from("x_px,y_px\n300,300\n");
    for k in 0..400 {
        marks.push_str(&format!("{},{}\n", 5 * (k % 20) + 2 + k % 3, 5 * (k / 20) + 2));
    }
    place.write("marks.csv", marks);
    let measure = ["measure", "marks.csv", "--window", "100x100", "--um-per-px", "0.5", "--out"];
    for (out, crop) in [("px", "60x40"), ("um", "30x20um"), ("edges", "19.5,29.5,79.5,69.5px")] {
        place.ok(&[&measure[..], &[out, "--crop", crop]].concat());
        let row = &place.table(&format!("{out}/summary.csv"))[0];
        assert_eq!(number(row, "window_area"), 2400., "{crop}");
        assert_eq!((number(row, "n"), number(row, "outside_window")), (96., 1.), "{crop}");
    }
    let options = place.json("um/options.json");
    assert_eq!((options["crop"].as_str(), options["window"].as_str()), (Some("30x20um"), Some("100x100")));
    let outcome = place.run(&[&measure[..], &["no", "--crop", "200,200,300,300"]].concat());
    assert_eq!(outcome.code, 2, "{}", outcome.stdout);
    let complaint = &outcome.stderr;
    assert!(complaint.contains("marks.csv") && complaint.contains("crop 200,200,300,300"), "{complaint}");
    let complaint = place.refused(&[&measure[..], &["no", "--crop", "20x20", "--torus"]].concat());
    assert!(complaint.contains("--torus"), "{complaint}");
}
