//! Too few points, collinear, coincident and border points: every statistic is a meaningful value
//! or an empty cell.

use crate::common::Place;
use std::collections::BTreeSet;

/// Columns that are empty for fewer than two points.
const NEED_TWO: &[&str] = &[
    "nn_mean",
    "nn_sd",
    "icd_all_mean",
    "furthest_all_mean",
    "clark_evans_naive",
    "clark_evans_donnelly",
    "recovery_reliability",
    "recovery_bin_width",
];
/// Columns that are empty for fewer than three points. With two points, both nearest-neighbour
/// distances are equal, both axes to the neighbour are equal, and neither point is interior.
const NEED_THREE: &[&str] = &["ri", "clark_evans_cdf", "nn_axis_resultant", "nn_axis_deg"];
/// Columns that are empty without a bound cell, which takes at least four points.
const NEED_BOUND: &[&str] = &[
    "density_bound",
    "nn_bound_mean",
    "nn_bound_ri",
    "icd_bound_mean",
    "icd_bound_ri",
    "furthest_bound_mean",
    "furthest_bound_ri",
    "voronoi_area_mean",
    "voronoi_area_cv",
    "voronoi_area_ri",
    "voronoi_sides_ri",
    "six_sided_percent",
    "psi6_mean",
    "psi6_global",
    "anisotropy",
    "anisotropy_axis_deg",
    "neighbour_ellipse_major",
    "neighbour_ellipse_minor",
    "hexagon_axis_deg",
];
/// Columns that are empty for fewer than 20 points: they need 10 groups of neighbours, or two
/// different distances of interior points.
const NEED_MORE: &[&str] = &[
    "ri_interior",
    "nn_axis_p",
    "modal_spacing",
    "modal_row_spacing",
    "modal_power",
    "trend_p",
    "density_variation",
    "density_variation_low",
    "density_variation_high",
    "density_ratio",
];
/// Columns that can be empty for up to three points, because the density recovery profile never
/// exceeds the mean density.
const NEED_RECOVERY: &[&str] = &["recovery_effective_radius", "recovery_packing"];

/// Name and coordinates of every pattern, in a window of 10 × 10.
const PATTERNS: [(&str, &str); 9] = [
    ("n0", ""),
    ("n1", "5,5\n"),
    ("n2", "5,5\n9,9\n"),
    ("n3", "5,5\n9,9\n3,1\n"),
    ("line", "1,1\n2,2\n3,3\n4,4\n"),
    ("level", "1,5\n2,5\n3,5\n9,5\n"),
    ("same", "5,5\n5,5\n5,5\n5,5\n"),
    ("twice", "5,5\n5,5\n2,3\n2,3\n7,1\n"),
    ("border", "0,0\n10,0\n0,10\n10,10\n5,0\n"),
];

fn patterns() -> Place {
    let place = Place::new();
    for (name, points) in PATTERNS {
        place.write(&format!("in/{name}.csv"), format!("x,y\n{points}"));
    }
    place.write("window.csv", "x,y\n0,0\n10,0\n10,10\n5,11\n0,10\n");
    place
}

/// Returns the names of the empty columns of a row, except those that are empty only for lack of a
/// scale or a manifest.
fn empty(row: &std::collections::BTreeMap<String, String>) -> BTreeSet<String> {
    let known = ["_um", "_mm2", "_deg2", "_arcmin", "_arcmin2", "_um_per_unit"];
    let other = [
        "um_per_unit",
        "um_per_px",
        "um_per_degree",
        "eccentricity_mm",
        "meridian",
        "density_of_expected_percent",
        "warnings",
    ];
    let unscaled = |name: &str| {
        known.iter().any(|end| name.ends_with(end))
            || other.contains(&name)
            // the unit of the coordinates is px here, so a column in px repeats a column without a
            // unit
            || ["_px", "_per_px2", "_px2"]
                .iter()
                .filter_map(|end| name.strip_suffix(end))
                .any(|stem| row.get(stem).is_some_and(String::is_empty))
            // a column of lengths in degrees repeats a column without a unit; a column of angles
            // does not
            || name.strip_suffix("_deg").is_some_and(|stem| row.contains_key(stem))
    };
    row.iter()
        .filter(|(name, value)| value.is_empty() && !unscaled(name))
        .map(|(name, _)| name.clone())
        .collect()
}

#[test]
fn what_few_points_do_not_define_is_empty_and_the_rest_is_not() {
    let place = patterns();
    place.ok(&["measure", "in", "--window", "0,0,10,10", "--functions", "--out", "out", "-q"]);
    let rows = place.table("out/summary.csv");
    for (name, lists) in [
        ("n0", &[&["spacing_density"][..], NEED_TWO, NEED_THREE, NEED_BOUND, NEED_MORE, NEED_RECOVERY][..]),
        ("n1", &[NEED_TWO, NEED_THREE, NEED_BOUND, NEED_MORE, NEED_RECOVERY]),
        ("n2", &[NEED_THREE, NEED_BOUND, NEED_MORE, NEED_RECOVERY]),
        ("n3", &[NEED_BOUND, NEED_MORE, NEED_RECOVERY]),
    ] {
        let row = rows.iter().find(|r| r["file"] == format!("in/{name}.csv")).unwrap();
        let expected: BTreeSet<String> =
            lists.iter().flat_map(|l| l.iter()).map(|s| (*s).to_owned()).collect();
        let found = empty(row);
        let (more, less): (Vec<_>, Vec<_>) =
            (found.difference(&expected).collect(), expected.difference(&found).collect());
        assert!(more.is_empty() && less.is_empty(), "{name}: empty too {more:?}, not empty {less:?}");
    }
}

#[test]
fn no_pattern_fails_or_leaves_what_is_no_number() {
    let place = patterns();
    for (k, window) in
        [&["0,0,10,10"][..], &["0,0,10,10", "--torus"], &["window.csv"]].into_iter().enumerate()
    {
        let out = format!("out{k}");
        let measure =
            ["measure", "in", "--functions", "--maps", "--roi-side", "5", "--out", &out, "-q", "--window"];
        place.ok(&[&measure[..], window].concat());
        assert_eq!(place.table(&format!("{out}/summary.csv")).len(), PATTERNS.len());
        for (file, bytes) in place.files(&out) {
            let text = String::from_utf8_lossy(&bytes).to_lowercase();
            if file.ends_with(".csv") {
                let mut cells = text.split([',', '\n']);
                assert!(
                    !cells.any(|c| matches!(c, "nan" | "inf" | "-inf" | "infinity")),
                    "{window:?} {file}"
                );
            }
        }
        // every point has a row, however few there are
        for (name, points) in PATTERNS {
            assert_eq!(place.table(&format!("{out}/{name}.points.csv")).len(), points.lines().count());
        }
    }
}
