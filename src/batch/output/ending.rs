use super::Leftovers;

/// The end of the work on a batch.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ending {
    /// Number of files that were not begun because the batch was stopped; 0 if it ran to its end.
    pub left: usize,
    /// Files in the result folder that do not belong to this batch.
    pub leftovers: Leftovers,
}

impl Ending {
    /// Returns whether the batch was stopped before its end.
    pub const fn stopped(&self) -> bool {
        self.left > 0
    }
}
