//! The ledger of a result folder: which files the program wrote there, with their SHA-256.
//!
//! It tells the program's own files from those of a person, notices files that were truncated or
//! edited, and names what earlier runs left behind. `.conemosaic/files.sha256` has one line per
//! file, in the format of `sha256sum`. While a command works, lines are appended *before* their
//! file takes its name, so that a killed run leaves no file that the ledger does not know; at the
//! end the list is written anew, sorted. `run.json` is not listed: it holds times, and the rest of
//! the folder is to be the same bytes for the same input.

use crate::batch::BatchError;
use crate::files::write_atomically;
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The program's own folder inside a result folder; hidden, so that it is never taken for input.
pub(super) const OWN: &str = ".conemosaic";
const LIST: &str = "files.sha256";
/// Where results of earlier runs go that the present one does not replace.
const EARLIER: &str = "earlier";
/// Stands in a folder whose tables may not belong together yet.
const MARKER: &str = "INCOMPLETE.txt";
/// Holds times, so that its bytes are never the same.
const VOLATILE: &str = "run.json";

const MARKER_TEXT: &str = "\
conemosaic is writing results into this folder, or was cut off while it did.
Until this file is gone, tables here may belong to an earlier run.
To finish, run the same command again: what is done is kept.
";

/// Files of a result folder that do not belong to the run that has just ended.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Leftovers {
    /// Results of earlier runs that were moved to [`Self::place`], by their path in the folder.
    pub moved: Vec<String>,
    /// Where they are now.
    pub place: PathBuf,
    /// Files that a person made or changed, which stay where they are.
    pub foreign: Vec<String>,
}

/// How a file on the disk compares with what the program wrote under its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::batch) enum Standing {
    /// There is no such file.
    Missing,
    /// As the program wrote it.
    Own,
    /// Changed since, or never written by the program.
    Changed,
}

/// See the file's head.
pub(super) struct Ledger {
    root: PathBuf,
    /// SHA-256 by path, of earlier runs; several where a run was cut off.
    earlier: BTreeMap<String, BTreeSet<String>>,
    now: Mutex<Now>,
}

#[derive(Default)]
struct Now {
    journal: Option<File>,
    written: BTreeMap<String, String>,
    /// Beginnings of paths whose files of earlier runs still hold.
    kept: BTreeSet<String>,
}

