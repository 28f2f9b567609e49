use super::names::Names;
use super::skeleton::{in_url, skeleton};
use crate::report::{
    Cell, DetectionRecord, ImageRecord, LandmarkRecord, MosaicRecord, by_need, counted, significant,
};
use maud::{Markup, html};

/// Style that only this page needs, added to that of all pages.
const MORE_STYLE: &str = "
ul.distances { display: flex; flex-wrap: wrap; gap: .2rem .5rem; list-style: none; padding: 0; margin: .4rem 0; font-size: .85rem; max-width: none; }
ul.distances li { border: 1px solid var(--line); border-radius: 4px; padding: .05rem .5rem; font-variant-numeric: tabular-nums; }
ul.distances li:first-child { font-weight: 600; }
details { margin: .6rem 0; } summary { cursor: pointer; }
";

/// Largest number of warnings that are shown at the top of the page; more are folded away.
const OPEN_WARNINGS: usize = 6;

/// Returns the HTML page of a run: a table of all images, and the figures of each image.
///
/// The page refers to the files beside it. `landmarks` has one entry per record, with what was read
/// off the maps of the image, or `None` without maps. `failures` are files with the reason why they
/// failed.
pub fn page(
    records: &[ImageRecord],
    landmarks: &[Option<LandmarkRecord>],
    failures: &[(&str, &str)],
    samplers: &[String],
) -> String {
    let cones: usize = records.iter().map(|r| r.mosaic.n).sum();
    let scaled = records.iter().any(|r| r.mosaic.um_per_unit.is_some());
    let title = format!("Cone mosaics of {}", counted(records.len(), "image"));
    let names = Names::new(records.iter().map(|r| r.name.as_str()));
    let body = html! {
        h1 { "Cone mosaics" }
        p.lead {
            (counted(cones, "cone")) " in " (counted(records.len(), "image")) ". All columns in full precision: "
            a href="summary.csv" { "summary.csv" }
            "; how they were computed: " a href="run.json" { "run.json" } "."
        }
        @if !failures.is_empty() { (failed(failures)) }
        (warned(records, &names))
        div.scroll { (overview(records, &names, scaled)) }
        (legend(samplers))
        @for k in by_need(records) { (one(k, &records[k], landmarks.get(k).and_then(Option::as_ref))) }
    };
    skeleton(&title, MORE_STYLE, &body)
}

/// Returns the list of the images that failed, with the reasons.
fn failed(failures: &[(&str, &str)]) -> Markup {
    html! {
        h2.warning { (counted(failures.len(), "image")) " failed" }
        ul { @for (file, reason) in failures { li title=(file) { (reason) } } }
    }
}

/// Returns the warnings of all images below their number.
fn warned(records: &[ImageRecord], names: &Names) -> Markup {
    let order: Vec<usize> =
        by_need(records).into_iter().filter(|&k| !records[k].warnings.is_empty()).collect();
    let count: usize = order.iter().map(|&k| records[k].warnings.len()).sum();
    html! {
        @if count > 0 {
            details open[count <= OPEN_WARNINGS] {
                summary.warning {
                    "⚠ " (counted(count, "warning")) ", on " (order.len()) " of " (counted(records.len(), "image"))
                }
                ul { @for k in order { li {
                    a href=(format!("#i{k}")) { (names.show(&records[k].name)) } ": "
                    (records[k].warnings.join("; "))
                } } }
            }
        }
    }
}

