use super::{
    Cell, DetectionRecord, ImageRecord, LandmarkRecord, MosaicRecord, by_need, counted, significant,
};
use maud::{DOCTYPE, Markup, PreEscaped, html};

pub(super) const STYLE: &str = "
:root { color-scheme: light dark; --line: #8884; --soft: #8882; --warn: #b45309; }
body { font: 15px/1.5 system-ui, sans-serif; max-width: 1280px; margin: 2rem auto; padding: 0 1.2rem; }
h1 { font-size: 1.5rem; margin-bottom: .2rem; } h2 { font-size: 1.1rem; margin: 2.6rem 0 .4rem; overflow-wrap: anywhere; }
p.lead { margin-top: 0; opacity: .75; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .85rem; }
th, td { padding: .3rem .5rem; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap; }
th { vertical-align: bottom; white-space: normal; } th.sampler span { writing-mode: vertical-rl; transform: rotate(180deg); } .sampler { padding: .3rem .25rem; } th:first-child, td:first-child, .word { text-align: left; }
td:first-child { max-width: 22rem; overflow: hidden; text-overflow: ellipsis; }
tr:hover td { background: var(--soft); }
.warning { color: var(--warn); }
figure { margin: .6rem 0; } img { width: 100%; max-width: 1060px; background: #fff; border-radius: 4px; }
nav a { margin-right: 1rem; font-size: .9rem; }
@media print { section { break-inside: avoid; } nav { display: none; } }
";

/// The page of a run: a table of all images and the figure of each. Refers to the files beside it.
/// `landmarks` are what the maps of each image say, where there are maps.
pub fn page(
    records: &[ImageRecord],
    landmarks: &[Option<LandmarkRecord>],
    failures: &[(&str, &str)],
    samplers: &[String],
) -> String {
    let cones: usize = records.iter().map(|r| r.mosaic.n).sum();
    let scaled = records.iter().any(|r| r.mosaic.um_per_unit.is_some());
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "Cone mosaics of " (counted(records.len(), "image")) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { "Cone mosaics" }
                p.lead {
                    (counted(cones, "cone")) " in " (counted(records.len(), "image")) ". All columns, in full precision: "
                    a href="summary.csv" { "summary.csv" }
                    "; how they were made: " a href="run.json" { "run.json" } "."
                }
                @if !failures.is_empty() { (failed(failures)) }
                div.scroll { (overview(records, samplers, scaled)) }
                p {
                    "NN: distance to the nearest neighbour, mean ± standard deviation. RI: regularity index, their ratio, of all points "
                    "and of those whose neighbours cannot lie beyond the border. Under the name of each sampler its ℓ∞: largest difference of the pair correlation functions of "
                    "the mosaic and of a sampler (mean of several samples of as many points in the same window). Expected errors: false "
                    "alarms and misses that the scores of the cones and of the rejected candidates lead to expect; images that most need "
                    "the eye of a person come first."
                }
                @for k in by_need(records) { (one(k, &records[k], landmarks.get(k).and_then(Option::as_ref))) }
            }
        }
    }
    .into_string()
}

fn failed(failures: &[(&str, &str)]) -> Markup {
    html! {
        h2.warning { (counted(failures.len(), "image")) " failed" }
        ul { @for (file, reason) in failures { li title=(file) { (reason) } } }
    }
}

