//! The files that `run` and `detect` write: their names, and that a repeated run writes the same
//! bytes.

use crate::common::{Place, number};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;

fn two_images() -> Place {
    let place = Place::new();
    place.image("in/a.png", 1);
    place.image("in/b.0.5_x.png", 2);
    place
}

#[test]
fn run_writes_the_documented_files_and_nothing_else() {
    let place = two_images();
    let outcome = place.ok(&["run", "in", "--out", "out"]);
    let mut expected: Vec<String> =
        ["index.html", "run.json", "summary.csv"].into_iter().map(str::to_owned).collect();
    for name in ["a", "b.0.5_x"] {
        for file in ["figure.svg", "metrics.json", "overlay.png", "pcf.csv", "points.csv"] {
            expected.push(format!("images/{name}/{file}"));
        }
    }
    expected.sort();
    assert_eq!(place.names("out"), expected);
    for word in ["out/summary.csv", "out/index.html", "modality", "cones in 2 images"] {
        assert!(outcome.stdout.contains(word), "{word}: {}", outcome.stdout);
    }
    assert!(!outcome.stdout.contains('\u{1b}') && !outcome.stderr.contains('\u{1b}'));
    assert_eq!(outcome.stderr.lines().count(), 2);
}

#[test]
fn no_samplers_make_no_columns_and_no_curves() {
    let place = two_images();
    place.ok(&["run", "in", "--out", "out", "--samplers", "none"]);
    assert!(!place.header("out/summary.csv").iter().any(|column| column.starts_with("l_infinity")));
    assert_eq!(place.header("out/images/a/pcf.csv")[..2], ["r", "g"]);
    assert!(!place.header("out/images/a/pcf.csv").iter().any(|column| column == "g_bnot"));
}

#[test]
fn curves_of_default_samplers_come_with_the_program_and_it_is_said() {
    let place = two_images();
    place.ok(&["run", "in/a.png", "--out", "out", "--samplers", "bnot,green"]);
    let metrics: serde_json::Value = serde_json::from_str(&place.read("out/images/a/metrics.json")).unwrap();
    let shipped = |k: usize| metrics["samplers"][k]["shipped"].as_bool();
    assert_eq!((shipped(0), shipped(1)), (Some(true), Some(false)));
}

#[test]
fn the_files_of_a_run_agree_with_each_other() {
    let place = two_images();
    place.ok(&["run", "in", "--out", "out", "--um-per-px", "0.5", "--samplers", "jittered,dart-throwing"]);
    let header = place.header("out/summary.csv");
    for column in [
        "file",
        "width_px",
        "height_px",
        "um_per_px",
        "modality",
        "n",
        "density_per_mm2",
        "density_per_px2",
        "spacing_ring_px",
        "spacing_density_px",
        "nn_mean_px",
        "nn_sd_px",
        "ri",
        "ri_interior",
        "l_infinity_jittered",
        "l_infinity_dart_throwing",
        "closest_sampler",
        "warnings",
    ] {
        assert!(header.iter().any(|h| h == column), "{column} is not in {header:?}");
    }
    let rows = place.table("out/summary.csv");
    assert_eq!(rows[0]["file"], "in/a.png");
    let points = place.table("out/images/a/points.csv");
    assert_eq!(points.len(), number(&rows[0], "n") as usize);
    assert_eq!((number(&rows[0], "width_px"), number(&rows[0], "height_px")), (64., 56.));
    let expected = points.len() as f64 / (64. * 56.) * 1e6 / 0.25;
    assert!((number(&rows[0], "density_per_mm2") / expected - 1.).abs() < 1e-12);
    for point in &points {
        assert!((number(point, "x_um") - 0.5 * number(point, "x_px")).abs() < 1e-12);
        assert!(number(point, "x_px") >= -0.5 && number(point, "x_px") <= 63.5);
    }
    let pcf = place.header("out/images/a/pcf.csv");
    assert_eq!(pcf, ["r", "g", "g_jittered", "g_dart_throwing"]);
    let curves = place.table("out/images/a/pcf.csv");
    assert_eq!(curves.len(), 200);
    let apart = |r: &BTreeMap<String, String>| (number(r, "g") - number(r, "g_jittered")).abs();
    let l_infinity = curves.iter().map(apart).fold(0., f64::max);
    assert!((l_infinity - number(&rows[0], "l_infinity_jittered")).abs() < 1e-12);
    let metrics = place.json("out/images/a/metrics.json");
    assert_eq!(metrics["mosaic"]["n"], points.len());
    let svg = place.read("out/images/a/figure.svg");
    roxmltree::Document::parse(&svg).unwrap();
}

