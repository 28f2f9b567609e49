//! The commands `compare`, `run --verdict` and `paper`: the paper's tables, and verdicts by
//! simulation.

use crate::common::{Place, number};

/// Writes one point set of 200 points of each sampler into `marks/`.
fn marks(samplers: &[(&str, &str)]) -> Place {
    let place = Place::new();
    place.write("marks/readme.md", "not read");
    for (file, sampler) in samplers {
        let seed = (file.len() + file.bytes().map(usize::from).sum::<usize>()).to_string();
        let out = format!("marks/{file}.csv");
        place.ok(&["sample", sampler, "-n", "200", "--seed", &seed, "--out", &out, "-q"]);
    }
    place
}

/// Arguments that compare the point sets in `marks/` with two samplers.
const COMPARE: [&str; 6] = ["compare", "marks", "--window", "unit", "--samplers", "bridson,jittered"];

#[test]
fn a_mosaic_is_as_its_own_sampler_and_differs_from_another() {
    let place = marks(&[("b", "bridson"), ("j", "jittered")]);
    let text = place.ok(&[&COMPARE[..], &["--out", "out"]].concat()).stdout;
    let verdicts = place.table("out/verdicts.csv");
    let words: Vec<_> =
        verdicts.iter().map(|v| (v["file"].as_str(), v["sampler"].as_str(), v["verdict"].as_str())).collect();
    let expected = [
        ("marks/b.csv", "bridson", "as"),
        ("marks/b.csv", "jittered", "differs"),
        ("marks/j.csv", "bridson", "differs"),
        ("marks/j.csv", "jittered", "as"),
    ];
    assert_eq!(words, expected);
    assert_eq!(number(&verdicts[1], "p_envelope"), 1. / 200.);
    assert!(
        number(&verdicts[1], "l_infinity_to_simulations") > number(&verdicts[1], "l_infinity_95_percent")
    );
    assert!(
        !verdicts[1]["outside_r_in_spacings"].is_empty() && verdicts[0]["outside_r_in_spacings"].is_empty()
    );
    assert!(
        text.contains("consistent with bridson: p = ") && text.contains("; differs from 1 more"),
        "{text}"
    );
    let envelope = place.header("out/b.envelope.csv");
    assert_eq!(envelope[..5], ["r", "g", "mean_bridson", "low_bridson", "high_bridson"]);
    assert!(place.read("out/b.verdict.svg").contains("jittered, p = 0.0050"));
}

#[test]
fn regularity_has_the_paper_s_form_and_says_which_deviation() {
    let place = marks(&[("b", "bridson")]);
    place.ok(&[&COMPARE[..], &["--no-verdict", "--out", "out", "-q"]].concat());
    let row = &place.table("out/regularity.csv")[0];
    let ratio = number(row, "nn_sd_sample") / number(row, "nn_sd_population");
    let n = number(row, "n");
    assert!((ratio - (n / (n - 1.)).sqrt()).abs() < 1e-12);
    assert!(
        (number(row, "nn_mean") / number(row, "nn_sd_population") - number(row, "ri_population")).abs()
            < 1e-9
    );
    assert!(row["nn_mean_um"].is_empty());
    place.write("px.csv", "x,y\n10,10\n20,10\n31,10\n10,20\n");
    let scaled = ["compare", "px.csv", "--window", "40x40", "--um-per-px", "0.5", "--samplers", "jittered"];
    place.ok(&[&scaled[..], &["--no-verdict", "--out", "scaled", "-q"]].concat());
    let row = &place.table("scaled/regularity.csv")[0];
    for column in ["nn_mean", "nn_sd_population", "nn_sd_sample"] {
        assert_eq!(number(row, &format!("{column}_um")), 0.5 * number(row, column), "{column}");
    }
    assert!(!place.names("out").contains(&"verdicts.csv".to_owned()));
}

#[test]
fn regularity_is_correlated_with_distance_from_five_mosaics_on() {
    let six = [
        ("a", "bridson"),
        ("b", "jittered"),
        ("c", "uniform"),
        ("d", "dart-throwing"),
        ("e", "uniform"),
        ("f", "jittered"),
    ];
    let place = marks(&six);
    let text = place.ok(&[&COMPARE[..], &["--no-verdict", "--out", "out"]].concat()).stdout;
    let finding = &place.table("out/finding.csv")[0];
    assert!(number(finding, "spearman_rho_of_ri_and_l_infinity") < -0.8, "{finding:?}");
    assert!(text.contains("more regular mosaics are nearer to bridson"), "{text}");
    let place = marks(&six[..3]);
    let text = place.ok(&[&COMPARE[..], &["--no-verdict", "--out", "out"]].concat()).stdout;
    assert!(
        text.contains("distance: not tested (3 mosaics with a regularity index, at least 5 are needed)"),
        "{text}"
    );
    assert_eq!(place.table("out/finding.csv")[0]["p_value"], "");
}