fn overview(records: &[ImageRecord], samplers: &[String], scaled: bool) -> Markup {
    let number = |value: Option<f64>, digits: usize| value.map_or("–".into(), |v| significant(v, digits));
    html! {
        table {
            thead { tr {
                th { "image" } th.word { "modality" } th { "cones" }
                th { @if scaled { "cones/mm²" } @else { "cones/px²" } }
                th { "spacing" br; "px" } th { "NN" br; @if scaled { "µm" } @else { "px" } }
                th { "RI" } th { "RI" br; "interior" }
                th { "expected" br; "errors" } th.word { "closest to" }
                @for sampler in samplers { th.sampler title=(format!("ℓ∞ to {sampler}")) { span { (sampler) } } }
            } }
            tbody { @for k in by_need(records) {
                @let r = &records[k];
                @let m = &r.mosaic;
                @let um = if scaled { m.um_per_unit } else { Some(1.) };
                tr {
                    td title=(r.file) {
                        a href=(format!("#i{k}")) { (r.name) }
                        @if !r.warnings.is_empty() { span.warning title=(r.warnings.join("; ")) { " ⚠" } }
                    }
                    td.word { (r.detection.modality) }
                    td { (m.n) }
                    td { (number(if scaled { m.density_per_mm2() } else { Some(m.stats.density) }, 4)) }
                    td { (number(m.stats.spacing, 3)) }
                    td { (number(m.stats.nearest.mean.zip(um).map(|(v, um)| v * um), 3)) " ± " (number(m.stats.nearest.sd.zip(um).map(|(v, um)| v * um), 2)) }
                    td { (number(m.stats.nearest.ri, 3)) }
                    td { (number(m.stats.nearest_interior.ri, 3)) }
                    td { (expected_errors(&r.detection)) }
                    td.word { (Cell::from(m.closest_sampler()).readable()) }
                    @for sampler in samplers {
                        td.sampler { (distance(m, sampler)) }
                    }
                }
            } }
        }
    }
}

/// How many errors the scores lead to expect, and per hundred cones.
pub fn expected_errors(found: &DetectionRecord) -> String {
    let errors = found.expected_false_alarms + found.expected_misses;
    let percent = 100. * errors / found.n.max(1) as f64;
    format!("{errors:.0} ({percent:.1} %)")
}

/// Two decimals, so that a column can be compared at a glance.
fn distance(mosaic: &MosaicRecord, sampler: &str) -> String {
    mosaic.distance_to(sampler).map_or("–".into(), |d| format!("{d:.2}"))
}

/// Files of an image, and what they are called.
const LINKS: [(&str, &str); 4] = [
    ("overlay.png", "cones on the image"),
    ("points.csv", "points"),
    ("pcf.csv", "g(r)"),
    ("metrics.json", "all numbers"),
];
/// Behind these, where there are maps.
const MAP_LINKS: [(&str, &str); 3] =
    [("maps.csv", "maps"), ("profiles.csv", "profiles"), ("fourier_map.csv", "spacing by spectra")];

fn one(k: usize, record: &ImageRecord, landmarks: Option<&LandmarkRecord>) -> Markup {
    let folder = format!("images/{}", in_url(&record.name));
    html! {
        section id=(format!("i{k}")) {
            h2 { (record.name) }
            @for warning in &record.warnings { p.warning { "⚠ " (warning) } }
            @if record.mosaic.outline.is_some() { p.lead { (outlined(record)) } }
            figure { img loading="lazy" src=(format!("{folder}/figure.svg")) alt=(format!("Figure of {}", record.name)); }
            @if !record.mosaic.verdicts.is_empty() {
                ul.verdicts { @for verdict in &record.mosaic.verdicts { li { (verdict.words()) } } }
                figure { img loading="lazy" src=(format!("{folder}/verdict.svg")) alt=(format!("g(r) of {} in the envelopes of samplers", record.name)); }
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

/// What a window that is not a rectangle means for the numbers.
fn outlined(record: &ImageRecord) -> String {
    let area = record.mosaic.window_area;
    let percent = 100. * area / (record.width_px * record.height_px) as f64;
    let mm2 = record.mosaic.window_area_mm2().map(|mm2| format!(" ({} mm²)", significant(mm2, 3)));
    format!(
        "Counted within the outline: {} px²{}, {percent:.0} % of the image.",
        significant(area, 4),
        mm2.unwrap_or_default()
    )
}

/// A file name as part of a URL.
pub(super) fn in_url(name: &str) -> String {
    name.bytes()
        .map(|b| match b {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'_' | b'.' | b'~' => char::from(b).to_string(),
            _ => format!("%{b:02X}"),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_without_images_is_still_a_page() {
        let text = page(&[], &[], &[("a<b>.png", "it is <broken>")], &[]);
        assert!(text.starts_with("<!DOCTYPE html>") && text.contains("it is &lt;broken&gt;"));
    }

    #[test]
    fn names_become_urls() {
        assert_eq!(in_url("a b#1_0.5"), "a%20b%231_0.5");
    }
}