/// Returns the explanation of the columns and, if samplers were compared, of ℓ∞.
fn legend(samplers: &[String]) -> Markup {
    html! {
        p {
            "Images are sorted by the expected error rate plus the doubt about modality and spacing, so those that most need to be "
            "checked come first. Spacing (density): spacing of a hexagonal lattice with the "
            "density of the mosaic. Spacing (ring): spacing measured in the power spectrum of the image before any cone was detected. "
            "NN: distance to the nearest neighbour, mean ± standard deviation. RI: regularity index, the ratio of this mean to this "
            "standard deviation, for all points and for the interior points, whose nearest neighbour cannot lie beyond the border. "
            "Expected errors: expected number of false alarms and misses, computed from the scores of the cones and of the rejected "
            "candidates; in brackets, as a percentage of the cones. They are valid only for images like those that the program was "
            "developed on."
        }
        @if !samplers.is_empty() {
            p {
                "ℓ∞ (l-infinity): the largest difference between the pair correlation function g(r) of the mosaic and that of a sampler "
                "(mean over several patterns with about as many points in a window of about the same shape). 0 means identical curves; the "
                "smaller the value, the more the mosaic is arranged like the points of that sampler. Lanaro et al. (2020) call two curves "
                "alike below about 0.1. By chance alone, two patterns from the same process differ by about 0.15 if they have 100 points, "
                "0.08 if they have 300 and 0.05 if they have 1000. The closest sampler need not be alike: run with a verdict to test that."
            }
        }
    }
}

/// Returns a number with `digits` significant digits, or a dash if there is no number.
fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or("–".into(), |v| significant(v, digits))
}

/// Writes a length that is known in px; on a page with a scale in µm, with px in brackets.
fn length(px: Option<f64>, um_per_px: Option<f64>, scaled: bool) -> String {
    if scaled {
        format!("{} ({})", number(px.zip(um_per_px).map(|(v, um)| v * um), 3), number(px, 3))
    } else {
        number(px, 3)
    }
}

/// Returns the table of all images.
fn overview(records: &[ImageRecord], names: &Names, scaled: bool) -> Markup {
    let (length_unit, density_unit) = if scaled { ("µm (px)", "per mm²") } else { ("px", "per px²") };
    let compared = records.iter().any(|r| !r.mosaic.l_infinity.is_empty());
    html! {
        table {
            thead { tr {
                th { "image" } th.word { "modality" } th { "cones" }
                th { "density" small { (density_unit) } }
                th { "spacing (density)" small { (length_unit) } }
                th { "spacing (ring)" small { (length_unit) } }
                th { "NN" small { @if scaled { "µm" } @else { "px" } } }
                th { "RI" } th { "RI" small { "interior" } }
                th { "expected" br; "errors" }
                @if compared { th.word { "closest to" } th { "ℓ∞" } }
            } }
            tbody { @for k in by_need(records) { (row(k, &records[k], names, scaled, compared)) } }
        }
    }
}

/// Returns the row of image `k` in that table.
fn row(k: usize, record: &ImageRecord, names: &Names, scaled: bool, compared: bool) -> Markup {
    let m = &record.mosaic;
    let um = m.um_per_unit;
    let shown = if scaled { um } else { Some(1.) };
    let distance = m.closest_sampler().and_then(|name| m.distance_to(name));
    let nearest = |value: Option<f64>, digits| number(value.zip(shown).map(|(v, um)| v * um), digits);
    html! { tr {
        td title=(record.file) {
            a href=(format!("#i{k}")) { (names.show(&record.name)) }
            @if !record.warnings.is_empty() {
                span.warning title=(record.warnings.join("; ")) { " ⚠" (record.warnings.len()) }
            }
        }
        td.word { (record.detection.as_ref().map_or_else(|| record.cones_from.name().to_owned(), |d| d.modality.to_string())) }
        td { (m.n) }
        td { (number(if scaled { m.density_per_mm2() } else { Some(m.stats.density) }, 4)) }
        td { (length(m.stats.spacing, um, scaled)) }
        td { (length(record.detection.as_ref().map(|d| d.ring_spacing_px), um, scaled)) }
        td { (nearest(m.stats.nearest.mean, 3)) " ± " (nearest(m.stats.nearest.sd, 2)) }
        td { (number(m.stats.nearest.ri, 3)) }
        td { (number(m.stats.nearest_interior.ri, 3)) }
        td { (record.detection.as_ref().map_or("–".into(), expected_errors)) }
        @if compared {
            td.word { (Cell::from(m.closest_sampler()).readable()) }
            td { (distance.map_or("–".into(), two_decimals)) }
        }
    } }
}