#[test]
fn threads_do_not_change_a_byte() {
    let place = marks(&[("a", "bridson"), ("b", "jittered"), ("c", "uniform")]);
    for threads in ["1", "3"] {
        let out = format!("out{threads}");
        let more = ["--simulations", "39", "--threads", threads, "--out", &out, "-q"];
        place.ok(&[&COMPARE[..], &more].concat());
    }
    assert_eq!(place.files("out1"), place.files("out3"));
}

#[test]
fn too_few_simulations_are_refused_with_the_range() {
    let place = marks(&[("a", "bridson")]);
    let message = place.refused(&[&COMPARE[..], &["--simulations", "10", "--out", "out"]].concat());
    assert!(message.contains("39 to 9999"), "{message}");
}

#[test]
fn run_gives_verdicts_when_asked() {
    let place = Place::new();
    place.image_of("in/a.png", 120, 120, 1);
    let run =
        ["run", "in", "--samplers", "uniform", "--out", "out", "--verdict", "--simulations", "39", "-q"];
    place.ok(&run);
    let verdict = &place.table("out/verdicts.csv")[0];
    assert_eq!((verdict["sampler"].as_str(), verdict["verdict"].as_str()), ("uniform", "differs"));
    assert!(place.read("out/index.html").contains("differs from uniform"));
    assert!(place.names("out").contains(&"images/a/verdict.svg".to_owned()));
    let before = place.files("out/images");
    place.ok(&[&run[..], &["--resume"]].concat());
    assert_eq!(place.files("out/images"), before);
    place.ok(&["run", "in", "--samplers", "uniform", "--out", "out", "-q"]);
    assert!(!place.names("out").contains(&"images/a/verdict.svg".to_owned()));
}

#[test]
fn a_trend_brings_the_functions_that_allow_for_it() {
    let place = Place::new();
    let mut text = String::from("x,y\n");
    // rows of points whose distances shrink from row to row, with a little scatter along the rows
    for k in 0..600u32 {
        let (column, row) = (k % 20, k / 20);
        let scatter = f64::from(k * 7919 % 101) / 101.;
        let y = (f64::from(row) / 30.).powf(1.8) * 100.;
        text.push_str(&format!("{},{}\n", (f64::from(column) + scatter) * 5., y.min(99.9)));
    }
    place.write("marks/dense.csv", text);
    place.ok(&["measure", "marks", "--window", "100x100", "--out", "out", "-q"]);
    let warnings = &place.table("out/summary.csv")[0]["warnings"];
    assert!(warnings.contains("density varies") && warnings.contains("g_inhomogeneous"), "{warnings}");
    let header = place.header("out/dense.pcf.csv");
    assert_eq!(header, ["r", "g", "g_inhomogeneous", "g_locally_scaled", "k_inhomogeneous"]);
    let even = marks(&[("b", "bridson")]);
    even.ok(&["measure", "marks", "--window", "unit", "--out", "out", "-q"]);
    assert_eq!(even.header("out/b.pcf.csv"), ["r", "g"]);
}

#[test]
fn shrunken_tissue_is_measured_in_living_micrometres() {
    let place = Place::new();
    place.write("px.csv", "x,y\n10,10\n20,10\n30,10\n10,20\n");
    place.write("um.csv", "x_um,y_um\n10,10\n20,10\n30,10\n10,20\n");
    let row = |file: &str, more: &[&str]| {
        place.ok(&[&["measure", file, "--window", "0,0,40,40", "--out", "out", "-q"][..], more].concat());
        let row = place.table("out/summary.csv").remove(0);
        (number(&row, "nn_mean_um"), number(&row, "density_per_mm2"))
    };
    for (file, scale) in [("px.csv", &["--um-per-px", "1"][..]), ("um.csv", &[])] {
        let (slide, slide_density) = row(file, scale);
        let (alive, density) = row(file, &[scale, &["--shrinkage", "0.2"]].concat());
        assert!((alive - slide / 0.8).abs() < 1e-12, "{file}: {slide} {alive}");
        assert!((density - slide_density * 0.64).abs() < 1e-9, "{file}: {slide_density} {density}");
    }
    let failed =
        place.run(&["measure", "px.csv", "--window", "0,0,40,40", "--out", "out", "--shrinkage", "0.2"]);
    assert!(failed.code == 2 && failed.stderr.contains("--um-per-px"), "{}", failed.stderr);
    let message = place.refused(&["measure", "px.csv", "--window", "unit", "--out", "o", "--shrinkage", "1"]);
    assert!(message.contains("0 to 0.9"), "{message}");
}
