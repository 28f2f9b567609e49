use crate::batch::BatchError;

/// A listener that is told about the progress of a batch and may stop it. The methods are called
/// from several threads.
pub trait Progress: Sync {
    /// Announces that the work on `total` files begins.
    fn begin(&self, total: usize);
    /// Reports that one file is done. `outcome` is a line about the result, or the reason why the
    /// file failed.
    fn done(&self, name: &str, outcome: Result<&str, &str>);
    /// Reports that the batch has ended.
    fn end(&self);

    /// Returns whether the batch is to stop. If so, files in progress are finished and no other is
    /// begun.
    fn stopped(&self) -> bool {
        false
    }

    /// Returns the text of an error. A command line may override this method to name those of its
    /// options that help.
    fn words(&self, error: &BatchError) -> String {
        error.to_string()
    }
}

/// A listener that ignores every report.
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _total: usize) {}
    fn done(&self, _name: &str, _outcome: Result<&str, &str>) {}
    fn end(&self) {}
}
