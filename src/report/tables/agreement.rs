use super::{Row, Table, column};
use crate::compare::{ClusteredAgreement, Interval, Intraclass};

/// Agreement of two graders, or of all, in one column.
#[derive(Clone, Copy, Debug)]
pub struct AgreementRow<'a> {
    /// The column.
    pub column: &'a str,
    /// The two graders; “all” twice for the row over all of them.
    pub graders: [&'a str; 2],
    /// Images.
    pub n: usize,
    /// Mean of each grader; `None` for the row over all.
    pub means: Option<[f64; 2]>,
    /// Bias and limits of agreement; `None` for the row over all.
    pub agreement: Option<ClusteredAgreement>,
    /// Intraclass correlation.
    pub intraclass: Option<Intraclass>,
    /// Images of a group do not count as independent.
    pub grouped: bool,
}

impl Row for AgreementRow<'static> {
    type Of<'a> = AgreementRow<'a>;
}

impl AgreementRow<'_> {
    /// Returns one end of an interval of the agreement.
    fn end(&self, end: usize, interval: fn(&ClusteredAgreement) -> Option<Interval>) -> Option<f64> {
        interval(self.agreement.as_ref()?)?.get(end).copied()
    }

    /// Returns one end of an interval of the correlation.
    fn icc_end(&self, end: usize, interval: fn(&Intraclass) -> Option<Interval>) -> Option<f64> {
        // these intervals would take the images of a group as independent
        let icc = self.intraclass.as_ref().filter(|_| !self.grouped)?;
        interval(icc)?.get(end).copied()
    }
}

/// Limits of agreement and intraclass correlations.
pub static AGREEMENT: Table<AgreementRow> = Table {
    file: "agreement.csv",
    commands: "agree",
    about: "One row for each column of numbers and each pair of graders, sessions or programs; \
        with more than two of them, also one row over all. Values are in the unit of the \
        column unless another unit is given.",
    columns: &[
        column("column", "text", "Name of the column that is compared.").of(|a| a.column.into()),
        column("first", "text", "Name of the first grader, session or program.").of(|a| a.graders[0].into()),
        column("second", "text", "Name of the second grader, session or program.")
            .of(|a| a.graders[1].into()),
        column("n", "count", "Number of images for which both have a value.").of(|a| a.n.into()),
        column("mean_first", "of the column", "Mean of the values of the first.")
            .of(|a| a.means.map(|m| m[0]).into()),
        column("mean_second", "of the column", "Mean of the values of the second.")
            .of(|a| a.means.map(|m| m[1]).into()),
        column("difference", "of the column", "Bias: mean of the differences first − second.")
            .of(|a| a.agreement.map(|g| g.agreement.bias).into()),
        column(
            "difference_low",
            "of the column",
            "Lower end of the 95 % confidence interval of difference (t distribution).",
        )
        .of(|a| a.end(0, |g| g.bias_interval).into()),
        column(
            "difference_high",
            "of the column",
            "Upper end of the 95 % confidence interval of difference (t distribution).",
        )
        .of(|a| a.end(1, |g| g.bias_interval).into()),
        column(
            "sd",
            "of the column",
            "Standard deviation (divisor n − 1) of the differences. If the images are grouped, it \
                is the square root of the sum of both components of the variance, between and within \
                groups.",
        )
        .of(|a| a.agreement.and_then(|g| g.agreement.sd).into()),
        column(
            "limit_low",
            "of the column",
            "Lower limit of agreement: bias − 1.96 × standard deviation of the differences.",
        )
        .source("Bland & Altman 1999")
        .of(|a| a.end(0, |g| g.agreement.limits).into()),
        column("limit_low_from", "of the column", "Lower end of the 95 % confidence interval of limit_low.")
            .source("Bland & Altman 1999")
            .of(|a| a.end(0, |g| g.limit_intervals.map(|i| i[0])).into()),
        column("limit_low_to", "of the column", "Upper end of the 95 % confidence interval of limit_low.")
            .source("Bland & Altman 1999")
            .of(|a| a.end(1, |g| g.limit_intervals.map(|i| i[0])).into()),
        column(
            "limit_high",
            "of the column",
            "Upper limit of agreement: bias + 1.96 × standard deviation of the differences.",
        )
        .source("Bland & Altman 1999")
        .of(|a| a.end(1, |g| g.agreement.limits).into()),
        column(
            "limit_high_from",
            "of the column",
            "Lower end of the 95 % confidence interval of limit_high.",
        )
        .source("Bland & Altman 1999")
        .of(|a| a.end(0, |g| g.limit_intervals.map(|i| i[1])).into()),
        column("limit_high_to", "of the column", "Upper end of the 95 % confidence interval of limit_high.")
            .source("Bland & Altman 1999")
            .of(|a| a.end(1, |g| g.limit_intervals.map(|i| i[1])).into()),
        column(
            "icc_agreement",
            "≤ 1",
            "Intraclass correlation for absolute agreement, ICC(2,1): differences between the \
                means lower it; empty if all values are equal.",
        )
        .source("McGraw & Wong 1996")
        .of(|a| a.intraclass.and_then(|i| i.agreement).into()),
        column("icc_agreement_low", "≤ 1", "Lower end of the 95 % confidence interval of icc_agreement.")
            .source("McGraw & Wong 1996")
            .of(|a| a.icc_end(0, |i| i.agreement_interval).into()),
        column("icc_agreement_high", "≤ 1", "Upper end of the 95 % confidence interval of icc_agreement.")
            .source("McGraw & Wong 1996")
            .of(|a| a.icc_end(1, |i| i.agreement_interval).into()),
        column(
            "icc_consistency",
            "≤ 1",
            "Intraclass correlation for consistency, ICC(3,1): differences between the means do \
                not lower it.",
        )
        .source("McGraw & Wong 1996")
        .of(|a| a.intraclass.and_then(|i| i.consistency).into()),
        column("icc_consistency_low", "≤ 1", "Lower end of the 95 % confidence interval of icc_consistency.")
            .source("McGraw & Wong 1996")
            .of(|a| a.icc_end(0, |i| i.consistency_interval).into()),
        column(
            "icc_consistency_high",
            "≤ 1",
            "Upper end of the 95 % confidence interval of icc_consistency.",
        )
        .source("McGraw & Wong 1996")
        .of(|a| a.icc_end(1, |i| i.consistency_interval).into()),
        column(
            "within_sd",
            "of the column",
            "Within-image standard deviation: standard deviation of the measurements of the same \
                image.",
        )
        .source("Bland & Altman 1996")
        .of(|a| a.intraclass.map(|i| i.within_sd).into()),
        column(
            "repeatability",
            "of the column",
            "Repeatability, 1.96 √2 within_sd: in 95 % of cases, two measurements of the same \
                image differ by less than this.",
        )
        .source("Bland & Altman 1996")
        .of(|a| a.intraclass.map(|i| i.repeatability).into()),
        column(
            "within_cv_percent",
            "%",
            "Within-image coefficient of variation: within_sd as a percentage of the mean; empty \
                if the mean is 0.",
        )
        .of(|a| a.intraclass.and_then(|i| i.within_cv_percent).into()),
        column(
            "groups",
            "count",
            "Number of groups of images that count as independent, which is smaller than the \
                number of images if the images are grouped. In that case the limits of agreement are \
                those for repeated measurements (Bland & Altman 2007), with the confidence intervals \
                of Zou (2013), and confidence intervals of the ICC are left out.",
        )
        .source("Bland & Altman 2007")
        .of(|a| a.agreement.map(|g| g.clusters).into()),
    ],
};

