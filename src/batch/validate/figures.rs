//! The figures of a validation, drawn from the scores of its images.

use super::Comparison;
use crate::compare::{Agreement, Froc, Interval, Score, Summary};
use crate::report::{AgreementLine, AgreementPanel, FrocLine, agreement_figure, froc_figure};
use std::collections::BTreeMap;

/// Returns a copy of `score` in which the marks are counted as if they were the detections.
///
/// The agreement figure compares the detections of two scores; with this copy as the second score,
/// it compares detections with marks.
pub(super) const fn marks_as_detections(score: &Score) -> Score {
    Score { detections_inside: score.marks_inside, ..*score }
}

/// Draws Bland–Altman plots of count and density.
///
/// `pairs` contains two scores per image, the first and the second; differences are first − second.
/// Labels name the two in the opposite order: second, then first.
pub(super) fn agreement(
    title: &str,
    (second, first): (&str, &str),
    pairs: &[(Score, Score)],
    summary: &Summary,
    intervals: &BTreeMap<&'static str, Interval>,
) -> String {
    let scaled = pairs.iter().all(|(a, b)| a.um_per_px.is_some() && b.um_per_px.is_some());
    let count = |s: &Score| s.detections_inside as f64;
    // cones per px² would be tiny numbers, so without a scale the density is per 1000 px²
    let density =
        |s: &Score| count(s) / if scaled { s.area_mm2().unwrap_or(f64::NAN) } else { s.area_px / 1000. };
    let counts: Vec<(f64, f64)> =
        pairs.iter().map(|(a, b)| ((count(a) + count(b)) / 2., count(a) - count(b))).collect();
    let densities: Vec<(f64, f64)> = pairs
        .iter()
        .map(|(a, b)| {
            let middle = (density(a) + density(b)) / 2.;
            (middle, 100. * (density(a) - density(b)) / middle)
        })
        .collect();
    let line = |value: f64, name: &str, of: &str| AgreementLine {
        value,
        interval: intervals.get(&*format!("{name}.{of}")).copied(),
    };
    let bias = |name: &str, agreement: Option<Agreement>| Some(line(agreement?.bias, name, "bias"));
    let limits = |name: &str, agreement: Option<Agreement>| {
        let [low, high] = agreement?.limits?;
        Some([line(low, name, "lower_limit"), line(high, name, "upper_limit")])
    };
    let difference = format!("{first} − {second}");
    let unit = if scaled { "cones/mm²" } else { "cones/1000 px²" };
    agreement_figure(
        title,
        &[
            AgreementPanel {
                mean_label: &format!("mean of {second} and {first} (cones per image)"),
                difference_label: &format!("{difference} (cones per image)"),
                pairs: &counts,
                bias: bias("count", summary.count),
                limits: limits("count", summary.count),
            },
            AgreementPanel {
                mean_label: &format!("mean density of {second} and {first} ({unit})"),
                difference_label: &format!("{difference} (% of the mean)"),
                pairs: &densities,
                bias: bias("density_percent", summary.density_percent),
                limits: limits("density_percent", summary.density_percent),
            },
        ],
    )
}

/// Draws the FROC curve of one detector, or the curves of both if two are compared.
pub(super) fn froc_svg(froc: &Froc, given: &Summary, comparison: Option<&Comparison>) -> String {
    let second = comparison
        .and_then(|c| Some(FrocLine { name: &c.second, froc: c.froc.as_ref()?, given: &c.summary }));
    let name = if second.is_some() { comparison.map_or("", |c| &c.first) } else { "" };
    let lines: Vec<FrocLine> = [FrocLine { name, froc, given }].into_iter().chain(second).collect();
    froc_figure("Sensitivity, false alarms and precision over the threshold of the score", &lines)
}
