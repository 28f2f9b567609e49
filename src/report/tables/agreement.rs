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
    about: "One row per column of numbers and pair of graders, sessions or programs; with more \
            than two of them a further row over all. In the unit of the column where no other is \
            named.",
    columns: &[
        column("column", "text", "The column.").of(|a| a.column.into()),
        column("first", "text", "The first grader, session or program.").of(|a| a.graders[0].into()),
        column("second", "text", "The second.").of(|a| a.graders[1].into()),
        column("n", "count", "Images that both have.").of(|a| a.n.into()),
        column("mean_first", "of the column", "Mean of the first.").of(|a| a.means.map(|m| m[0]).into()),
        column("mean_second", "of the column", "Mean of the second.").of(|a| a.means.map(|m| m[1]).into()),
        column("difference", "of the column", "Bias: mean of first − second.")
            .of(|a| a.agreement.map(|g| g.agreement.bias).into()),
        column("difference_low", "of the column", "Lower end of the 95 % interval of difference (t).")
            .of(|a| a.end(0, |g| g.bias_interval).into()),
        column("difference_high", "of the column", "Upper end of that interval.")
            .of(|a| a.end(1, |g| g.bias_interval).into()),
        column("sd", "of the column", "Standard deviation (n − 1) of the differences; with groups, of both components of their variance.")
            .of(|a| a.agreement.and_then(|g| g.agreement.sd).into()),
        column("limit_low", "of the column", "Lower limit of agreement, bias − 1.96 SD.")
            .source("Bland & Altman 1999")
            .of(|a| a.end(0, |g| g.agreement.limits).into()),
        column("limit_low_from", "of the column", "Lower end of the 95 % interval of limit_low.")
            .source("Bland & Altman 1999")
            .of(|a| a.end(0, |g| g.limit_intervals.map(|i| i[0])).into()),
        column("limit_low_to", "of the column", "Upper end of that interval.")
            .source("Bland & Altman 1999")
            .of(|a| a.end(1, |g| g.limit_intervals.map(|i| i[0])).into()),
        column("limit_high", "of the column", "Upper limit of agreement, bias + 1.96 SD.")
            .source("Bland & Altman 1999")
            .of(|a| a.end(1, |g| g.agreement.limits).into()),
        column("limit_high_from", "of the column", "Lower end of the 95 % interval of limit_high.")
            .source("Bland & Altman 1999")
            .of(|a| a.end(0, |g| g.limit_intervals.map(|i| i[1])).into()),
        column("limit_high_to", "of the column", "Upper end of that interval.")
            .source("Bland & Altman 1999")
            .of(|a| a.end(1, |g| g.limit_intervals.map(|i| i[1])).into()),
        column(
            "icc_agreement",
            "≤ 1",
            "ICC(2,1), absolute agreement: differences of the means count against it; empty where \
                nothing varies.",
        )
        .source("McGraw & Wong 1996")
        .of(|a| a.intraclass.and_then(|i| i.agreement).into()),
        column("icc_agreement_low", "≤ 1", "Lower end of the 95 % interval of icc_agreement.")
            .source("McGraw & Wong 1996")
            .of(|a| a.icc_end(0, |i| i.agreement_interval).into()),
        column("icc_agreement_high", "≤ 1", "Upper end of that interval.")
            .source("McGraw & Wong 1996")
            .of(|a| a.icc_end(1, |i| i.agreement_interval).into()),
        column("icc_consistency", "≤ 1", "ICC(3,1), consistency: differences of the means do not count.")
            .source("McGraw & Wong 1996")
            .of(|a| a.intraclass.and_then(|i| i.consistency).into()),
        column("icc_consistency_low", "≤ 1", "Lower end of the 95 % interval of icc_consistency.")
            .source("McGraw & Wong 1996")
            .of(|a| a.icc_end(0, |i| i.consistency_interval).into()),
        column("icc_consistency_high", "≤ 1", "Upper end of that interval.")
            .source("McGraw & Wong 1996")
            .of(|a| a.icc_end(1, |i| i.consistency_interval).into()),
        column("within_sd", "of the column", "Standard deviation of the measurements of one image.")
            .source("Bland & Altman 1996")
            .of(|a| a.intraclass.map(|i| i.within_sd).into()),
        column(
            "repeatability",
            "of the column",
            "Of two measurements of one image 95 % differ by less: 1.96 √2 within_sd.",
        )
        .source("Bland & Altman 1996")
        .of(|a| a.intraclass.map(|i| i.repeatability).into()),
        column("within_cv_percent", "%", "within_sd over the mean; empty where that is 0.")
            .of(|a| a.intraclass.and_then(|i| i.within_cv_percent).into()),
        column(
            "groups",
            "count",
            "Groups of images that count as independent: with groups fewer than images. The limits are then \
             those for repeated measurements (Bland & Altman 2007), their intervals by Zou (2013), and \
             intervals of ICC are left out.",
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
    about: "One row per column, pair of graders and image.",
    columns: &[
        column("image", "text", "The image.").of(|d| d.image.into()),
        column("column", "text", "The column.").of(|d| d.column.into()),
        column("first", "text", "The first grader, session or program.").of(|d| d.graders[0].into()),
        column("second", "text", "The second.").of(|d| d.graders[1].into()),
        column("value_first", "of the column", "Value of the first.").of(|d| d.values[0].into()),
        column("value_second", "of the column", "Value of the second.").of(|d| d.values[1].into()),
        column("mean", "of the column", "Mean of the two.").of(|d| ((d.values[0] + d.values[1]) / 2.).into()),
        column("difference", "of the column", "value_first − value_second.")
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
    about: "One row per image that not all have.",
    columns: &[
        column("image", "text", "The image.").of(|u| u.image.into()),
        column("missing_from", "text", "Graders who lack it.").of(|u| u.missing_from.into()),
    ],
};
