use super::table::{significant, table};
use crate::compare::{
    Agreement, Difference, Froc, GroupSummary, Interval, MeanOverGroups, Reliability, Summary,
};
use std::collections::BTreeMap;

/// A table for a reader, on a terminal or on a page.
///
/// Units stand in its headers or first cells.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TextTable {
    /// Headers, one per column.
    pub header: Vec<String>,
    /// Rows with as many cells as the header.
    pub rows: Vec<Vec<String>>,
}

impl TextTable {
    fn new(header: &[&str], rows: Vec<Vec<String>>) -> Self {
        Self { header: header.iter().map(|h| (*h).to_owned()).collect(), rows }
    }

    /// Returns the table as plain text.
    pub fn to_text(&self) -> String {
        let header: Vec<&str> = self.header.iter().map(String::as_str).collect();
        table(&header, &self.rows)
    }
}

/// 95 % intervals by name, as [`intervals`](crate::compare::intervals) names them.
type Intervals = BTreeMap<&'static str, Interval>;

/// Text of a cell without a value.
const NONE: &str = "–";

/// Writes a rate with four decimals.
fn rate(value: f64) -> String {
    format!("{value:.4}")
}

/// Writes a number with three significant digits.
fn three(value: f64) -> String {
    significant(value, 3)
}

/// Writes an interval as its two ends, or a dash if there is none.
fn between(interval: Option<Interval>, number: fn(f64) -> String) -> String {
    interval.map_or(NONE.into(), |[low, high]| format!("{} to {}", number(low), number(high)))
}

/// Returns the table of sensitivity, false discovery rate, precision, Dice and localisation error.
pub fn accuracy_table(summary: &Summary, intervals: &Intervals) -> TextTable {
    let interval = |name: &str| intervals.get(name).copied();
    let (mean, pooled, strict) = (summary, &summary.pooled, &summary.pooled_strict);
    let mut rows: Vec<Vec<String>> = [
        ("sensitivity (recall)", "sensitivity", mean.sensitivity, pooled.sensitivity),
        ("FDR (false discovery rate)", "fdr", mean.fdr, pooled.fdr),
        ("precision (1 − FDR)", "precision", mean.precision, pooled.precision),
        ("Dice (= F1)", "dice", mean.dice, pooled.dice),
        ("sensitivity, strict (0.4)", "sensitivity_strict", mean.sensitivity_strict, strict.sensitivity),
        ("FDR, strict (0.4)", "fdr_strict", mean.fdr_strict, strict.fdr),
        ("Dice, strict (0.4)", "dice_strict", mean.dice_strict, strict.dice),
    ]
    .into_iter()
    .map(|(label, name, mean, pooled)| {
        let of_pooled = match name.strip_suffix("_strict") {
            Some(name) => interval(&format!("pooled_strict.{name}")),
            None => interval(&format!("pooled.{name}")),
        };
        vec![
            label.to_owned(),
            rate(mean),
            between(interval(name), rate),
            rate(pooled),
            between(of_pooled, rate),
        ]
    })
    .collect();
    for (label, name, value) in [
        ("localisation error, px", "localisation_px", summary.localisation_px),
        ("localisation error, µm", "localisation_um", summary.localisation_um),
        ("localisation error, cone spacings", "localisation_s", summary.localisation_s),
    ] {
        let Some(value) = value else { continue };
        rows.push(vec![
            label.to_owned(),
            three(value),
            between(interval(name), three),
            String::new(),
            String::new(),
        ]);
    }
    TextTable::new(&["", "mean over images", "95 % interval", "all cones pooled", "95 % interval"], rows)
}

/// Returns the table of Bland–Altman statistics of count and density.
///
/// `difference` names the difference taken: “detections − marks”.
pub fn agreement_table(difference: &str, summary: &Summary, intervals: &Intervals) -> TextTable {
    let agreements = [("count", summary.count), ("density_percent", summary.density_percent)];
    let row = |label: &str, of: &str, value: fn(&Agreement) -> Option<f64>| {
        let cells = agreements.iter().flat_map(|(name, agreement)| {
            let interval = intervals.get(&*format!("{name}.{of}")).copied();
            [
                agreement.as_ref().and_then(value).map_or(NONE.into(), three),
                if of.is_empty() { String::new() } else { between(interval, three) },
            ]
        });
        [label.to_owned()].into_iter().chain(cells).collect()
    };
    let rows = vec![
        row("bias (mean)", "bias", |a| Some(a.bias)),
        row("lower limit of agreement", "lower_limit", |a| Some(a.limits?[0])),
        row("upper limit of agreement", "upper_limit", |a| Some(a.limits?[1])),
        row("standard deviation", "", |a| a.sd),
    ];
    let header =
        [difference, "count, cones per image", "95 % interval", "density, % of the mean", "95 % interval"];
    TextTable::new(&header, rows)
}

