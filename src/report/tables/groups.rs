use super::{Row, Table, column};
use crate::compare::{SubjectMean, mean_over_subjects};
use crate::report::{ReportError, Subject, Summary};
use crate::stats::{Deviation, Moments, moments};
use std::collections::BTreeMap;

/// An image or file of coordinates that belongs to a group.
#[derive(Clone, Copy)]
pub struct GroupMember<'a> {
    /// Record of the member's mosaic.
    pub record: Subject<'a>,
    /// Person whose eye the image shows, if known.
    pub person: Option<&'a str>,
}

/// One column of the summary over the images of one group.
#[derive(Clone, Debug)]
pub struct GroupRow<'a> {
    group: &'a str,
    images: usize,
    column: String,
    unit: &'static str,
    /// Mean and standard deviation over the images of the group.
    over_images: Moments,
    /// Mean over the persons in the group, some of whom have several images.
    over_subjects: SubjectMean,
}

impl Row for GroupRow<'static> {
    type Of<'a> = GroupRow<'a>;
}

/// The table of means by group.
pub static GROUPS: Table<GroupRow> = Table {
    file: "groups.csv",
    commands: "measure --group-by, run --group-by",
    about: "One row per group and column of summary.csv. In mean and sd every image counts once. \
            Since images of one subject are not independent, the standard error and the interval \
            are those of the mean over subjects, where each subject counts with the mean of its \
            images. They need a column “subject” in the manifest; without one, every image counts \
            as a subject of its own.",
    columns: &[
        column(
            "group",
            "text",
            "Name of the group; if the manifest is grouped by several columns, \
                                 their values separated by commas.",
        )
        .of(|g| g.group.into()),
        column("images", "count", "Number of images (or files) in the group.").of(|g| g.images.into()),
        column("column", "text", "Name of the column of summary.csv.").of(|g| g.column.as_str().into()),
        column("unit", "text", "Unit of that column.").of(|g| g.unit.into()),
        column("n", "count", "Number of images of the group that have a value in that column.")
            .of(|g| g.over_images.n.into()),
        column("mean", "column “unit”", "Mean of these values.").of(|g| g.over_images.mean.into()),
        column(
            "sd",
            "column “unit”",
            "Standard deviation (n − 1) of these values; empty for fewer than two.",
        )
        .of(|g| g.over_images.sd.into()),
        column(
            "subjects",
            "count",
            "Number of subjects whose images these are; empty if the \
                                     manifest does not tell.",
        )
        .of(|g| g.over_subjects.subjects.into()),
        column("mean_of_subjects", "column “unit”", "Mean of the subjects' means.")
            .of(|g| g.over_subjects.mean.into()),
        column(
            "se",
            "column “unit”",
            "Standard error of mean_of_subjects: standard deviation (n − 1) of the subjects' means \
             over √subjects; empty for fewer than two subjects.",
        )
        .of(|g| g.over_subjects.standard_error.into()),
        column(
            "mean_low",
            "column “unit”",
            "Lower end of the 95 % confidence interval of mean_of_subjects (t distribution, \
             subjects − 1 degrees of freedom).",
        )
        .of(|g| g.over_subjects.interval.map(|i| i[0]).into()),
        column("mean_high", "column “unit”", "Upper end of that interval.")
            .of(|g| g.over_subjects.interval.map(|i| i[1]).into()),
    ],
};

/// Returns `groups.csv`: every numeric column of a summary over the members of each group.
///
/// # Errors
/// Fails if the table cannot be written as CSV.
pub fn groups_csv(
    summary: &Summary,
    groups: &BTreeMap<String, Vec<GroupMember>>,
) -> Result<Vec<u8>, ReportError> {
    GROUPS.csv(groups.iter().flat_map(|(group, members)| rows(summary, group, members)))
}

/// Returns one row per column of numbers.
fn rows<'a>(summary: &Summary, group: &'a str, members: &[GroupMember]) -> Vec<GroupRow<'a>> {
    let records: Vec<Subject> = members.iter().map(|m| m.record).collect();
    let row = |(column, unit, values): (String, &'static str, Vec<Option<f64>>)| {
        let known = members.iter().zip(values).filter_map(|(m, value)| Some((m.person, value?)));
        let known: Vec<(Option<&str>, f64)> = known.collect();
        let alone: Vec<f64> = known.iter().map(|(_, value)| *value).collect();
        GroupRow {
            group,
            images: members.len(),
            column,
            unit,
            over_images: moments(&alone, Deviation::Sample),
            over_subjects: mean_over_subjects(&known),
        }
    };
    summary.numbers(&records).into_iter().map(row).collect()
}
