//! The page `index.html` of a run.

use crate::common::Place;

fn page_of(arguments: &[&str]) -> String {
    let place = Place::new();
    for name in ["confocal_dense.png", "histology_gradient.png"] {
        let bytes = std::fs::read(format!("fixtures/images/{name}")).unwrap();
        place.write(&format!("images/clinic_2026_07_{name}"), bytes);
    }
    place.ok(&[&["run", "images", "--out", "out"][..], arguments].concat());
    place.read("out/index.html")
}

/// Returns the text of the headings of the table, without the elements inside them.
fn headings(page: &str) -> Vec<String> {
    let head = page.split("<thead>").nth(1).and_then(|t| t.split("</thead>").next()).unwrap_or_default();
    head.split("<th").skip(1).map(|th| th.split('>').nth(1).unwrap_or_default().replace("</th", "")).collect()
}

#[test]
fn table_of_a_run_fits_whatever_the_number_of_samplers() {
    let page = page_of(&["--samplers", "uniform,jittered,dart-throwing,triangular", "--um-per-px", "0.5"]);
    let columns = headings(&page);
    assert_eq!(columns.len(), 12, "{columns:?}");
    for name in ["spacing (density)<small", "spacing (ring)<small", "closest to", "ℓ∞"] {
        assert!(columns.iter().any(|c| c.trim_end().starts_with(name)), "{name} is not in {columns:?}");
    }
    // lengths and densities of a scaled image are in µm and per mm², with px beside them
    assert!(page.contains("<small>µm (px)</small>") && page.contains("<small>per mm²</small>"));
    // every sampler is named with each image, and ℓ∞ is explained once
    assert_eq!(page.matches("ℓ∞ to triangular").count(), 2);
    assert!(page.contains("Lanaro et al. (2020) call two curves alike below about 0.1"));
    assert!(page.contains("position: sticky"));
}

#[test]
fn warnings_are_counted_above_the_table_and_told_with_each_image() {
    let page = page_of(&["--samplers", "uniform"]);
    let details = page.split("<details").nth(1).and_then(|d| d.split("</details>").next()).unwrap();
    // the density of one of the two images varies: a warning stands above the table and another
    // with the image
    assert!(details.contains("⚠ 1 warning, on 1 of 2 images") && details.contains("density"), "{details}");
    assert_eq!(page.matches("<p class=\"warning\">⚠ ").count(), 1);
}

#[test]
fn lengths_stay_in_px_without_a_scale() {
    let page = page_of(&["--samplers", "uniform"]);
    assert!(page.contains("<small>px</small>") && !page.contains("µm (px)"));
}
