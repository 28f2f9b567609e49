use super::BatchError;
use super::outputs::OutputFolder;
use crate::report::Cell;
use serde::Serialize;

const FILE: &str = "failures.csv";

/// A file that could not be worked on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Failure {
    /// Path as given.
    pub file: String,
    /// Why, in one line.
    pub reason: String,
}

/// Lists the failures; without any, a list of an earlier batch goes.
pub(super) fn write_failures(out: &OutputFolder, failures: &[Failure]) -> Result<(), BatchError> {
    if failures.is_empty() {
        return out.remove(FILE);
    }
    let rows: Vec<Vec<Cell>> =
        failures.iter().map(|f| vec![f.file.as_str().into(), f.reason.as_str().into()]).collect();
    out.write_table(FILE, &["file".into(), "reason".into()], &rows)
}
