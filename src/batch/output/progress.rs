use crate::batch::BatchError;

/// A listener that hears how a batch goes on and may stop it. Its methods are called from several
/// threads.
pub trait Progress: Sync {
    /// Announces that `total` files are going to be worked on.
    fn begin(&self, total: usize);
    /// Reports that one file is done, with a line about its result or the reason why it failed.
    fn done(&self, name: &str, outcome: Result<&str, &str>);
    /// Reports that the batch has ended.
    fn end(&self);

    /// Returns whether the batch is to stop: files in hand are finished, no other is begun.
    fn stopped(&self) -> bool {
        false
    }

    /// Puts an error into words. A command line may add which of its options help.
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
