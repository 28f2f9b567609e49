use super::{Layout, Part, Row, Table, column};
use crate::compare::{Difference, Froc, FrocPoint, GroupSummary, JudgedImage, ReliabilityBin, Score, Turned};
use crate::report::{Cell, ReportError};

/// Largest number of points of a curve that are written.
const CURVE_POINTS: usize = 1000;

/// The score of one image.
#[derive(Clone, Debug)]
pub struct ValidationRow {
    /// Path of the file of marks, as set by the user.
    pub file: String,
    /// Name of the image.
    pub name: String,
    /// Group to which the image belongs.
    pub group: Option<String>,
    /// Agreement of detections and marks.
    pub score: Score,
    /// Judgement of every detection, and of what the program's own detector rejected; `None` if the
    /// detections have no scores.
    pub judged: Option<JudgedImage>,
    /// Number of false alarms outside the border strip that the scores predict, Σ (1 − score), if
    /// all scores are between 0 and 1.
    pub expected_false_alarms: Option<f64>,
    /// Way in which the marks look turned over, with the strict Dice coefficient that they have the
    /// right way round; `None` if they look right.
    pub turned: Option<(Turned, f64)>,
    /// Score of the other detections, if two are compared.
    pub versus: Option<VersusRow>,
}

/// The score of other detections on the same image.
#[derive(Clone, Debug)]
pub struct VersusRow {
    /// Agreement of the other detections and the marks.
    pub score: Score,
    /// Judgement of every one of the other detections, if they have scores.
    pub judged: Option<JudgedImage>,
    /// Agreement of the first detections with the other detections, which are taken as marks.
    pub between: Score,
}

impl Row for ValidationRow {
    type Of<'a> = &'a Self;
}

/// Returns a value of the score of the other detections; missing if there are none.
fn versus(row: &ValidationRow, value: fn(&Score) -> f64) -> Cell {
    row.versus.as_ref().map(|v| value(&v.score)).into()
}

/// The table of detections against marks.
pub static VALIDATION: Table<ValidationRow> = Table {
    file: "validation.csv",
    commands: "validate",
    about: "One row per image. Only pairs, misses and false alarms outside a border of the image \
            are counted (Cunefare et al. 2017). The columns from versus_dice on are written if two \
            detectors or graders are compared.",
    columns: &[
        column("file", "text", "Path of the file of marks, as given.").of(|r| r.file.as_str().into()),
        column("name", "text", "Name of the image.").of(|r| r.name.as_str().into()),
        column("group", "text", "Group to which the image belongs; empty without groups.")
            .of(|r| r.group.as_deref().into()),
        column("tp", "count", "Hits: marks with a detection.").of(|r| r.score.rates.tp.into()),
        column("fn", "count", "Misses: marks without a detection.").of(|r| r.score.rates.fn_.into()),
        column("fp", "count", "False alarms: detections without a mark.").of(|r| r.score.rates.fp.into()),
        column("sensitivity", "0–1", "tp/(tp + fn).").of(|r| r.score.rates.sensitivity.into()),
        column("fdr", "0–1", "False discovery rate, fp/(tp + fp).").of(|r| r.score.rates.fdr.into()),
        column("precision", "0–1", "tp/(tp + fp).").of(|r| r.score.rates.precision.into()),
        column("dice", "0–1", "Dice coefficient or F1, 2 tp/(2 tp + fn + fp).")
            .of(|r| r.score.rates.dice.into()),
        column("sensitivity_strict", "0–1", "Sensitivity at the strict reach of dice_strict.")
            .of(|r| r.score.strict.sensitivity.into()),
        column("fdr_strict", "0–1", "False discovery rate at the strict reach of dice_strict.")
            .of(|r| r.score.strict.fdr.into()),
        column(
            "dice_strict",
            "0–1",
            "Dice coefficient if a mark and a detection are paired at 0.4 of the median nearest-neighbour \
             distance of the marks at most. The published reach, 0.75, tells good detections from bad ones \
             poorly: the images' own marks with x and y exchanged score 0.868 (confocal) and 0.800 (split \
             detector) at 0.75, and 0.433 and 0.360 at 0.4.",
        )
        .of(|r| r.score.strict.dice.into()),
        column(
            "localisation_px",
            "px",
            "Localisation error: median distance between the mark and \
                                         the detection of a pair.",
        )
        .of(|r| r.score.localisation_px.into()),
        column("localisation_um", "µm", "localisation_px in µm; empty without a scale.")
            .of(|r| r.score.localisation_um().into()),
        column("localisation_s", "spacings", "localisation_px in hexagonal spacings of the marks.")
            .of(|r| r.score.localisation_s.into()),
        column("offset_x_px", "px", "Mean displacement from mark to detection, to the right.")
            .of(|r| r.score.offset_px.map(|o| o[0]).into()),
        column("offset_y_px", "px", "Mean displacement from mark to detection, down.")
            .of(|r| r.score.offset_px.map(|o| o[1]).into()),
        column("marks_inside", "count", "Number of marks that are not in the border.")
            .of(|r| r.score.marks_inside.into()),
        column("detections_inside", "count", "Number of detections that are not in the border.")
            .of(|r| r.score.detections_inside.into()),
        column(
            "density_ratio",
            "ratio",
            "Number of detections over number of marks, both without those in the border.",
        )
        .of(|r| r.score.density_ratio.into()),
        column("area_px2", "px²", "Area of the image without its border.").of(|r| r.score.area_px.into()),
        column("um_per_px", "µm/px", "Scale of the image; empty if not known.")
            .of(|r| r.score.um_per_px.into()),
        column(
            "expected_false_alarms",
            "count",
            "Number of false alarms expected from the scores: sum of 1 − score over the detections that \
             are counted; empty unless all of these have scores between 0 and 1.",
        )
        .of(|r| r.expected_false_alarms.into()),
        column("n_marks", "count", "Number of marks, border included.").of(|r| r.score.n_marks.into()),
        column("n_detections", "count", "Number of detections, border included.")
            .of(|r| r.score.n_detections.into()),
        column("limit_px", "px", "Greatest distance at which a mark and a detection are paired.")
            .of(|r| r.score.limit_px.into()),
        column(
            "assignment",
            "text",
            "Rule by which marks and detections are paired where several \
                                      are within reach.",
        )
        .of(|r| r.score.assignment.name().into()),
        column("versus_dice", "0–1", "Dice coefficient of the second detector or grader.")
            .only(Part::Versus)
            .of(|r| versus(r, |s| s.rates.dice)),
        column("versus_sensitivity", "0–1", "Sensitivity of the second detector or grader.")
            .only(Part::Versus)
            .of(|r| versus(r, |s| s.rates.sensitivity)),
        column("versus_fdr", "0–1", "False discovery rate of the second detector or grader.")
            .only(Part::Versus)
            .of(|r| versus(r, |s| s.rates.fdr)),
        column(
            "versus_detections_inside",
            "count",
            "Number of detections of the second that are \
                                                     not in the border.",
        )
        .only(Part::Versus)
        .of(|r| r.versus.as_ref().map(|v| v.score.detections_inside).into()),
        column("between_dice", "0–1", "Dice coefficient of the two against each other.")
            .only(Part::Versus)
            .of(|r| r.versus.as_ref().map(|v| v.between.rates.dice).into()),
    ],
};

