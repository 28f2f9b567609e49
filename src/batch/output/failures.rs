use super::OutputFolder;
use crate::batch::BatchError;
pub use crate::report::Failure;
use crate::report::tables::FAILURES;

/// Lists the failures; without any there is no such table.
pub(in crate::batch) fn write_failures(out: &OutputFolder, failures: &[Failure]) -> Result<(), BatchError> {
    if failures.is_empty() {
        return Ok(());
    }
    out.write(FAILURES.file, &FAILURES.csv(failures)?)
}
