use super::OutputFolder;
use crate::batch::BatchError;
use crate::report::Cell;
use crate::report::tables::FAILURES;
use serde::Serialize;

/// A file that could not be worked on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Failure {
    /// Path as given.
    pub file: String,
    /// Name that its results would have had.
    pub name: String,
    /// Why, in one line.
    pub reason: String,
}

/// Lists the failures; without any there is no such table.
pub(in crate::batch) fn write_failures(out: &OutputFolder, failures: &[Failure]) -> Result<(), BatchError> {
    if failures.is_empty() {
        return Ok(());
    }
    let rows: Vec<Vec<Cell>> =
        failures.iter().map(|f| vec![f.file.as_str().into(), f.reason.as_str().into()]).collect();
    out.write_described(&FAILURES, &rows)
}