#[test]
fn run_json_records_how_the_results_came_about() {
    let place = two_images();
    place.ok(&["run", "in", "--out", "out", "--seed", "7", "--samplers", "jittered"]);
    let run = place.json("out/run.json");
    assert_eq!(run["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(run["seed"], 7);
    assert_eq!(run["command"][1], "run");
    assert_eq!(run["options"]["samplers"][0], "jittered");
    assert!(run["seconds"].as_f64().unwrap() > 0.);
    for image in run["images"].as_array().unwrap() {
        let bytes = fs::read(place.path(image["file"].as_str().unwrap())).unwrap();
        let hash: String = Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect();
        assert_eq!(image["sha256"], hash);
        assert!(image["seconds"]["detect"].as_f64().is_some());
    }
}

#[test]
#[ignore = "slow: whole runs with one thread"]
fn any_number_of_threads_gives_the_same_bytes() {
    let place = Place::new();
    for seed in 1..=3 {
        place.image(&format!("in/{seed}.png"), seed);
    }
    place.ok(&["run", "in", "--out", "one", "--threads", "1", "-q"]);
    place.ok(&["--threads", "2", "run", "in", "--out", "two", "-q"]);
    assert_eq!(place.results("one"), place.results("two"));
    for threads in ["1", "2"] {
        place.ok(&["detect", "in", "--overlay", "--out", &format!("d{threads}"), "--threads", threads]);
        place.ok(&[
            "compare",
            "d1",
            "--window",
            "64x56",
            "--out",
            &format!("c{threads}"),
            "--threads",
            threads,
        ]);
    }
    assert_eq!(place.files("d1"), place.files("d2"));
    assert_eq!(place.files("c1"), place.files("c2"));
}

#[test]
fn another_seed_gives_other_reference_curves_and_the_same_cones() {
    let place = two_images();
    for seed in ["1", "2"] {
        place.ok(&["run", "in/a.png", "--out", seed, "--seed", seed, "--samplers", "jittered"]);
    }
    let (one, two) = (place.files("1"), place.files("2"));
    assert_eq!(one["images/a/points.csv"], two["images/a/points.csv"]);
    assert_ne!(one["images/a/pcf.csv"], two["images/a/pcf.csv"]);
}

#[test]
fn a_resumed_run_ends_like_an_undisturbed_one() {
    let place = Place::new();
    for seed in 1..=4 {
        place.image(&format!("in/{seed}.png"), seed);
    }
    let run = ["run", "in", "--out", "out", "--samplers", "jittered", "--um-per-px", "0.4", "--resume"];
    place.ok(&run);
    let undisturbed = place.results("out");
    fs::remove_dir_all(place.path("out/images/1")).unwrap();
    fs::remove_file(place.path("out/summary.csv")).unwrap();
    fs::remove_file(place.path("out/images/2/figure.svg")).unwrap();
    fs::rename(place.path("out/images/3"), place.path("out/images/.3.partial")).unwrap();
    let outcome = place.ok(&run);
    assert!(outcome.stdout.contains("1 kept from an earlier run"), "{}", outcome.stdout);
    assert_eq!(place.results("out"), undisturbed);
}

#[test]
fn resuming_redoes_what_changed() {
    let place = two_images();
    let run = ["run", "in", "--out", "out", "--samplers", "jittered", "--resume"];
    place.ok(&run);
    assert!(place.ok(&run).stdout.contains("2 kept"));
    place.image("in/a.png", 9);
    assert!(place.ok(&run).stdout.contains("1 kept"));
    for changed in [&["--um-per-px", "0.4"][..], &["--seed", "5"], &["--crop", "40x40"]] {
        let outcome = place.ok(&[&run[..], changed].concat());
        assert!(!outcome.stdout.contains("kept"), "{changed:?}: {}", outcome.stdout);
    }
    place.ok(&["run", "in", "--out", "fresh", "--samplers", "jittered", "--crop", "40x40"]);
    assert_eq!(place.results("fresh"), place.results("out"));
}

#[test]
fn a_crop_leaves_the_cones_inside() {
    let place = two_images();
    place.ok(&["run", "in/a.png", "--out", "out", "--crop", "0,0,50,40", "--samplers", "jittered"]);
    let points = place.table("out/images/a/points.csv");
    assert!(points.len() > 5);
    assert!(points.iter().all(|p| number(p, "x_px") <= 50. && number(p, "y_px") <= 40.));
    let density = number(&place.table("out/summary.csv")[0], "density_per_px2");
    assert!((density - points.len() as f64 / 2000.).abs() < 1e-12);
}

#[test]
fn names_keep_their_dots_and_equal_ones_get_their_folder() {
    let place = Place::new();
    place.image("first.png", 1);
    for copy in [
        "in/x/1.png",
        "in/y/1.PNG",
        "in/JC_0.08_aligned.Png",
        "in/two words, “and” a comma.png",
        "in/Zäpfchen_錐体.png",
        "in/<b>&'.png",
        "in/.hidden.png",
        "in/.git/z.png",
        "in/same.png",
    ] {
        place.copy("first.png", copy);
    }
    let tif = place.path("in/same.tif");
    place.ok(&["render", "--width", "64", "--height", "64", "--bits", "16", "--out", tif.to_str().unwrap()]);
    place.ok(&["run", "in", "in/x/1.png", "./in/x/1.png", "--out", "out", "--samplers", "jittered", "-q"]);
    let rows = place.table("out/summary.csv");
    let mut names: Vec<&str> = rows.iter().map(|r| r["name"].as_str()).collect();
    names.sort_unstable();
    let mut expected = [
        "<b>&'",
        "JC_0.08_aligned",
        "Zäpfchen_錐体",
        "in_same_png",
        "in_same_tif",
        "two words, “and” a comma",
        "x_1",
        "y_1",
    ];
    expected.sort_unstable();
    assert_eq!(names, expected);
    for name in expected {
        roxmltree::Document::parse(&place.read(&format!("out/images/{name}/figure.svg"))).unwrap();
    }
    let page = place.read("out/index.html");
    assert!(!page.contains("<b>&'") && page.contains("&lt;b&gt;&amp;"), "names are escaped on the page");
}

#[cfg(target_os = "linux")]
#[test]
fn names_that_differ_in_case_only_do_not_meet() {
    let place = Place::new();
    place.image("in/Cone.png", 1);
    place.image("in/cone.png", 2);
    place.ok(&["detect", "in", "--out", "out", "-q"]);
    assert_eq!(place.names("out"), ["in_Cone.csv", "in_cone_2.csv"]);
}

#[test]
fn results_inside_the_folder_of_images_are_not_taken_for_images() {
    let place = two_images();
    place.ok(&["run", "in", "--out", "in/report", "--samplers", "jittered", "-q"]);
    let first = place.results("in/report");
    place.ok(&["run", "in", "--out", "in/report", "--samplers", "jittered", "-q"]);
    assert_eq!(place.results("in/report"), first);
    place.ok(&["detect", "in", "--out", "in/cones", "--overlay", "-q"]);
    place.ok(&["detect", "in", "--out", "elsewhere", "--overlay", "-q"]);
    assert_eq!(place.files("in/cones"), place.files("elsewhere"));
}

#[test]
fn long_tables_are_cut_on_the_terminal_and_whole_in_the_file() {
    let place = Place::new();
    for i in 0..40 {
        place.write(&format!("csv/{i:02}.csv"), "x,y\n1,1\n5,5\n9,1\n");
    }
    let outcome = place.ok(&["measure", "csv", "--window", "10x10", "--out", "out"]);
    assert!(outcome.stdout.contains("… and 16 more in summary.csv"), "{}", outcome.stdout);
    assert_eq!(place.table("out/summary.csv").len(), 40);
    let outcome = place.ok(&["compare", "csv", "--window", "10x10", "--samplers", "square", "--out", "out"]);
    assert!(outcome.stdout.contains("… and 16 more in l_infinity.csv"), "{}", outcome.stdout);
}

#[test]
fn the_summary_says_how_sure_the_modality_is() {
    let place = two_images();
    let confidences = |arguments: &[&str]| -> Vec<f64> {
        place.ok(&[&["run", "in", "--out", "out", "--samplers", "jittered", "-q"], arguments].concat());
        place.table("out/summary.csv").iter().map(|row| number(row, "modality_confidence")).collect()
    };
    let found = confidences(&[]);
    assert!(found.iter().all(|c| *c > 1. / 3. && *c < 1.), "{found:?}");
    assert_eq!(confidences(&["--modality", "confocal"]), [1., 1.]);
}

#[test]
fn two_channels_of_a_field_are_compared() {
    let place = Place::new();
    let jitter = |i: usize, k: usize| (i * i * k % 19) as f64 / 5. - 1.9;
    let points: Vec<(f64, f64)> = (0..196)
        .map(|i| ((i % 14 * 10 + 8) as f64 + jitter(i, 7), (i / 14 * 10 + 8) as f64 + jitter(i, 5)))
        .collect();
    let csv = |skip: usize, dx: f64, dy: f64| {
        let rows = points.iter().enumerate().filter(|(k, _)| *k != skip);
        rows.fold("x,y\n".to_owned(), |text, (_, (x, y))| text + &format!("{},{}\n", x + dx, y + dy))
    };
    for (name, skip, shift) in [("confocal_1", 105, 3.), ("split_1", 76, 0.)] {
        place.image_of(&format!("images/{name}.png"), 150, 150, 1);
        place.write(&format!("cones/{name}.csv"), csv(skip, shift, shift / 2.));
    }
    place.write("m.csv", "id,pair,modality\nconfocal_1,one,confocal\nsplit_1,one,Split\n");
    let run = ["run", "images", "--cones", "cones", "--samplers", "uniform", "--out"];
    for (out, how) in [("a", ["--pair", "confocal=confocal_*,split=split_*"]), ("b", ["--manifest", "m.csv"])]
    {
        place.ok(&[&run[..], &[out], &how[..]].concat());
        let row = place.table(&format!("{out}/pairs.csv")).remove(0);
        assert_eq!([&*row["image_1"], &*row["image_2"]], ["confocal_1", "split_1"]);
        assert_eq!([&*row["alone_1"], &*row["alone_2"], &*row["warnings"]], ["1", "1", ""]);
        assert!((row["shift_x_px"].parse::<f64>().unwrap() + 3.).abs() < 1e-9, "{row:?}");
        let cones = place.table(&format!("{out}/pairs/{}.csv", row["name"]));
        let seen = |word: &str| cones.iter().filter(|c| c["seen_in"] == word).count();
        assert_eq!([seen("both"), seen("confocal"), seen("split")], [194, 1, 1]);
    }
    assert!(
        place.refused(&[&run[..], &["c", "--pair", "confocal=a*"]].concat()).contains("names one channel")
    );
}

#[test]
fn the_image_decided_otherwise_than_its_folder_is_named_first() {
    let place = Place::new();
    fs::create_dir_all(place.path("images")).unwrap();
    let size = ["--width", "150", "--height", "150"];
    for k in 1..=6 {
        let (name, seed) = (format!("images/c{k}.png"), k.to_string());
        let given = ["render", "--preset", "fovea", "--seed", &seed, "--out", &name, "-q"];
        place.ok(&[&given[..], &size].concat());
    }
    place.ok(&[&["render", "--preset", "split", "--out", "images/s.png", "-q"][..], &size].concat());
    let given = ["run", "images", "--samplers", "none", "--out", "out"];
    place.ok(&given);
    let rows = place.table("out/summary.csv");
    let warned = |row: &BTreeMap<String, String>| row["warnings"].contains("6 of 7 images of this size");
    let odd: Vec<&str> = rows.iter().filter(|row| warned(row)).map(|row| &*row["name"]).collect();
    assert_eq!(odd, ["s"]);
    // a modality that is stated is no mistake of the program
    place.write("manifest.csv", "file,modality\ns.png,split\n");
    place.ok(&[&given[..], &["--manifest", "manifest.csv", "--fresh"]].concat());
    assert!(!place.table("out/summary.csv").iter().any(warned));
}