impl Ledger {
    /// Reads the ledger of the folder `root`; an empty one where there is none.
    pub fn open(root: &Path) -> Result<Self, BatchError> {
        let path = root.join(OWN).join(LIST);
        let text = match fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
            Err(source) => return Err(BatchError::Output { path, source }),
        };
        let mut earlier: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        // a line that a loss of power cut off names no file
        for (hash, name) in text.lines().filter_map(|line| line.split_once("  ")) {
            earlier.entry(name.to_owned()).or_default().insert(hash.to_owned());
        }
        Ok(Self { root: root.to_owned(), earlier, now: Mutex::default() })
    }

    fn now(&self) -> MutexGuard<'_, Now> {
        self.now.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Notes that `bytes` are about to be written under `name`, and marks the folder as in work.
    pub fn note(&self, name: &str, bytes: &[u8]) -> Result<(), BatchError> {
        let hash = hex(&Sha256::digest(bytes));
        let path = self.root.join(OWN).join(LIST);
        let refused = |source| BatchError::Output { path: path.clone(), source };
        let mut now = self.now();
        if now.journal.is_none() {
            let marker = self.root.join(MARKER);
            write_atomically(&marker, |writer| writer.write_all(MARKER_TEXT.as_bytes()))
                .map_err(|source| BatchError::Output { path: marker, source })?;
            let opened = OpenOptions::new().append(true).create(true).open(&path);
            now.journal = Some(opened.map_err(refused)?);
        }
        if let Some(journal) = now.journal.as_mut().filter(|_| name != VOLATILE) {
            journal.write_all(format!("{hash}  {name}\n").as_bytes()).map_err(refused)?;
        }
        now.written.insert(name.to_owned(), hash);
        Ok(())
    }

    /// Takes back a note of a file that was not written after all.
    pub fn forget(&self, prefix: &str) {
        self.now().written.retain(|name, _| !name.starts_with(prefix));
    }

    /// Counts earlier files whose paths begin with `prefix` among the results of this run.
    pub fn keep(&self, prefix: &str) {
        self.now().kept.insert(prefix.to_owned());
    }

    /// Tells how the file `name` compares with what the program wrote, now or earlier.
    pub fn standing(&self, name: &str) -> Standing {
        let Ok(bytes) = fs::read(self.root.join(name)) else { return Standing::Missing };
        let hash = hex(&Sha256::digest(bytes));
        let own = name == VOLATILE
            || self.earlier.get(name).is_some_and(|known| known.contains(&hash))
            || self.now().written.get(name) == Some(&hash);
        if own { Standing::Own } else { Standing::Changed }
    }

    /// Tells whether the program has ever written a file of that name.
    pub fn knows(&self, name: &str) -> bool {
        self.earlier.contains_key(name) || self.now().written.contains_key(name)
    }

    /// Tells whether the program has ever written a file whose path begins with `prefix`.
    pub fn knows_below(&self, prefix: &str) -> bool {
        self.earlier.keys().any(|name| name.starts_with(prefix))
            || self.now().written.keys().any(|name| name.starts_with(prefix))
    }

    /// Returns the result folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Puts a file or folder of earlier results away, into a place of its own.
    pub fn put_away(&self, name: &str) -> Result<(), BatchError> {
        let from = self.root.join(name);
        let to = self.free_place(name)?;
        fs::rename(&from, &to).map_err(|source| BatchError::Output { path: to, source })?;
        // a folder that is empty now goes too; one that is not stays
        match from.parent() {
            Some(parent) if parent != self.root => fs::remove_dir(parent).or(Ok(())),
            _ => Ok(()),
        }
    }

    /// Puts a copy of a file of earlier results away.
    pub fn copy_away(&self, name: &str) -> Result<(), BatchError> {
        let to = self.free_place(name)?;
        fs::copy(self.root.join(name), &to)
            .map(drop)
            .map_err(|source| BatchError::Output { path: to, source })
    }

    /// Finds a free place for earlier results of that name, and makes its folder.
    fn free_place(&self, name: &str) -> Result<PathBuf, BatchError> {
        let place = self.root.join(OWN).join(EARLIER);
        let refused = |source| BatchError::Output { path: place.clone(), source };
        let free = (1..).map(|k| if k == 1 { name.to_owned() } else { format!("{name}.{k}") });
        let Some(to) = free.map(|n| place.join(n)).find(|p| p.symlink_metadata().is_err()) else {
            return Err(refused(io::ErrorKind::AlreadyExists.into()));
        };
        let parent = to.parent().unwrap_or(&place);
        fs::create_dir_all(parent).map_err(refused)?;
        Ok(to)
    }

    /// Ends a run that worked through all its input: puts the results of earlier runs away that it
    /// neither replaced nor kept, writes the list anew and takes the marker off.
    pub fn close(&self) -> Result<Leftovers, BatchError> {
        let mut left = Leftovers { place: self.root.join(OWN).join(EARLIER), ..Leftovers::default() };
        let (written, kept) = {
            let now = self.now();
            (now.written.clone(), now.kept.clone())
        };
        let holds = |name: &str| kept.iter().any(|prefix| name.starts_with(prefix.as_str()));
        let mut list = written.clone();
        for (name, hashes) in self.earlier.iter().filter(|(name, _)| !written.contains_key(*name)) {
            match self.standing(name) {
                Standing::Missing => {}
                Standing::Own if holds(name) => {
                    let current = fs::read(self.root.join(name)).map(|b| hex(&Sha256::digest(b)));
                    if let Some(hash) = current.ok().or_else(|| hashes.first().cloned()) {
                        list.insert(name.clone(), hash);
                    }
                }
                Standing::Own => {
                    self.put_away(name)?;
                    left.moved.push(name.clone());
                }
                Standing::Changed if holds(name) => {
                    list.extend(hashes.first().map(|hash| (name.clone(), hash.clone())));
                }
                Standing::Changed => left.foreign.push(name.clone()),
            }
        }
        list.remove(VOLATILE);
        let lines: String = list.iter().map(|(name, hash)| format!("{hash}  {name}\n")).collect();
        let path = self.root.join(OWN).join(LIST);
        write_atomically(&path, |writer| writer.write_all(lines.as_bytes()))
            .map_err(|source| BatchError::Output { path, source })?;
        let marker = self.root.join(MARKER);
        match fs::remove_file(&marker) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => {
                Err(BatchError::Output { path: marker, source })
            }
            _ => Ok(left),
        }
    }
}

/// Writes bytes as lower-case hexadecimal digits.
pub(in crate::batch) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}
