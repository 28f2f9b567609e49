use super::{Row, Table, column};
use crate::compare::{ClusteredAgreement, Interval, Intraclass};

/// The agreement of two graders, or of all of them, in one column.
#[derive(Clone, Copy, Debug)]
pub struct AgreementRow<'a> {
    /// Name of the column.
    pub column: &'a str,
    /// Names of the two graders; “all” twice in the row over all of them.
    pub graders: [&'a str; 2],
    /// Number of images that these graders share.
    pub n: usize,
    /// Mean of each grader; `None` in the row over all.
    pub means: Option<[f64; 2]>,
    /// Bias and limits of agreement; `None` in the row over all.
    pub agreement: Option<ClusteredAgreement>,
    /// Intraclass correlations, if defined.
    pub intraclass: Option<Intraclass>,
    /// Dependence of images: true if images of one group do not count as independent.
    pub grouped: bool,
}

impl Row for AgreementRow<'static> {
    type Of<'a> = AgreementRow<'a>;
}

impl AgreementRow<'_> {
    /// Returns one end of an interval of the agreement: 0 is the lower, 1 the upper one.
    fn end(&self, end: usize, interval: fn(&ClusteredAgreement) -> Option<Interval>) -> Option<f64> {
        interval(self.agreement.as_ref()?)?.get(end).copied()
    }

    /// Returns one end of an interval of the correlation: 0 is the lower, 1 the upper one.
    fn icc_end(&self, end: usize, interval: fn(&Intraclass) -> Option<Interval>) -> Option<f64> {
        // These intervals assume independent images, which the images of a group are not.
        let icc = self.intraclass.as_ref().filter(|_| !self.grouped)?;
        interval(icc)?.get(end).copied()
    }
}

/// The table of limits of agreement and intraclass correlations.
pub static AGREEMENT: Table<AgreementRow> = Table {
    file: "agreement.csv",
    commands: "agree",
    about: "One row per numeric column and pair of graders, sessions or programs; if there are more \
            than two of them, one more row for all together. Values are in the unit of the column \
            unless another unit is named.",
    columns: &[
        column("column", "text", "Name of the column compared.").of(|a| a.column.into()),
        column("first", "text", "The first grader, session or program.").of(|a| a.graders[0].into()),
        column("second", "text", "The second grader, session or program.").of(|a| a.graders[1].into()),
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
            "Lower end of the 95 % confidence interval of \
                                                   difference (t distribution).",
        )
        .of(|a| a.end(0, |g| g.bias_interval).into()),
        column("difference_high", "of the column", "Upper end of that interval.")
            .of(|a| a.end(1, |g| g.bias_interval).into()),
        column(
            "sd",
            "of the column",
            "Standard deviation (n − 1) of the differences; with groups, \
                                       the root of the sum of the variances between and within \
                                       groups.",
        )
        .of(|a| a.agreement.and_then(|g| g.agreement.sd).into()),
        column("limit_low", "of the column", "Lower limit of agreement, bias − 1.96 SD.")
            .source("Bland & Altman 1999")
            .of(|a| a.end(0, |g| g.agreement.limits).into()),
        column("limit_low_from", "of the column", "Lower end of the 95 % confidence interval of limit_low.")
            .source("Bland & Altman 1999")
            .of(|a| a.end(0, |g| g.limit_intervals.map(|i| i[0])).into()),
        column("limit_low_to", "of the column", "Upper end of that interval.")
            .source("Bland & Altman 1999")
            .of(|a| a.end(1, |g| g.limit_intervals.map(|i| i[0])).into()),
        column("limit_high", "of the column", "Upper limit of agreement, bias + 1.96 SD.")
            .source("Bland & Altman 1999")
            .of(|a| a.end(1, |g| g.agreement.limits).into()),
        column(
            "limit_high_from",
            "of the column",
            "Lower end of the 95 % confidence interval of limit_high.",
        )
        .source("Bland & Altman 1999")
        .of(|a| a.end(0, |g| g.limit_intervals.map(|i| i[1])).into()),
        column("limit_high_to", "of the column", "Upper end of that interval.")
            .source("Bland & Altman 1999")
            .of(|a| a.end(1, |g| g.limit_intervals.map(|i| i[1])).into()),
        column(
            "icc_agreement",
            "≤ 1",
            "ICC(2,1), absolute agreement: it is lowered by differences between the means of the \
             graders; empty if the values do not vary.",
        )
        .source("McGraw & Wong 1996")
        .of(|a| a.intraclass.and_then(|i| i.agreement).into()),
        column("icc_agreement_low", "≤ 1", "Lower end of the 95 % confidence interval of icc_agreement.")
            .source("McGraw & Wong 1996")
            .of(|a| a.icc_end(0, |i| i.agreement_interval).into()),
        column("icc_agreement_high", "≤ 1", "Upper end of that interval.")
            .source("McGraw & Wong 1996")
            .of(|a| a.icc_end(1, |i| i.agreement_interval).into()),
        column(
            "icc_consistency",
            "≤ 1",
            "ICC(3,1), consistency: it is not lowered by differences \
                                          between the means of the graders.",
        )
        .source("McGraw & Wong 1996")
        .of(|a| a.intraclass.and_then(|i| i.consistency).into()),
        column("icc_consistency_low", "≤ 1", "Lower end of the 95 % confidence interval of icc_consistency.")
            .source("McGraw & Wong 1996")
            .of(|a| a.icc_end(0, |i| i.consistency_interval).into()),
        column("icc_consistency_high", "≤ 1", "Upper end of that interval.")
            .source("McGraw & Wong 1996")
            .of(|a| a.icc_end(1, |i| i.consistency_interval).into()),
        column("within_sd", "of the column", "Standard deviation of repeated measurements of one image.")
            .source("Bland & Altman 1996")
            .of(|a| a.intraclass.map(|i| i.within_sd).into()),
        column(
            "repeatability",
            "of the column",
            "Repeatability coefficient, 1.96 √2 within_sd: two measurements of one image differ by \
             less in 95 % of cases.",
        )
        .source("Bland & Altman 1996")
        .of(|a| a.intraclass.map(|i| i.repeatability).into()),
        column(
            "within_cv_percent",
            "%",
            "Within-image coefficient of variation: within_sd over the \
                                          mean; empty if the mean is 0.",
        )
        .of(|a| a.intraclass.and_then(|i| i.within_cv_percent).into()),
        column(
            "groups",
            "count",
            "Number of groups of images that count as independent; n if there are no groups. With \
             groups, the limits are those for repeated measurements (Bland & Altman 2007), their \
             intervals are by Zou (2013), and the intervals of ICC are left out.",
        )
        .source("Bland & Altman 2007")
        .of(|a| a.agreement.map(|g| g.clusters).into()),
    ],
};