/// Returns `validation.csv`; `two` means that two detectors or graders are compared.
///
/// # Errors
/// Fails if the table cannot be written as CSV.
pub fn validation_csv(rows: &[ValidationRow], two: bool) -> Result<Vec<u8>, ReportError> {
    let parts: &[Part] = if two { &[Part::Versus] } else { &[] };
    VALIDATION.csv_as(&Layout { samplers: &[], parts }, rows)
}

impl Row for GroupSummary {
    type Of<'a> = &'a Self;
}

/// The table of scores by group.
pub static SUBJECT_GROUPS: Table<GroupSummary> = Table {
    file: "groups.csv",
    commands: "validate --group-by",
    about: "One row per group (for example, per subject).",
    columns: &[
        column("group", "text", "Name of the group.").of(|g| g.group.as_str().into()),
        column("images", "count", "Number of images in the group.").of(|g| g.summary.images.into()),
        column("tp", "count", "Number of hits in all images.").of(|g| g.summary.pooled.tp.into()),
        column("fn", "count", "Number of misses in all images.").of(|g| g.summary.pooled.fn_.into()),
        column("fp", "count", "Number of false alarms in all images.").of(|g| g.summary.pooled.fp.into()),
        column("sensitivity", "0–1", "Mean of the images' sensitivities.")
            .of(|g| g.summary.sensitivity.into()),
        column("fdr", "0–1", "Mean of the images' false discovery rates.").of(|g| g.summary.fdr.into()),
        column("precision", "0–1", "Mean of the images' precisions.").of(|g| g.summary.precision.into()),
        column("dice", "0–1", "Mean of the images' Dice coefficients.").of(|g| g.summary.dice.into()),
        column("dice_strict", "0–1", "Mean of the images' Dice coefficients at the strict reach (0.4).")
            .of(|g| g.summary.dice_strict.into()),
        column("dice_sd", "0–1", "Standard deviation (n − 1) of the images' Dice coefficients.")
            .of(|g| g.dice_sd.into()),
        column("pooled_dice", "0–1", "Dice coefficient of the counts of all images together.")
            .of(|g| g.summary.pooled.dice.into()),
        column(
            "localisation_px",
            "px",
            "Mean over images of the localisation error, the median \
                                         distance of pairs.",
        )
        .of(|g| g.summary.localisation_px.into()),
        column("localisation_um", "µm", "localisation_px in µm; empty without a scale.")
            .of(|g| g.summary.localisation_um.into()),
        column("localisation_s", "spacings", "localisation_px in hexagonal spacings of the marks.")
            .of(|g| g.summary.localisation_s.into()),
        column(
            "count_bias",
            "count",
            "Mean over images of the number of detections minus the \
                                       number of marks.",
        )
        .of(|g| g.summary.count.map(|a| a.bias).into()),
        column(
            "density_percent_bias",
            "%",
            "Mean over images of the density of detections minus that of marks, in per cent of the \
             mean of the two.",
        )
        .of(|g| g.summary.density_percent.map(|a| a.bias).into()),
    ],
};

