use super::BatchError;
use super::outputs::OutputFolder;
pub use crate::report::Failure;
use crate::report::tables::FAILURES;

/// Lists the failures; without any, a list of an earlier batch goes.
pub(super) fn write_failures(out: &OutputFolder, failures: &[Failure]) -> Result<(), BatchError> {
    if failures.is_empty() {
        return out.remove(FAILURES.file);
    }
    out.write(FAILURES.file, &FAILURES.csv(failures)?)
}