/// The values of two graders for one image.
#[derive(Clone, Copy, Debug)]
pub struct DifferenceRow<'a> {
    /// Name of the image.
    pub image: &'a str,
    /// Name of the column.
    pub column: &'a str,
    /// Names of the two graders.
    pub graders: [&'a str; 2],
    /// Values of the two graders.
    pub values: [f64; 2],
}

impl Row for DifferenceRow<'static> {
    type Of<'a> = DifferenceRow<'a>;
}

/// The table of differences, image by image.
pub static DIFFERENCES: Table<DifferenceRow> = Table {
    file: "differences.csv",
    commands: "agree",
    about: "One row per column, pair of graders and image.",
    columns: &[
        column("image", "text", "Name of the image.").of(|d| d.image.into()),
        column("column", "text", "Name of the column compared.").of(|d| d.column.into()),
        column("first", "text", "The first grader, session or program.").of(|d| d.graders[0].into()),
        column("second", "text", "The second grader, session or program.").of(|d| d.graders[1].into()),
        column("value_first", "of the column", "Value given by the first.").of(|d| d.values[0].into()),
        column("value_second", "of the column", "Value given by the second.").of(|d| d.values[1].into()),
        column("mean", "of the column", "Mean of the two values.")
            .of(|d| ((d.values[0] + d.values[1]) / 2.).into()),
        column("difference", "of the column", "value_first − value_second.")
            .of(|d| (d.values[0] - d.values[1]).into()),
    ],
};

/// An image that not all graders have.
#[derive(Clone, Copy, Debug)]
pub struct UnpairedRow<'a> {
    /// Name of the image.
    pub image: &'a str,
    /// Names of the graders who lack it, separated by commas.
    pub missing_from: &'a str,
}

impl Row for UnpairedRow<'static> {
    type Of<'a> = UnpairedRow<'a>;
}

/// The table of images that not all graders have.
pub static UNPAIRED: Table<UnpairedRow> = Table {
    file: "unpaired.csv",
    commands: "agree",
    about: "One row per image that some of the graders, sessions or programs lack.",
    columns: &[
        column("image", "text", "Name of the image.").of(|u| u.image.into()),
        column("missing_from", "text", "Graders, sessions or programs that lack the image.")
            .of(|u| u.missing_from.into()),
    ],
};
