use super::Leftovers;

/// Way in which the work on a batch ended.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ending {
    /// Number of files that were not begun because the batch was stopped; 0 if the batch is
    /// complete.
    pub left: usize,
    /// Files in the result folder that are no results of this batch.
    pub leftovers: Leftovers,
}

impl Ending {
    /// Returns whether the batch was stopped before all files were begun.
    pub const fn stopped(&self) -> bool {
        self.left > 0
    }
}
