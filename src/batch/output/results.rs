//! The result folder, which is locked while a command writes into it.

use super::Ending;
use super::folder::OutputFolder;
use super::ledger::{Ledger, Leftovers, OWN, Standing};
use crate::batch::BatchError;
use std::fs::{self, File, TryLockError};
use std::io;
use std::ops::Deref;
use std::path::Path;
use std::sync::Arc;

/// Name of the lock file, inside [`OWN`].
const LOCK: &str = "lock";

/// A result folder, into which only one command at a time can write.
///
/// The lock belongs to the operating system: it ends with the process, however the process ends.
pub(in crate::batch) struct ResultFolder {
    /// The result folder itself, as a folder to write into.
    folder: OutputFolder,
    /// The ledger of the result folder.
    ledger: Arc<Ledger>,
    /// The lock file. The lock ends when this file is closed.
    _lock: File,
}

impl ResultFolder {
    /// Creates the folder if it is missing, locks it, reads its ledger and tidies up after a run
    /// that was killed.
    ///
    /// # Errors
    /// Fails if the folder cannot be written to, or another command is writing into it.
    pub fn open(path: &Path) -> Result<Self, BatchError> {
        let refused = |source: io::Error| BatchError::Output { path: path.to_owned(), source };
        let own = path.join(OWN);
        fs::create_dir_all(&own).map_err(refused)?;
        let lock = File::create(own.join(LOCK)).map_err(refused)?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(BatchError::Busy { path: path.to_owned() }),
            // some network drives have no locks: results without a lock are better than none
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

    /// Compares the file `name` with what the program wrote under that name, in this or an earlier
    /// run: the file is missing, unchanged, or changed by a person.
    pub fn standing(&self, name: &str) -> Standing {
        self.ledger.standing(name)
    }

    /// Returns whether the program has written a file called `name`, in this or an earlier run.
    pub fn knows(&self, name: &str) -> bool {
        self.ledger.knows(name)
    }

    /// Returns whether all files that earlier runs wrote into a folder are there and unchanged.
    ///
    /// `prefix` is the path of the folder inside the result folder, ending in a slash. `aside`
    /// contains the names of files in the folder that are not checked. Returns `false` if earlier
    /// runs wrote no file into the folder.
    pub fn is_whole(&self, prefix: &str, aside: &[&str]) -> bool {
        self.ledger.is_whole(prefix, aside)
    }

    /// Copies a file that is about to be replaced to the folder of earlier results.
    ///
    /// # Errors
    /// Fails if the file cannot be copied.
    pub fn copy_away(&self, name: &str) -> Result<(), BatchError> {
        self.ledger.copy_away(name)
    }

    /// Counts the files of earlier runs whose paths begin with `prefix` among the results of this
    /// run, so that [`Self::close`] leaves them in place.
    pub fn keep(&self, prefix: &str) {
        self.ledger.keep(prefix);
    }

    /// Ends a run and returns the files that are left over from earlier runs.
    ///
    /// `left` is the number of input files that were not begun because the run was stopped. If it
    /// is not 0, every file stays where it is, and the folder stays marked as incomplete. If it is
    /// 0, results of earlier runs that do not belong to this run are moved to the folder of earlier
    /// results.
    ///
    /// # Errors
    /// Fails if the folder cannot be written to.
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

/// Checks that a folder can be written to, by writing and removing a file. Permissions alone do not
/// tell: the file system may be read-only or a quota used up.
fn probe(folder: &Path) -> io::Result<()> {
    let probe = folder.join(format!(".conemosaic-{}", std::process::id()));
    fs::write(&probe, b"")?;
    fs::remove_file(&probe)
}
