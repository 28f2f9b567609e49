use crate::batch::output::OutputFolder;
use crate::batch::{BatchError, Grouping};
use crate::image::Modality;
use crate::mosaic::io::Manifest;
use crate::mosaic::{MICROMETRES_PER_DEGREE, RetinalPlace, Scale};
use crate::report::tables::{GROUPS, GroupMember, groups_csv};
use crate::report::{MosaicRecord, Subject, Summary, significant};
use std::collections::BTreeMap;
use std::path::Path;
use std::str::FromStr;

/// Facts about images that cannot be read from the image itself, and the rule by which images form
/// groups.
#[derive(Clone, Debug, Default)]
pub struct Labels {
    /// The manifest: a table with one row per image, which states for example the subject and the
    /// location on the retina.
    pub manifest: Option<Manifest>,
    /// The rule by which images form groups. `None` if no means over groups are wanted.
    pub group_by: Option<GroupBy>,
}

/// The rule by which images form groups.
#[derive(Clone, Debug)]
pub enum GroupBy {
    /// Images form a group if they have the same text in all of these columns of the manifest.
    Columns(Vec<String>),
    /// Images form a group if this rule derives the same group name from their names.
    Name(Grouping),
}

impl FromStr for GroupBy {
    type Err = String;

    /// Reads `column:NAME[,NAME…]` as [`GroupBy::Columns`] and any other text as a [`Grouping`].
    fn from_str(text: &str) -> Result<Self, String> {
        let Some(names) = text.strip_prefix("column:") else { return text.parse().map(Self::Name) };
        let names: Vec<String> =
            names.split(',').map(|n| n.trim().to_owned()).filter(|n| !n.is_empty()).collect();
        if names.is_empty() {
            Err(format!("“{text}” does not name a column: expected column:NAME"))
        } else {
            Ok(Self::Columns(names))
        }
    }
}

impl GroupBy {
    /// Turns a regular expression into names of columns if its text, split at commas, consists of
    /// names of columns of the manifest.
    ///
    /// For example, someone who writes `diagnosis` and has a manifest with a column of that name
    /// means the column.
    #[must_use]
    pub fn with(self, manifest: &Manifest) -> Self {
        let Self::Name(Grouping::Pattern(pattern)) = &self else { return self };
        let names: Vec<String> = pattern.as_str().split(',').map(|n| n.trim().to_owned()).collect();
        if names.iter().all(|name| manifest.columns().contains(name)) { Self::Columns(names) } else { self }
    }
}

/// Largest ratio, either way, between a likely density and the expected density: a density that is
/// more than twice or less than half the expected one causes a warning.
///
/// In the foveal centre, where eyes differ most, Curcio et al. (1990,
/// <https://doi.org/10.1002/cne.902920402>) counted 100 000 to 324 000 cones per mm² in healthy
/// eyes: 0.5 to 1.6 times their mean.
const UNLIKELY: f64 = 2.;

/// Names, in lower case, of columns of a manifest that identify the person.
const PERSON: [&str; 2] = ["subject", "subject_id"];

/// Facts that a manifest states about one image.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::batch) struct Label {
    /// Text in each column of the manifest, in the order of the columns; all texts are empty if no
    /// row fits the image.
    pub labels: Vec<String>,
    /// Location on the retina; `None` if the manifest does not state it.
    pub place: Option<RetinalPlace>,
    /// Warning that the manifest has no row for the image; `None` if it has one.
    pub warning: Option<String>,
}

impl Label {
    /// Adds the facts to the record of an image. Also adds warnings if the image has no row, or if
    /// its density is unlikely at its location on the retina.
    pub fn put_on(self, record: &mut MosaicRecord, warnings: &mut Vec<String>) {
        record.labels = self.labels;
        record.place = self.place;
        warnings.extend(self.warning);
        let ratio = record.density_per_mm2().zip(record.expected_cones_per_mm2()).map(|(d, e)| d / e);
        if let Some(ratio) = ratio.filter(|r| !(1. / UNLIKELY..=UNLIKELY).contains(r)) {
            warnings.push(format!(
                "the density is {} times that of the average eye at this eccentricity: check the scale, \
                 the eccentricity and the detections",
                significant(ratio, 2)
            ));
        }
    }
}

