//! Files that a validation writes: tables, figures, and the page that shows them.

use super::figures::{agreement, froc_svg, marks_as_detections};
use super::{Analysis, ValidationOptions, ValidationRow};
use crate::batch::output::OutputFolder;
use crate::batch::{BatchError, Failure};
use crate::compare::{Froc, Score};
use crate::report::tables::{
    COMPARISON, FROC, RELIABILITY, SUBJECT_GROUPS, VALIDATION, froc_csv, validation_csv,
};
use crate::report::{
    ReliabilityFigure, ScoredImage, ValidationPage, counted, reliability_figure, significant, validation_page,
};
use serde_json::json;

/// Writes all files of a validation except its overlays and the list of failures.
pub(super) fn write(
    out: &OutputFolder,
    rows: &[ValidationRow],
    analysis: Option<&Analysis>,
    failures: &[Failure],
    options: &ValidationOptions,
) -> Result<(), BatchError> {
    out.write(VALIDATION.file, &validation_csv(rows, options.versus.is_some())?)?;
    out.write_json("validation.json", &analysis.map(|a| record(a, options)))?;

    let mut figures: Vec<(&str, String)> = Vec::new();
    let mut files = vec![("validation.csv", "one row per image"), ("validation.json", "all results")];
    let mut made = |name: &'static str, words: &'static str| files.push((name, words));
    if let Some(analysis) = analysis {
        let pairs: Vec<(Score, Score)> =
            rows.iter().map(|r| (r.score, marks_as_detections(&r.score))).collect();
        let drawn = agreement(
            "Detections against marks",
            ("marks", "detections"),
            &pairs,
            &analysis.summary,
            &analysis.intervals,
        );
        out.write("bland_altman.svg", drawn.as_bytes())?;
        figures.push((
            "bland_altman.svg",
            "Bland–Altman: count and density of every image, detections against marks".into(),
        ));
    }
    if let Some(analysis) = analysis.filter(|a| !a.groups.is_empty()) {
        out.write(SUBJECT_GROUPS.file, &SUBJECT_GROUPS.csv(&analysis.groups)?)?;
        made("groups.csv", "one row per group");
    }
    if let Some((analysis, froc)) = analysis.and_then(|a| Some((a, a.froc.as_ref()?))) {
        out.write(FROC.file, &froc_csv(froc)?)?;
        out.write("froc.svg", froc_svg(froc, &analysis.summary, analysis.comparison.as_ref()).as_bytes())?;
        figures.push(("froc.svg", "FROC and precision–recall curves over the threshold of the score".into()));
        made("froc.csv", "the FROC curve by threshold of the score");
    }
    if let Some(reliability) = analysis.and_then(|a| a.reliability.as_ref()) {
        out.write(RELIABILITY.file, &RELIABILITY.csv(&reliability.bins)?)?;
        let alarms: Vec<(f64, f64)> =
            rows.iter().filter_map(|r| Some((r.expected_false_alarms?, r.score.rates.fp as f64))).collect();
        let title = "Reliability of the score";
        let drawn = reliability_figure(&ReliabilityFigure { title, reliability, alarms: &alarms });
        out.write("reliability.svg", drawn.as_bytes())?;
        figures.push((
            "reliability.svg",
            "Reliability: the share of hits at each score; false alarms expected and observed".into(),
        ));
        made("reliability.csv", "share of hits by bin of the score");
    }
    if let Some(comparison) = analysis.and_then(|a| a.comparison.as_ref()) {
        out.write(COMPARISON.file, &COMPARISON.csv(&comparison.differences)?)?;
        let pairs: Vec<(Score, Score)> =
            rows.iter().filter_map(|r| Some((r.score, r.versus.as_ref()?.score))).collect();
        let (first, second) = (comparison.first.as_str(), comparison.second.as_str());
        let drawn = agreement(
            &format!("{first} against {second}"),
            ("second", "first"),
            &pairs,
            &comparison.between,
            &comparison.between_intervals,
        );
        out.write("comparison.svg", drawn.as_bytes())?;
        figures.push(("comparison.svg", format!("Bland–Altman: {first} (first) against {second} (second)")));
        made("comparison.csv", "paired differences");
    }
    let page = page(rows, analysis, failures, &figures, &files, options);
    out.write("index.html", page.as_bytes())
}

