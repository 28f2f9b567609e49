use super::{OutputTable, column};

/// Detections against marks.
pub static VALIDATION: OutputTable = OutputTable {
    file: "validation.csv",
    commands: "validate",
    about: "A row an image. Pairs, misses and false alarms count outside a border of the image only (Cunefare et al. 2017); the columns \
            from versus_dice on are there where two detectors or graders are compared.",
    columns: &[
        column("file", "text", "The detections or image, as given."),
        column("name", "text", "Name of the image."),
        column("group", "text", "Its group; empty without groups."),
        column("tp", "count", "Hits: marks with a detection."),
        column("fn", "count", "Misses: marks without."),
        column("fp", "count", "False alarms: detections without a mark."),
        column("sensitivity", "0–1", "tp/(tp + fn)."),
        column("fdr", "0–1", "False discovery rate, fp/(tp + fp)."),
        column("precision", "0–1", "tp/(tp + fp)."),
        column("dice", "0–1", "Dice coefficient or F1, 2 tp/(2 tp + fn + fp)."),
        column("localisation_px", "px", "Median distance of pairs."),
        column("localisation_um", "µm", "The same; empty without a scale."),
        column("localisation_s", "spacings", "The same, in hexagonal spacings of the marks."),
        column("offset_x_px", "px", "Mean way from mark to detection, to the right."),
        column("offset_y_px", "px", "Mean way from mark to detection, down."),
        column("marks_inside", "count", "Marks outside the border."),
        column("detections_inside", "count", "Detections outside the border."),
        column("density_ratio", "ratio", "Detections over marks."),
        column("area_px2", "px²", "Area of the image without its border."),
        column("um_per_px", "µm/px", "Scale; empty if not known."),
        column(
            "expected_false_alarms",
            "count",
            "Sum of 1 − score over the detections; empty where the program did not find them.",
        ),
        column("n_marks", "count", "Marks, border included."),
        column("n_detections", "count", "Detections, border included."),
        column("limit_px", "px", "Greatest distance of a pair."),
        column("assignment", "text", "Who got whom where several were near."),
        column("versus_dice", "0–1", "Dice coefficient of the second."),
        column("versus_sensitivity", "0–1", "Sensitivity of the second."),
        column("versus_fdr", "0–1", "False discovery rate of the second."),
        column("versus_detections_inside", "count", "Detections of the second."),
        column("between_dice", "0–1", "Dice coefficient of the two against each other."),
    ],
};

/// By subject.
pub static SUBJECT_GROUPS: OutputTable = OutputTable {
    file: "groups.csv",
    commands: "validate --group-by",
    about: "A row a group (subject).",
    columns: &[
        column("group", "text", "The group."),
        column("images", "count", "Images."),
        column("tp", "count", "Hits of all images."),
        column("fn", "count", "Misses of all images."),
        column("fp", "count", "False alarms of all images."),
        column("sensitivity", "0–1", "Mean over images."),
        column("fdr", "0–1", "Mean over images."),
        column("precision", "0–1", "Mean over images."),
        column("dice", "0–1", "Mean over images."),
        column("dice_sd", "0–1", "Standard deviation (n − 1) over images."),
        column("pooled_dice", "0–1", "Of the counts of all images together."),
        column("localisation_px", "px", "Mean over images of the median distance of pairs."),
        column("localisation_um", "µm", "The same; empty without a scale."),
        column("localisation_s", "spacings", "The same, in hexagonal spacings."),
        column("count_bias", "count", "Mean over images of detections less marks."),
        column("density_percent_bias", "%", "Mean over images of that difference over the mean of the two."),
    ],
};

/// Every threshold of the score.
pub static FROC: OutputTable = OutputTable {
    file: "froc.csv",
    commands: "validate",
    about: "A row a threshold of the score (Bunch et al. 1978).",
    columns: &[
        column("threshold", "score", "Least score of the detections that count."),
        column("sensitivity", "0–1", "Hits over marks, all images pooled."),
        column("precision", "0–1", "Hits over detections, all images pooled."),
        column("dice", "0–1", "Dice coefficient, all images pooled."),
        column("mean_dice", "0–1", "Mean of the images' Dice coefficients."),
        column("false_alarms_per_image", "count", "Mean over images."),
        column("false_alarms_per_mm2", "1/mm²", "Per area of retina; empty unless all scales are known."),
        column("false_alarms_per_100_marks", "count", "All images pooled."),
    ],
};

/// Whether scores are probabilities.
pub static RELIABILITY: OutputTable = OutputTable {
    file: "reliability.csv",
    commands: "validate",
    about: "A row a tenth of the range of scores.",
    columns: &[
        column("score_from", "0–1", "Least score of the bin."),
        column("score_to", "0–1", "Its upper end."),
        column("n", "count", "Detections in it."),
        column("mean_score", "0–1", "Their mean score."),
        column("hits", "0–1", "Share of them that are hits."),
        column("hits_low", "0–1", "Its 95 % interval (Wilson 1927), detections taken as independent."),
        column("hits_high", "0–1", "Its 95 % interval."),
    ],
};

/// Two detectors or graders.
pub static COMPARISON: OutputTable = OutputTable {
    file: "comparison.csv",
    commands: "validate --versus",
    about: "A row a measure: the same images by two detectors or graders.",
    columns: &[
        column("measure", "text", "What is compared."),
        column("images", "count", "Images for which both have a value."),
        column("first", "of the measure", "Mean over images of the first."),
        column("second", "of the measure", "Mean over images of the second."),
        column("difference", "of the measure", "Mean of first − second of the same image."),
        column("low", "of the measure", "Its 95 % interval (BCa bootstrap; Efron 1987)."),
        column("high", "of the measure", "Its 95 % interval."),
        column("p", "0–1", "p-value of the paired sign-flip test that the mean difference is zero."),
        column(
            "p_least",
            "0–1",
            "Least p-value that so few groups (or images) can have: 2/2ⁿ of n that differ, .0625 of 5; above 16 of them 1/50,000.",
        ),
    ],
};