impl Labels {
    /// Returns the names of the columns that the manifest adds to a summary; empty without a
    /// manifest.
    pub(in crate::batch) fn columns(&self) -> &[String] {
        self.manifest.as_ref().map_or(&[], |m| m.columns())
    }

    /// Returns the facts that the manifest states about an image.
    ///
    /// Eccentricities in degrees are converted to lengths by `scale`, or as for the average eye if
    /// there is no scale.
    ///
    /// # Errors
    /// Fails if several rows of the manifest fit the name equally well.
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
                    "no row of {} matches the name of this image, so its labels, eccentricity and expected \
                     density stay empty: add a row for it",
                    manifest.file()
                )),
            },
        })
    }

    /// Returns the text in a column of the manifest for an image; `None` if there is none. The case
    /// of the column's name does not matter.
    fn cell(&self, path: &Path, column: &str) -> Option<&str> {
        let manifest = self.manifest.as_ref()?;
        let k = manifest.columns().iter().position(|c| c.eq_ignore_ascii_case(column))?;
        let row = manifest.row_of(&path.file_name()?.to_string_lossy()).ok()??;
        row.labels.get(k).map(|text| text.trim()).filter(|text| !text.is_empty())
    }

    /// Returns the modality that the column `modality` of the manifest states for an image; `None`
    /// if it states none, or “auto”.
    ///
    /// # Errors
    /// Fails if the cell names no modality.
    pub(in crate::batch) fn modality_of(&self, path: &Path) -> Result<Option<Modality>, BatchError> {
        let Some(text) = self.cell(path, "modality").filter(|t| !t.eq_ignore_ascii_case("auto")) else {
            return Ok(None);
        };
        text.to_lowercase().parse().map(Some).map_err(|_| BatchError::Pairing {
            file: path.to_owned(),
            problem: format!(
                "the column “modality” of the manifest says “{text}”: expected confocal, split, histology, \
                 auto or nothing (give a column with other words another name)"
            ),
        })
    }

    /// Returns the identifier of the pair of channels to which the column `pair` of the manifest
    /// assigns an image; `None` if it assigns none.
    pub(in crate::batch) fn pair_of(&self, path: &Path) -> Option<String> {
        self.cell(path, "pair").map(str::to_owned)
    }

    /// Returns whether the manifest has a column `pair`.
    pub(in crate::batch) fn has_pairs(&self) -> bool {
        self.columns().iter().any(|c| c.eq_ignore_ascii_case("pair"))
    }

    /// Checks, before any work is done, that the manifest has all columns to group by.
    pub(in crate::batch) fn validate(&self) -> Result<(), BatchError> {
        let Some(GroupBy::Columns(names)) = &self.group_by else { return Ok(()) };
        let has = self.columns();
        match (names.iter().find(|n| !has.contains(n)), &self.manifest) {
            (None, Some(_)) => Ok(()),
            (_, None) => Err(BatchError::Group("grouping by column needs a manifest: give one".into())),
            (Some(unknown), Some(manifest)) => Err(BatchError::Group(format!(
                "{} has no column {unknown} to group by: choose from {}",
                manifest.file(),
                has.join(", ")
            ))),
        }
    }

    /// Returns the name of the group of an image; `None` if no groups are wanted, or if a cell that
    /// the group needs is empty.
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

    /// Returns the person to whom an image belongs, from the column `subject` or `subject_id` of
    /// the manifest; `None` if there is no such column or its cell is empty.
    fn person_of<'a>(&self, record: &'a MosaicRecord) -> Option<&'a str> {
        let is_person = |name: &String| PERSON.contains(&name.to_lowercase().as_str());
        let k = self.columns().iter().position(is_person)?;
        record.labels.get(k).map(String::as_str).filter(|text| !text.is_empty())
    }

    /// Writes `groups.csv`, one row per group; nothing is written if no groups are wanted.
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