/// Returns the expected number of errors in words.
///
/// It is the sum of the expected false alarms and misses, followed in brackets by its percentage of
/// the cones.
pub fn expected_errors(found: &DetectionRecord) -> String {
    let errors = found.expected_false_alarms + found.expected_misses;
    let percent = 100. * errors / found.n.max(1) as f64;
    format!("{errors:.0} ({percent:.1} %)")
}

/// Returns a distance with two decimals, so that distances can be compared at a glance.
fn two_decimals(distance: f64) -> String {
    format!("{distance:.2}")
}

/// Returns ℓ∞ between a mosaic and every sampler that it was compared with, the closest first.
fn distances(mosaic: &MosaicRecord) -> Markup {
    let mut rising: Vec<_> = mosaic.l_infinity.iter().collect();
    rising.sort_by(|a, b| a.l_infinity.total_cmp(&b.l_infinity));
    html! {
        @if !rising.is_empty() {
            ul.distances aria-label="ℓ∞ to each sampler, the closest first" {
                @for d in rising { li { "ℓ∞ to " (d.sampler) ": " (two_decimals(d.l_infinity)) } }
            }
        }
    }
}

/// Files of every image, with the words of their links.
const LINKS: [(&str, &str); 4] = [
    ("overlay.png", "cones on the image"),
    ("points.csv", "points"),
    ("pcf.csv", "g(r)"),
    ("metrics.json", "all numbers"),
];
/// Files of an image with maps, whose links follow those of `LINKS`.
const MAP_LINKS: [(&str, &str); 3] =
    [("maps.csv", "maps"), ("profiles.csv", "profiles"), ("fourier_map.csv", "spacing from spectra")];

/// Returns the section of image `k`: warnings, figures and links.
fn one(k: usize, record: &ImageRecord, landmarks: Option<&LandmarkRecord>) -> Markup {
    let folder = format!("images/{}", in_url(&record.name));
    html! {
        section id=(format!("i{k}")) {
            h2 { (record.name) }
            @for warning in &record.warnings { p.warning { "⚠ " (warning) } }
            @if record.mosaic.outline.is_some() { p.lead { (outlined(record)) } }
            (distances(&record.mosaic))
            figure { img loading="lazy" src=(format!("{folder}/figure.svg")) alt=(format!("Figure of {}", record.name)); }
            @if !record.mosaic.verdicts.is_empty() {
                ul.verdicts { @for verdict in &record.mosaic.verdicts { li { (verdict.words()) } } }
                figure { img loading="lazy" src=(format!("{folder}/verdict.svg")) alt=(format!("g(r) of {} with the envelopes of samplers", record.name)); }
            }
            @if let Some(landmarks) = landmarks {
                p { (landmarks.words()) }
                @if landmarks.whole > 0 {
                    figure { img loading="lazy" src=(format!("{folder}/maps.svg")) alt=(format!("Maps of {}", record.name)); }
                }
            }
            nav {
                @for (file, words) in LINKS.iter().chain(landmarks.map(|_| &MAP_LINKS).into_iter().flatten()) {
                    a href=(format!("{folder}/{file}")) { (words) }
                }
            }
        }
    }
}

/// Returns a sentence on the area within which cones are counted, for a window with an outline.
fn outlined(record: &ImageRecord) -> String {
    let area = record.mosaic.window_area;
    let percent = 100. * area / (record.width_px * record.height_px) as f64;
    let mm2 = record.mosaic.window_area_mm2().map(|mm2| format!(" ({} mm²)", significant(mm2, 3)));
    format!(
        "Only cones within the outline are counted: {} px²{}, {percent:.0} % of the image.",
        significant(area, 4),
        mm2.unwrap_or_default()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_without_images_is_still_a_page() {
        let text = page(&[], &[], &[("a<b>.png", "it is <broken>")], &[]);
        assert!(text.starts_with("<!DOCTYPE html>") && text.contains("it is &lt;broken&gt;"));
    }
}
