//! A folder of results: locked while a command writes into it, and of one run when it is done.

use super::Ending;
use super::folder::OutputFolder;
use super::ledger::{Ledger, Leftovers, OWN, Standing};
use crate::batch::BatchError;
use std::fs::{self, File, TryLockError};
use std::io;
use std::ops::Deref;
use std::path::Path;
use std::sync::Arc;

const LOCK: &str = "lock";

/// A folder that one command at a time writes its results into.
///
/// The lock is the operating system's: it ends with the process, however that ends.
pub(in crate::batch) struct ResultFolder {
    folder: OutputFolder,
    ledger: Arc<Ledger>,
    _lock: File,
}

impl ResultFolder {
    /// Makes the folder where it is missing, locks it and reads its ledger.
    ///
    /// # Errors
    /// If it cannot be written to, or another command is writing into it.
    pub fn open(path: &Path) -> Result<Self, BatchError> {
        let refused = |source: io::Error| BatchError::Output { path: path.to_owned(), source };
        let own = path.join(OWN);
        fs::create_dir_all(&own).map_err(refused)?;
        let lock = File::create(own.join(LOCK)).map_err(refused)?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(BatchError::Busy { path: path.to_owned() }),
            // some network drives have no locks: better results without one than none
            Err(TryLockError::Error(error)) => {
                tracing::warn!("no lock on {}: {error}", path.display());
            }
        }
        probe(path).map_err(refused)?;
        let ledger = Arc::new(Ledger::open(path)?);
        let folder = OutputFolder::new(path, "", &ledger);
        folder.sweep();
        Ok(Self { folder, ledger, _lock: lock })
    }

    /// Tells how the file of this path compares with what the program wrote there.
    pub fn standing(&self, name: &str) -> Standing {
        self.ledger.standing(name)
    }

    /// Tells whether the program has ever written a file of this path.
    pub fn knows(&self, name: &str) -> bool {
        self.ledger.knows(name)
    }

    /// Tells whether all files that the program has written below `prefix` are as it wrote them, but
    /// for those in `aside`; not where there are none.
    pub fn is_whole(&self, prefix: &str, aside: &[&str]) -> bool {
        self.ledger.is_whole(prefix, aside)
    }

    /// Puts a copy of a file away that is about to be replaced.
    ///
    /// # Errors
    /// If it cannot be copied.
    pub fn copy_away(&self, name: &str) -> Result<(), BatchError> {
        self.ledger.copy_away(name)
    }

    /// Counts the earlier files whose paths begin with `prefix` among the results of this run.
    pub fn keep(&self, prefix: &str) {
        self.ledger.keep(prefix);
    }

    /// Ends a run. One that was stopped, with files `left` to do, leaves everything where it is,
    /// with the marker; otherwise results of earlier runs that do not belong to this one are put
    /// away.
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

/// Writes a file and removes it: permissions alone do not tell (read-only file systems, quotas).
fn probe(folder: &Path) -> io::Result<()> {
    let probe = folder.join(format!(".conemosaic-{}", std::process::id()));
    fs::write(&probe, b"")?;
    fs::remove_file(&probe)
}
