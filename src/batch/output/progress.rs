use crate::batch::BatchError;

/// Hears how a batch goes on, and may stop it. Called from several threads.
pub trait Progress: Sync {
    /// `total` files are going to be worked on.
    fn begin(&self, total: usize);
    /// One is done: a line about it, or why it failed.
    fn done(&self, name: &str, outcome: Result<&str, &str>);
    /// All are.
    fn end(&self);

    /// Asks whether the batch is to stop: files in hand are finished, no other is begun.
    fn stopped(&self) -> bool {
        false
    }

    /// Puts an error into words; a command line adds which options help.
    fn words(&self, error: &BatchError) -> String {
        error.to_string()
    }
}

/// Listens to nothing.
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _total: usize) {}
    fn done(&self, _name: &str, _outcome: Result<&str, &str>) {}
    fn end(&self) {}
}