impl Row for FrocPoint {
    type Of<'a> = Self;
}

/// The table of rates at every threshold of the score.
pub static FROC: Table<FrocPoint> = Table {
    file: "froc.csv",
    commands: "validate",
    about: "One row per threshold of the score (Bunch et al. 1978).",
    columns: &[
        column("threshold", "score", "Lowest score of the detections that count.").of(|p| p.threshold.into()),
        column("sensitivity", "0–1", "Hits over marks, all images pooled.").of(|p| p.sensitivity.into()),
        column("precision", "0–1", "Hits over detections, all images pooled.").of(|p| p.precision.into()),
        column("dice", "0–1", "Dice coefficient, all images pooled.").of(|p| p.dice.into()),
        column("mean_dice", "0–1", "Mean of the images' Dice coefficients.").of(|p| p.mean_dice.into()),
        column("false_alarms_per_image", "count", "Mean number of false alarms per image.")
            .of(|p| p.false_alarms_per_image.into()),
        column(
            "false_alarms_per_mm2",
            "1/mm²",
            "False alarms per mm² of retina; empty unless the \
                                                 scales of all images are known.",
        )
        .of(|p| p.false_alarms_per_mm2.into()),
        column("false_alarms_per_100_marks", "count", "False alarms per 100 marks, all images pooled.")
            .of(|p| p.false_alarms_per_100_marks.into()),
    ],
};

/// Returns `froc.csv`, thinned to 1000 thresholds.
///
/// # Errors
/// Fails if the table cannot be written as CSV.
pub fn froc_csv(froc: &Froc) -> Result<Vec<u8>, ReportError> {
    FROC.csv(froc.thinned(CURVE_POINTS))
}

impl Row for ReliabilityBin {
    type Of<'a> = &'a Self;
}

/// The table of the reliability of scores as probabilities.
pub static RELIABILITY: Table<ReliabilityBin> = Table {
    file: "reliability.csv",
    commands: "validate",
    about: "One row per tenth of the range of scores.",
    columns: &[
        column("score_from", "0–1", "Lower end of the bin.").of(|b| b.from.into()),
        column("score_to", "0–1", "Upper end of the bin.").of(|b| b.to.into()),
        column("n", "count", "Number of detections in the bin.").of(|b| b.n.into()),
        column("mean_score", "0–1", "Mean score of these detections.").of(|b| b.mean_score.into()),
        column("hits", "0–1", "Share of these detections that are hits.").of(|b| b.hits.into()),
        column(
            "hits_low",
            "0–1",
            "Lower end of the 95 % confidence interval of hits, if detections \
                                   are taken as independent.",
        )
        .source("Wilson 1927")
        .of(|b| b.hits_interval.map(|i| i[0]).into()),
        column("hits_high", "0–1", "Upper end of that interval.")
            .source("Wilson 1927")
            .of(|b| b.hits_interval.map(|i| i[1]).into()),
    ],
};

impl Row for Difference {
    type Of<'a> = &'a Self;
}

/// The table of paired differences of two detectors or graders.
pub static COMPARISON: Table<Difference> = Table {
    file: "comparison.csv",
    commands: "validate --versus",
    about: "One row per measure: the same images, judged by two detectors or graders.",
    columns: &[
        column("measure", "text", "The measure compared.").of(|d| d.measure.into()),
        column("images", "count", "Number of images for which both have a value.").of(|d| d.images.into()),
        column("first", "of the measure", "Mean over images of the first.").of(|d| d.first.into()),
        column("second", "of the measure", "Mean over images of the second.").of(|d| d.second.into()),
        column("difference", "of the measure", "Mean over images of the difference first − second.")
            .of(|d| d.difference.into()),
        column(
            "low",
            "of the measure",
            "Lower end of the 95 % confidence interval of difference \
                                         (BCa bootstrap).",
        )
        .source("Efron 1987")
        .of(|d| d.interval.map(|i| i[0]).into()),
        column("high", "of the measure", "Upper end of that interval.")
            .source("Efron 1987")
            .of(|d| d.interval.map(|i| i[1]).into()),
        column(
            "p",
            "0–1",
            "p-value of the paired sign-flip test of the hypothesis that the mean \
                            difference is zero.",
        )
        .of(|d| d.p.into()),
        column(
            "p_least",
            "0–1",
            "Smallest p-value that is possible with so few groups (or images): 2/2ⁿ if n of them \
             differ (0.0625 for n = 5), 1/50,000 if more than 16 differ.",
        )
        .of(|d| d.least_p.into()),
    ],
};
