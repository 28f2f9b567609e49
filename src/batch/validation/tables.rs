//! The CSV files of a validation.

use super::ValidationRow;
use crate::batch::BatchError;
use crate::batch::outputs::OutputFolder;
use crate::compare::{Difference, Froc, GroupSummary, Reliability, Score};
use crate::report::{Cell, tables};

type Column = (&'static str, fn(&ValidationRow) -> Cell);

const COLUMNS: &[Column] = &[
    ("file", |r| r.file.as_str().into()),
    ("name", |r| r.name.as_str().into()),
    ("group", |r| r.group.as_deref().into()),
    ("tp", |r| r.score.rates.tp.into()),
    ("fn", |r| r.score.rates.fn_.into()),
    ("fp", |r| r.score.rates.fp.into()),
    ("sensitivity", |r| r.score.rates.sensitivity.into()),
    ("fdr", |r| r.score.rates.fdr.into()),
    ("precision", |r| r.score.rates.precision.into()),
    ("dice", |r| r.score.rates.dice.into()),
    ("localisation_px", |r| r.score.localisation_px.into()),
    ("localisation_um", |r| r.score.localisation_um().into()),
    ("localisation_s", |r| r.score.localisation_s.into()),
    ("offset_x_px", |r| r.score.offset_px.map(|o| o[0]).into()),
    ("offset_y_px", |r| r.score.offset_px.map(|o| o[1]).into()),
    ("marks_inside", |r| r.score.marks_inside.into()),
    ("detections_inside", |r| r.score.detections_inside.into()),
    ("density_ratio", |r| r.score.density_ratio.into()),
    ("area_px2", |r| r.score.area_px.into()),
    ("um_per_px", |r| r.score.um_per_px.into()),
    ("expected_false_alarms", |r| r.expected_false_alarms.into()),
    ("n_marks", |r| r.score.n_marks.into()),
    ("n_detections", |r| r.score.n_detections.into()),
    ("limit_px", |r| r.score.limit_px.into()),
    ("assignment", |r| r.score.assignment.name().into()),
];

/// Behind these, where two are compared.
const VERSUS: &[Column] = &[
    ("versus_dice", |r| versus(r, |s| s.rates.dice)),
    ("versus_sensitivity", |r| versus(r, |s| s.rates.sensitivity)),
    ("versus_fdr", |r| versus(r, |s| s.rates.fdr)),
    ("versus_detections_inside", |r| r.versus.as_ref().map(|v| v.score.detections_inside).into()),
    ("between_dice", |r| r.versus.as_ref().map(|v| v.between.rates.dice).into()),
];

/// Points of a curve that are written.
const CURVE_POINTS: usize = 1000;

fn versus(row: &ValidationRow, value: fn(&Score) -> f64) -> Cell {
    row.versus.as_ref().map(|v| value(&v.score)).into()
}

/// `validation.csv`; `two`: two detectors or graders are compared.
pub(super) fn images(out: &OutputFolder, rows: &[ValidationRow], two: bool) -> Result<(), BatchError> {
    let more = if two { VERSUS } else { &[] };
    let columns: Vec<&Column> = COLUMNS.iter().chain(more).collect();
    let header: Vec<String> = columns.iter().map(|c| c.0.to_owned()).collect();
    let table: Vec<Vec<Cell>> =
        rows.iter().map(|row| columns.iter().map(|(_, value)| value(row)).collect()).collect();
    out.write_table("validation.csv", &header, &table)
}

/// `groups.csv`.
pub(super) fn groups(out: &OutputFolder, groups: &[GroupSummary]) -> Result<(), BatchError> {
    let row = |g: &GroupSummary| -> Vec<Cell> {
        let s = &g.summary;
        vec![
            g.group.as_str().into(),
            s.images.into(),
            s.pooled.tp.into(),
            s.pooled.fn_.into(),
            s.pooled.fp.into(),
            s.sensitivity.into(),
            s.fdr.into(),
            s.precision.into(),
            s.dice.into(),
            g.dice_sd.into(),
            s.pooled.dice.into(),
            s.localisation_px.into(),
            s.localisation_um.into(),
            s.localisation_s.into(),
            s.count.map(|a| a.bias).into(),
            s.density_percent.map(|a| a.bias).into(),
        ]
    };
    let rows: Vec<Vec<Cell>> = groups.iter().map(row).collect();
    out.write_described(&tables::SUBJECT_GROUPS, &rows)
}

/// `froc.csv`.
pub(super) fn curve(out: &OutputFolder, froc: &Froc) -> Result<(), BatchError> {
    let rows: Vec<Vec<Cell>> = froc
        .thinned(CURVE_POINTS)
        .iter()
        .map(|p| {
            vec![
                p.threshold.into(),
                p.sensitivity.into(),
                p.precision.into(),
                p.dice.into(),
                p.mean_dice.into(),
                p.false_alarms_per_image.into(),
                p.false_alarms_per_mm2.into(),
                p.false_alarms_per_100_marks.into(),
            ]
        })
        .collect();
    out.write_described(&tables::FROC, &rows)
}

/// `reliability.csv`.
pub(super) fn bins(out: &OutputFolder, reliability: &Reliability) -> Result<(), BatchError> {
    let rows: Vec<Vec<Cell>> = reliability
        .bins
        .iter()
        .map(|b| {
            let interval = |end: usize| -> Cell { b.hits_interval.map(|i| i[end]).into() };
            vec![
                b.from.into(),
                b.to.into(),
                b.n.into(),
                b.mean_score.into(),
                b.hits.into(),
                interval(0),
                interval(1),
            ]
        })
        .collect();
    out.write_described(&tables::RELIABILITY, &rows)
}

/// `comparison.csv`.
pub(super) fn differences(out: &OutputFolder, differences: &[Difference]) -> Result<(), BatchError> {
    let rows: Vec<Vec<Cell>> = differences
        .iter()
        .map(|d| {
            vec![
                d.measure.into(),
                d.images.into(),
                d.first.into(),
                d.second.into(),
                d.difference.into(),
                d.interval.map(|i| i[0]).into(),
                d.interval.map(|i| i[1]).into(),
                d.p.into(),
                d.least_p.into(),
            ]
        })
        .collect();
    out.write_described(&tables::COMPARISON, &rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dictionary_tells_the_columns() {
        let header: Vec<&str> = COLUMNS.iter().chain(VERSUS).map(|c| c.0).collect();
        assert_eq!(tables::VALIDATION.header(), header);
    }
}
