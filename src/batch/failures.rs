use super::BatchError;
use super::outputs::OutputFolder;
use crate::report::Cell;
use crate::report::tables::FAILURES;
use serde::Serialize;

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
        return out.remove(FAILURES.file);
    }
    let rows: Vec<Vec<Cell>> =
        failures.iter().map(|f| vec![f.file.as_str().into(), f.reason.as_str().into()]).collect();
    out.write_described(&FAILURES, &rows)
}
