/// Hears how a batch goes on. Called from several threads.
pub trait Progress: Sync {
    /// `total` files are going to be worked on.
    fn begin(&self, total: usize);
    /// One is done: a line about it, or why it failed.
    fn done(&self, name: &str, outcome: Result<&str, &str>);
    /// All are.
    fn end(&self);
}

/// Nobody is listening.
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _total: usize) {}
    fn done(&self, _name: &str, _outcome: Result<&str, &str>) {}
    fn end(&self) {}
}
