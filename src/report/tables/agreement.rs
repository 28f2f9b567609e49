use super::{OutputTable, column};

/// Limits of agreement and intraclass correlations.
pub static AGREEMENT: OutputTable = OutputTable {
    file: "agreement.csv",
    commands: "agree",
    about: "A row a column of numbers and pair of graders, sessions or programs; with more than two of them a further row over all. In \
            the unit of the column where no other is named (Bland & Altman 1999; McGraw & Wong 1996).",
    columns: &[
        column("column", "text", "The column."),
        column("first", "text", "The first grader, session or program."),
        column("second", "text", "The second."),
        column("n", "count", "Images that both have."),
        column("mean_first", "of the column", "Mean of the first."),
        column("mean_second", "of the column", "Mean of the second."),
        column("difference", "of the column", "Bias: mean of first − second."),
        column("difference_low", "of the column", "Its 95 % interval (t)."),
        column("difference_high", "of the column", "Its 95 % interval (t)."),
        column(
            "sd",
            "of the column",
            "Standard deviation (n − 1) of the differences; of both components of their variance with groups.",
        ),
        column("limit_low", "of the column", "Lower limit of agreement, bias − 1.96 SD."),
        column("limit_low_from", "of the column", "Its 95 % interval."),
        column("limit_low_to", "of the column", "Its 95 % interval."),
        column("limit_high", "of the column", "Upper limit of agreement, bias + 1.96 SD."),
        column("limit_high_from", "of the column", "Its 95 % interval."),
        column("limit_high_to", "of the column", "Its 95 % interval."),
        column(
            "icc_agreement",
            "≤ 1",
            "ICC(2,1), absolute agreement: differences of the means count against it; empty where nothing varies.",
        ),
        column("icc_agreement_low", "≤ 1", "Its 95 % interval."),
        column("icc_agreement_high", "≤ 1", "Its 95 % interval."),
        column("icc_consistency", "≤ 1", "ICC(3,1), consistency: differences of the means do not count."),
        column("icc_consistency_low", "≤ 1", "Its 95 % interval."),
        column("icc_consistency_high", "≤ 1", "Its 95 % interval."),
        column("within_sd", "of the column", "Standard deviation of the measurements of one image."),
        column(
            "repeatability",
            "of the column",
            "Of two measurements of one image 95 % differ by less: 1.96 √2 within_sd.",
        ),
        column("within_cv_percent", "%", "within_sd over the mean; empty where that is 0."),
        column(
            "groups",
            "count",
            "Groups of images that count as independent: with --group-by fewer than images. Then the limits are those for repeated measurements (Bland & Altman 2007), their intervals by Zou (2013), and intervals of ICC are left out.",
        ),
    ],
};

/// Image by image.
pub static DIFFERENCES: OutputTable = OutputTable {
    file: "differences.csv",
    commands: "agree",
    about: "A row a column, pair of graders and image.",
    columns: &[
        column("image", "text", "The image."),
        column("column", "text", "The column."),
        column("first", "text", "The first grader, session or program."),
        column("second", "text", "The second."),
        column("value_first", "of the column", "Value of the first."),
        column("value_second", "of the column", "Value of the second."),
        column("mean", "of the column", "Their mean."),
        column("difference", "of the column", "First − second."),
    ],
};

/// Images that somebody lacks.
pub static UNPAIRED: OutputTable = OutputTable {
    file: "unpaired.csv",
    commands: "agree",
    about: "A row an image that not all have.",
    columns: &[column("image", "text", "The image."), column("missing_from", "text", "Who lacks it.")],
};
