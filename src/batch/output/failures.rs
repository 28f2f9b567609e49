use super::OutputFolder;
use crate::batch::BatchError;
pub use crate::report::Failure;
use crate::report::tables::FAILURES;

/// Writes `failures.csv`, one row per failure. Nothing is written if nothing failed.
pub(in crate::batch) fn write_failures(out: &OutputFolder, failures: &[Failure]) -> Result<(), BatchError> {
    if failures.is_empty() {
        return Ok(());
    }
    out.write(FAILURES.file, &FAILURES.csv(failures)?)
}