/// The values of two graders for one image.
#[derive(Clone, Copy, Debug)]
pub struct DifferenceRow<'a> {
    /// The image.
    pub image: &'a str,
    /// The column.
    pub column: &'a str,
    /// The two graders.
    pub graders: [&'a str; 2],
    /// Their values.
    pub values: [f64; 2],
}

impl Row for DifferenceRow<'static> {
    type Of<'a> = DifferenceRow<'a>;
}

/// Differences image by image.
pub static DIFFERENCES: Table<DifferenceRow> = Table {
    file: "differences.csv",
    commands: "agree",
    about: "One row for each column, each pair of graders and each image.",
    columns: &[
        column("image", "text", "Name of the image.").of(|d| d.image.into()),
        column("column", "text", "Name of the column.").of(|d| d.column.into()),
        column("first", "text", "Name of the first grader, session or program.").of(|d| d.graders[0].into()),
        column("second", "text", "Name of the second grader, session or program.")
            .of(|d| d.graders[1].into()),
        column("value_first", "of the column", "Value from the first grader, session or program.")
            .of(|d| d.values[0].into()),
        column("value_second", "of the column", "Value from the second grader, session or program.")
            .of(|d| d.values[1].into()),
        column("mean", "of the column", "Mean of the two values.")
            .of(|d| ((d.values[0] + d.values[1]) / 2.).into()),
        column("difference", "of the column", "Difference of the two values, value_first − value_second.")
            .of(|d| (d.values[0] - d.values[1]).into()),
    ],
};

/// An image that not all graders have.
#[derive(Clone, Copy, Debug)]
pub struct UnpairedRow<'a> {
    /// The image.
    pub image: &'a str,
    /// Graders who lack it, separated by commas.
    pub missing_from: &'a str,
}

impl Row for UnpairedRow<'static> {
    type Of<'a> = UnpairedRow<'a>;
}

/// Images that not all graders have.
pub static UNPAIRED: Table<UnpairedRow> = Table {
    file: "unpaired.csv",
    commands: "agree",
    about: "One row for each image that some of the graders lack.",
    columns: &[
        column("image", "text", "Name of the image.").of(|u| u.image.into()),
        column("missing_from", "text", "Names of the graders who lack the image, separated by commas.")
            .of(|u| u.missing_from.into()),
    ],
};
