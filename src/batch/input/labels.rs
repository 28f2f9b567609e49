use crate::batch::output::OutputFolder;
use crate::batch::{BatchError, Grouping};
use crate::mosaic::io::Manifest;
use crate::mosaic::{MICROMETRES_PER_DEGREE, RetinalPlace, Scale};
use crate::report::tables::{GROUPS, GroupMember, groups_csv};
use crate::report::{MosaicRecord, Subject, Summary, significant};
use std::collections::BTreeMap;
use std::path::Path;
use std::str::FromStr;

/// What is known of images beside their pixels, and which of them belong together.
#[derive(Clone, Debug, Default)]
pub struct Labels {
    /// What a manifest says of them.
    pub manifest: Option<Manifest>,
    /// Groups whose means are wanted.
    pub group_by: Option<GroupBy>,
}

/// Which images belong together.
#[derive(Clone, Debug)]
pub enum GroupBy {
    /// Those with the same words in these columns of the manifest.
    Columns(Vec<String>),
    /// By their names.
    Name(Grouping),
}

impl FromStr for GroupBy {
    type Err = String;

    /// `column:NAME[,NAME…]`, or what [`Grouping`] is read from.
    fn from_str(text: &str) -> Result<Self, String> {
        let Some(names) = text.strip_prefix("column:") else { return text.parse().map(Self::Name) };
        let names: Vec<String> =
            names.split(',').map(|n| n.trim().to_owned()).filter(|n| !n.is_empty()).collect();
        if names.is_empty() {
            Err(format!("“{text}”: expected column:NAME"))
        } else {
            Ok(Self::Columns(names))
        }
    }
}

impl GroupBy {
    /// Takes a rule that is nothing but names of columns of the manifest for those columns: a person
    /// who writes `diagnosis` beside such a manifest means no regular expression.
    #[must_use]
    pub fn with(self, manifest: &Manifest) -> Self {
        let Self::Name(Grouping::Pattern(pattern)) = &self else { return self };
        let names: Vec<String> = pattern.as_str().split(',').map(|n| n.trim().to_owned()).collect();
        if names.iter().all(|name| manifest.columns().contains(name)) { Self::Columns(names) } else { self }
    }
}

/// Densities this many times the expected one, or its part, are rare in healthy eyes: in the foveal centre, where eyes differ most,
/// Curcio et al. (1990) counted 100 000 to 324 000 per mm², 0.5 to 1.6 times their mean.
const UNLIKELY: f64 = 2.;

/// Columns of a manifest that name the person, in lower case.
const PERSON: [&str; 2] = ["subject", "subject_id"];

/// What a manifest says of one image.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::batch) struct Label {
    pub labels: Vec<String>,
    pub place: Option<RetinalPlace>,
    /// What the manifest lacks.
    pub warning: Option<String>,
}

impl Label {
    /// Puts it on a record.
    pub fn put_on(self, record: &mut MosaicRecord, warnings: &mut Vec<String>) {
        record.labels = self.labels;
        record.place = self.place;
        warnings.extend(self.warning);
        let ratio = record.density_per_mm2().zip(record.expected_cones_per_mm2()).map(|(d, e)| d / e);
        if let Some(ratio) = ratio.filter(|r| !(1. / UNLIKELY..=UNLIKELY).contains(r)) {
            warnings.push(format!(
                "its density is {} times that of the average eye at its eccentricity: check scale, eccentricity and detections",
                significant(ratio, 2)
            ));
        }
    }
}

impl Labels {
    /// Columns that the manifest adds to a summary.
    pub(in crate::batch) fn columns(&self) -> &[String] {
        self.manifest.as_ref().map_or(&[], |m| m.columns())
    }

    /// What the manifest says of an image.
    pub(in crate::batch) fn of(&self, path: &Path, scale: Option<Scale>) -> Result<Label, BatchError> {
        let Some(manifest) = &self.manifest else { return Ok(Label::default()) };
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Ok(match manifest.row_of(&name)? {
            Some(row) => {
                let um_per_degree = scale.map_or(MICROMETRES_PER_DEGREE, |s| s.micrometres_per_degree());
                Label { labels: row.labels.clone(), place: row.place(um_per_degree), warning: None }
            }
            None => Label {
                labels: vec![String::new(); manifest.columns().len()],
                place: None,
                warning: Some(format!(
                    "no row of {} has an identifier that is part of this file's name, so its columns are empty \
                     here: add a row",
                    manifest.file()
                )),
            },
        })
    }

    /// Refuses columns that the manifest does not have, before any work is done.
    pub(in crate::batch) fn validate(&self) -> Result<(), BatchError> {
        let Some(GroupBy::Columns(names)) = &self.group_by else { return Ok(()) };
        let has = self.columns();
        match (names.iter().find(|n| !has.contains(n)), &self.manifest) {
            (None, Some(_)) => Ok(()),
            (_, None) => Err(BatchError::Group("groups by column need a manifest: give one".into())),
            (Some(unknown), Some(manifest)) => Err(BatchError::Group(format!(
                "{} has no column {unknown} to group by: it has {}",
                manifest.file(),
                has.join(", ")
            ))),
        }
    }

    /// The group of an image, in words; `None` where what it is grouped by is not known.
    fn group_of(&self, name: &str, record: &MosaicRecord) -> Result<Option<String>, BatchError> {
        match &self.group_by {
            None => Ok(None),
            Some(GroupBy::Name(rule)) => rule.group_of(name).map(Some).map_err(BatchError::Group),
            Some(GroupBy::Columns(names)) => {
                let cells: Option<Vec<&str>> = names
                    .iter()
                    .map(|n| {
                        let k = self.columns().iter().position(|c| c == n)?;
                        record.labels.get(k).map(String::as_str).filter(|text| !text.is_empty())
                    })
                    .collect();
                Ok(cells.map(|cells| cells.join(", ")))
            }
        }
    }

    /// The person an image is of, by the manifest's column `subject`.
    fn person_of<'a>(&self, record: &'a MosaicRecord) -> Option<&'a str> {
        let is_person = |name: &String| PERSON.contains(&name.to_lowercase().as_str());
        let k = self.columns().iter().position(is_person)?;
        record.labels.get(k).map(String::as_str).filter(|text| !text.is_empty())
    }

    /// Writes `groups.csv`, if groups are wanted.
    pub(in crate::batch) fn write_groups(
        &self,
        out: &OutputFolder,
        summary: &Summary,
        subjects: &[(&str, Subject)],
    ) -> Result<(), BatchError> {
        if self.group_by.is_none() {
            return Ok(());
        }
        let mut groups: BTreeMap<String, Vec<GroupMember>> = BTreeMap::new();
        for (name, record) in subjects {
            if let Some(group) = self.group_of(name, record.mosaic())? {
                let person = self.person_of(record.mosaic());
                groups.entry(group).or_default().push(GroupMember { record: *record, person });
            }
        }
        out.write(GROUPS.file, &groups_csv(summary, &groups)?)
    }
}
