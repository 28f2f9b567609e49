//! The result folder: locked while a command writes into it, and the results of one run when that
//! is done.

use super::Ending;
use super::folder::OutputFolder;
use super::ledger::{Ledger, Leftovers, OWN, Standing};
use crate::batch::BatchError;
use std::fs::{self, File, TryLockError};
use std::io;
use std::ops::Deref;
use std::path::Path;
use std::sync::Arc;

/// Name of the lock file, in the program's own folder.
const LOCK: &str = "lock";

/// A result folder, into which only one command at a time can write.
///
/// The lock belongs to the operating system: it ends with the process, however that ends.
pub(in crate::batch) struct ResultFolder {
    folder: OutputFolder,
    ledger: Arc<Ledger>,
    _lock: File,
}

impl ResultFolder {
    /// Makes the folder if it is missing, locks it and reads its ledger.
    ///
    /// # Errors
    /// If the folder cannot be written to, or another command is writing into it.
    pub fn open(path: &Path) -> Result<Self, BatchError> {
        let refused = |source: io::Error| BatchError::Output { path: path.to_owned(), source };
        let own = path.join(OWN);
        fs::create_dir_all(&own).map_err(refused)?;
        let lock = File::create(own.join(LOCK)).map_err(refused)?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(BatchError::Busy { path: path.to_owned() }),
            // some network drives know no locks: results without a lock are better than none
            Err(TryLockError::Error(error)) => {
                tracing::warn!(
                    "{} cannot be locked ({error}): make sure that no other command writes into it",
                    path.display()
                );
            }
        }
        probe(path).map_err(refused)?;
        let ledger = Arc::new(Ledger::open(path)?);
        let folder = OutputFolder::new(path, "", &ledger);
        folder.sweep();
        Ok(Self { folder, ledger, _lock: lock })
    }

    /// Returns how the file of this path compares with the one that the program wrote there.
    pub fn standing(&self, name: &str) -> Standing {
        self.ledger.standing(name)
    }

    /// Returns whether the program has ever written a file of this path.
    pub fn knows(&self, name: &str) -> bool {
        self.ledger.knows(name)
    }

    /// Returns whether every file that the program has written below `prefix`, except those in
    /// `aside`, is as it was written; `false` if there is none.
    pub fn is_whole(&self, prefix: &str, aside: &[&str]) -> bool {
        self.ledger.is_whole(prefix, aside)
    }

    /// Copies a file that is about to be replaced to the folder of earlier results.
    ///
    /// # Errors
    /// If the file cannot be copied.
    pub fn copy_away(&self, name: &str) -> Result<(), BatchError> {
        self.ledger.copy_away(name)
    }

    /// Counts the earlier files whose paths begin with `prefix` among the results of this run.
    pub fn keep(&self, prefix: &str) {
        self.ledger.keep(prefix);
    }

    /// Ends a run and returns what is left over from earlier ones.
    ///
    /// If the run was stopped, with files `left` to do, everything stays where it is, the marker of
    /// an incomplete folder included. Otherwise results of earlier runs that do not belong to this
    /// one are put away.
    ///
    /// # Errors
    /// If the folder cannot be written to.
    pub fn close(self, left: usize) -> Result<Ending, BatchError> {
        let leftovers = if left > 0 { Leftovers::default() } else { self.ledger.close()? };
        Ok(Ending { left, leftovers })
    }
}

impl Deref for ResultFolder {
    type Target = OutputFolder;

    fn deref(&self) -> &OutputFolder {
        &self.folder
    }
}

/// Writes a file and removes it. Permissions alone do not tell whether a folder can be written to:
/// the file system may be read-only or a quota used up.
fn probe(folder: &Path) -> io::Result<()> {
    let probe = folder.join(format!(".conemosaic-{}", std::process::id()));
    fs::write(&probe, b"")?;
    fs::remove_file(&probe)
}
