//! The columns of every table that is written beside `summary.csv`: what each is and in which unit. Their headers and the
//! data dictionary come from here, those of series that the program makes as it goes are held to it by tests.

mod agreement;
mod batch;
mod comparison;
mod functions;
mod maps;
mod points;
mod validation;

pub use agreement::{AGREEMENT, DIFFERENCES, UNPAIRED};
pub use batch::{FAILURES, GROUPS, ROIS};
pub use comparison::{ENVELOPE, FINDING, L_INFINITY, REGULARITY, VERDICTS};
pub use functions::{DENSITY_RECOVERY, FUNCTIONS, PCF, SPECTRUM};
pub use maps::{FOURIER_MAP, LANDMARKS, MAPS, PROFILES};
pub use points::{DETECTIONS, POINTS};
pub use validation::{COMPARISON, FROC, RELIABILITY, SUBJECT_GROUPS, VALIDATION};

/// A table beside the summary.
pub struct OutputTable {
    /// Name of the file; `NAME` stands for that of an image or file of coordinates.
    pub file: &'static str,
    /// Which commands write it.
    pub commands: &'static str,
    /// What a row is, the edge rule, whose definition it is.
    pub about: &'static str,
    /// Its columns. In names, `SAMPLER` stands for that of each sampler.
    pub columns: &'static [TableColumn],
}

/// A column of a table.
pub struct TableColumn {
    /// As in the header.
    pub name: &'static str,
    /// Its unit; “unit” is that of the coordinates.
    pub unit: &'static str,
    /// What it is; when it is not defined.
    pub definition: &'static str,
}

const fn column(name: &'static str, unit: &'static str, definition: &'static str) -> TableColumn {
    TableColumn { name, unit, definition }
}

impl OutputTable {
    /// Names of the columns, those of `SAMPLER` once a sampler.
    pub fn header_of(&self, samplers: &[String]) -> Vec<String> {
        let names = |c: &TableColumn| match c.name.contains("SAMPLER") {
            true => samplers.iter().map(|s| c.name.replace("SAMPLER", s)).collect(),
            false => vec![c.name.to_owned()],
        };
        self.columns.iter().flat_map(names).collect()
    }

    /// Names of the columns.
    pub fn header(&self) -> Vec<String> {
        self.columns.iter().map(|c| c.name.to_owned()).collect()
    }
}

/// All of them, in the order in which a user meets them.
pub static TABLES: [&OutputTable; 26] = [
    &DETECTIONS,
    &PCF,
    &POINTS,
    &FUNCTIONS,
    &DENSITY_RECOVERY,
    &SPECTRUM,
    &MAPS,
    &PROFILES,
    &FOURIER_MAP,
    &LANDMARKS,
    &ROIS,
    &GROUPS,
    &FAILURES,
    &VERDICTS,
    &ENVELOPE,
    &REGULARITY,
    &L_INFINITY,
    &FINDING,
    &VALIDATION,
    &SUBJECT_GROUPS,
    &FROC,
    &RELIABILITY,
    &COMPARISON,
    &AGREEMENT,
    &DIFFERENCES,
    &UNPAIRED,
];