/// Returns the table of groups, one row per group, with the mean over groups below.
pub fn group_table(groups: &[GroupSummary], over: Option<&MeanOverGroups>) -> TextTable {
    let sd = |value: Option<f64>| value.map_or(NONE.into(), rate);
    let of_group = |g: &GroupSummary| {
        let s = &g.summary;
        let rates = [s.sensitivity, s.fdr, s.precision, s.dice].map(rate);
        [vec![g.group.clone(), s.images.to_string()], rates.to_vec(), vec![sd(g.dice_sd)]].concat()
    };
    let of_all = |m: &MeanOverGroups| {
        let rates = [m.sensitivity, m.fdr, m.precision, m.dice].map(rate);
        let name = format!("mean over {} groups", m.groups);
        [vec![name, String::new()], rates.to_vec(), vec![sd(m.dice_sd)]].concat()
    };
    let rows = groups.iter().map(of_group).chain(over.map(of_all)).collect();
    TextTable::new(&["group", "images", "sensitivity", "FDR", "precision", "Dice", "SD of Dice"], rows)
}

/// Returns the table on the scores of detections: the threshold of the highest mean Dice, and the
/// reliability of the scores.
///
/// `alarms` is the number of false alarms per image, expected and observed.
pub fn threshold_table(
    froc: &Froc,
    reliability: Option<&Reliability>,
    alarms: Option<(f64, f64)>,
) -> TextTable {
    let mut rows = Vec::new();
    let mut add = |label: &str, value: String| rows.push(vec![label.to_owned(), value]);
    if let Some(best) = froc.points.get(froc.best) {
        add("threshold with the highest mean Dice (F1)", three(best.threshold));
        add("  mean Dice at that threshold", rate(best.mean_dice));
        add("  sensitivity, all images pooled", rate(best.sensitivity));
        add("  precision, all images pooled", rate(best.precision));
        add("  false alarms per image", three(best.false_alarms_per_image));
        match (best.false_alarms_per_mm2, best.false_alarms_per_100_marks) {
            (Some(alarms), _) => add("  false alarms per mm²", three(alarms)),
            (None, Some(alarms)) => add("  false alarms per 100 marks", three(alarms)),
            (None, None) => {}
        }
    }
    if let Some(found) = reliability {
        add("expected calibration error of the score", three(found.expected_calibration_error));
        add("Brier score", three(found.brier));
    }
    if let Some((expected, observed)) = alarms {
        add("expected false alarms per image, Σ (1 − score)", three(expected));
        add("observed false alarms per image", three(observed));
    }
    TextTable::new(&["score of the detections", ""], rows)
}

/// Returns the table of paired differences of two detectors or graders.
///
/// Few groups cannot have a small p, however much they differ, so the least possible p stands
/// beside it.
pub fn comparison_table(first: &str, second: &str, differences: &[Difference]) -> TextTable {
    let row = |d: &Difference| {
        let (label, number): (_, fn(f64) -> String) = match d.measure {
            "dice" => ("Dice", rate),
            "sensitivity" => ("sensitivity", rate),
            "fdr" => ("FDR", rate),
            "count" => ("count, cones per image", three),
            "density_per_mm2" => ("density, cones/mm²", three),
            _ => ("density, cones/px²", three),
        };
        let values = [d.first, d.second, d.difference].map(number);
        let p = d.p.map_or(NONE.into(), |p| significant(p, 2));
        let least = significant(d.least_p, 3);
        [vec![label.to_owned()], values.to_vec(), vec![between(d.interval, number), p, least]].concat()
    };
    let rows = differences.iter().map(row).collect();
    let header =
        ["mean over images", first, second, "difference", "95 % interval", "p", "smallest possible p"];
    TextTable::new(&header, rows)
}