/// Returns the content of `validation.json`. The means over images are fields at the top level;
/// everything else follows in fields of its own.
fn record(analysis: &Analysis, options: &ValidationOptions) -> serde_json::Value {
    let best = |froc: &Froc| froc.points.get(froc.best).copied();
    let mut record = json!(analysis.summary);
    let more = json!({
        "intervals": analysis.intervals,
        "interval_method": analysis.method,
        "groups": analysis.groups,
        "mean_over_groups": analysis.over_groups,
        "best_threshold": analysis.froc.as_ref().and_then(best),
        "reliability": analysis.reliability,
        "false_alarms_per_image": analysis.false_alarms.map(|(expected, observed)| {
            json!({ "expected": expected, "observed": observed })
        }),
        "comparison": analysis.comparison.as_ref().map(|c| json!({
            "first": c.first,
            "second": c.second,
            "differences": c.differences,
            "test": "paired sign-flip permutation of the mean difference, two-sided; groups flip together",
            "second_against_marks": c.summary,
            "second_best_threshold": c.froc.as_ref().and_then(best),
            "first_against_second": c.between,
            "first_against_second_intervals": c.between_intervals,
        })),
        "notes": analysis.notes,
        "options": {
            "assignment": options.matching.assignment,
            "border_px": options.matching.border,
            "reach": options.matching.fraction,
            "resamples": options.resamples,
            "seed": options.seed,
        },
    });
    if let (Some(record), serde_json::Value::Object(more)) = (record.as_object_mut(), more) {
        record.extend(more);
    }
    record
}

/// Returns the page in HTML. It lists the images from the lowest Dice coefficient to the highest.
fn page(
    rows: &[ValidationRow],
    analysis: Option<&Analysis>,
    failures: &[Failure],
    figures: &[(&str, String)],
    files: &[(&str, &str)],
    options: &ValidationOptions,
) -> String {
    let mut worst: Vec<&ValidationRow> = rows.iter().collect();
    worst.sort_by(|a, b| a.score.rates.dice.total_cmp(&b.score.rates.dice));
    let images: Vec<ScoredImage> = worst
        .into_iter()
        .map(|r| {
            let rates = &r.score.rates;
            let four = |v: f64| format!("{v:.4}");
            ScoredImage {
                name: r.name.clone(),
                cells: vec![
                    four(rates.dice),
                    four(r.score.strict.dice),
                    rates.fn_.to_string(),
                    rates.fp.to_string(),
                    r.expected_false_alarms.map_or("–".into(), |v| significant(v, 2)),
                    four(rates.sensitivity),
                    four(rates.fdr),
                    r.score.localisation_px.map_or("–".into(), |v| significant(v, 3)),
                    r.score.density_ratio.map_or("–".into(), |v| significant(v, 3)),
                ],
                overlay: options.overlays.then(|| format!("{}.overlay.png", r.name)),
            }
        })
        .collect();
    let lead = analysis.map_or_else(String::new, |a| {
        let rates = &a.summary.pooled;
        format!(
            "{}: {} hits, {} misses, {} false alarms (assignment: {}; a detection lies at most {} × the \
             median nearest-neighbour distance of the marks from its mark; {} px along the border are not \
             counted). {}.",
            counted(a.summary.images, "image"),
            rates.tp,
            rates.fn_,
            rates.fp,
            options.matching.assignment,
            options.matching.fraction,
            options.matching.border,
            a.method,
        )
    });
    validation_page(&ValidationPage {
        lead,
        notes: analysis.map_or(&[], |a| &a.notes),
        tables: &analysis.map_or_else(Vec::new, Analysis::tables),
        figures,
        files,
        header: &[
            "Dice",
            "Dice, strict",
            "misses",
            "false alarms",
            "false alarms expected",
            "sensitivity",
            "FDR",
            "localisation error, px",
            "density ratio",
        ],
        images: &images,
        failures: &failures.iter().map(|f| (f.file.as_str(), f.reason.as_str())).collect::<Vec<_>>(),
    })
}
