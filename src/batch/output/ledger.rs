//! The ledger of a result folder: the list of all files that the program wrote there, each with its
//! SHA-256.
//!
//! The ledger tells the program's own files from those of a person, reveals files that were
//! truncated or edited, and names the files that earlier runs left behind.
//!
//! The list is `.conemosaic/files.sha256`, with one line per file, in the format of `sha256sum`.
//! While a command works, it appends each line *before* the file gets its name, so that a killed
//! run leaves no file that the ledger does not know. At the end the list is written again, sorted.
//! `run.json` is not listed. It contains times and differs in every run, while everything else in
//! the folder, the list included, must have the same bytes for the same input.

use crate::batch::BatchError;
use crate::files::write_atomically;
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::ops::Bound;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Name of the program's own folder inside a result folder. It is hidden, so that it is never taken
/// for input.
pub(super) const OWN: &str = ".conemosaic";
/// Name of the list of files, inside [`OWN`].
const LIST: &str = "files.sha256";
/// Folder inside [`OWN`] for results of earlier runs that the current run has not written again.
const EARLIER: &str = "earlier";
/// File that marks a result folder as incomplete. It exists while results are being written, and
/// stays after a run that was stopped or killed. The tables in the folder may then come from
/// different runs.
const MARKER: &str = "INCOMPLETE.txt";
/// File that is not in the list, because it contains times and so differs in every run.
const VOLATILE: &str = "run.json";

/// Content of the file [`MARKER`], addressed to a person who opens the folder too early.
const MARKER_TEXT: &str = "\
conemosaic is writing results into this folder, or was interrupted while it did so.
As long as this file is here, some tables may belong to an earlier run.
To finish, run the same command again: results that are complete are kept.
";

/// Files in a result folder that do not belong to the run that has just ended.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Leftovers {
    /// Results of earlier runs that were moved or copied to the folder [`Self::place`], as paths
    /// inside the result folder.
    pub moved: Vec<String>,
    /// Folder to which results of earlier runs were moved.
    pub place: PathBuf,
    /// Files and folders in the result folder that a person made or changed; they stay where they
    /// are.
    pub foreign: Vec<String>,
}

/// State of a file, compared with what the program wrote under its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::batch) enum Standing {
    /// There is no such file.
    Missing,
    /// The file is as the program wrote it.
    Own,
    /// The file was changed after the program wrote it, or the program never wrote a file of this
    /// name.
    Changed,
}

/// Ledger of a result folder: the list of the files that the program wrote there, with their
/// hashes. See the [module](self) for its purpose and format.
pub(super) struct Ledger {
    /// Path of the result folder.
    root: PathBuf,
    /// SHA-256 of the files that earlier runs wrote, by path. A path can have several hashes if an
    /// earlier run was stopped or killed, so that the list was not written again.
    earlier: BTreeMap<String, BTreeSet<String>>,
    /// State of the current run.
    now: Mutex<Now>,
}

/// State of the ledger in the current run.
#[derive(Default)]
struct Now {
    /// The list of files, open for appending; `None` before the first file of the run is written.
    journal: Option<File>,
    /// SHA-256 of the files that this run wrote, by path.
    written: BTreeMap<String, String>,
    /// Prefixes of paths: files of earlier runs whose path has one of these prefixes count as
    /// results of this run.
    kept: BTreeSet<String>,
    /// Paths of the files that were moved or copied to the folder of earlier results.
    moved: Vec<String>,
}

impl Ledger {
    /// Reads the ledger of the folder `root`. The ledger is empty if the folder has none.
    pub fn open(root: &Path) -> Result<Self, BatchError> {
        let path = root.join(OWN).join(LIST);
        let text = match fs::read(&path) {
            // bytes that are no text name no file; a file that only they listed then counts as a
            // person's
            Ok(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
            Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
            Err(source) => return Err(BatchError::Output { path, source }),
        };
        let mut earlier: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        // a line that a loss of power cut short lists no file
        for (hash, name) in text.split('\n').filter_map(parsed) {
            earlier.entry(name).or_default().insert(hash);
        }
        Ok(Self { root: root.to_owned(), earlier, now: Mutex::default() })
    }

    /// Locks and returns the state of the current run, even after a panic in another thread.
    fn now(&self) -> MutexGuard<'_, Now> {
        self.now.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds the file `name` to the ledger, before `bytes` are written to it. The first call of a
    /// run marks the folder as incomplete.
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
            // the line break comes first: it ends a line that a kill or a full disk cut off
            journal.write_all(format!("\n{}", line(&hash, name)).as_bytes()).map_err(refused)?;
        }
        now.written.insert(name.to_owned(), hash);
        Ok(())
    }

    /// Syncs to the disk what [`Self::note`] appended to the list. To be called before the files
    /// get their names.
    ///
    /// After a loss of power, the folder then contains no result that is missing from the ledger.
    pub fn sync(&self) -> Result<(), BatchError> {
        let refused = |source| BatchError::Output { path: self.root.join(OWN).join(LIST), source };
        self.now().journal.as_ref().map_or(Ok(()), File::sync_data).map_err(refused)
    }

    /// Forgets that this run wrote files whose paths begin with `prefix`, because these files did
    /// not get their names after all.
    pub fn forget(&self, prefix: &str) {
        self.now().written.retain(|name, _| !name.starts_with(prefix));
    }

    /// Counts files of earlier runs whose paths begin with `prefix` among the results of this run,
    /// so that [`Self::close`] leaves them in place.
    pub fn keep(&self, prefix: &str) {
        self.now().kept.insert(prefix.to_owned());
    }

    /// Returns the SHA-256 of the current content of the file `name`; `None` if the file cannot be
    /// read.
    fn current(&self, name: &str) -> Option<String> {
        fs::read(self.root.join(name)).ok().map(|bytes| hex(&Sha256::digest(bytes)))
    }

    /// Returns whether the file `name` is missing, as the program wrote it (in this or an earlier
    /// run), or changed.
    pub fn standing(&self, name: &str) -> Standing {
        match self.current(name) {
            None => Standing::Missing,
            Some(hash) if self.is_own(name, &hash) => Standing::Own,
            Some(_) => Standing::Changed,
        }
    }

    /// Returns whether the program has written a file of this name and hash, in this or an earlier
    /// run.
    fn is_own(&self, name: &str, hash: &str) -> bool {
        name == VOLATILE
            || self.earlier.get(name).is_some_and(|known| known.contains(hash))
            || self.now().written.get(name).is_some_and(|written| written == hash)
    }

    /// Returns whether writing `bytes` to the file `name` would destroy a person's work.
    pub fn would_lose(&self, name: &str, bytes: &[u8]) -> bool {
        let there = fs::read(self.root.join(name)).ok().filter(|there| there != bytes);
        there.is_some_and(|there| !self.is_own(name, &hex(&Sha256::digest(there))))
    }

    /// Returns whether the program has ever written a file of this name.
    pub fn knows(&self, name: &str) -> bool {
        self.earlier.contains_key(name) || self.now().written.contains_key(name)
    }

    /// Returns whether the program has ever written a file whose path begins with `prefix`.
    pub fn knows_below(&self, prefix: &str) -> bool {
        let from = prefix.to_owned();
        let mut earlier = self.earlier.range(from.clone()..);
        earlier.next().is_some_and(|(name, _)| name.starts_with(prefix))
            || self.now().written.range(from..).next().is_some_and(|(name, _)| name.starts_with(prefix))
    }

    /// Returns whether all files that earlier runs wrote into a folder are there and unchanged.
    ///
    /// `prefix` is the path of the folder inside the result folder, ending in a slash. `aside`
    /// contains the names of files in the folder that are not checked. Returns `false` if earlier
    /// runs wrote no file into the folder.
    pub fn is_whole(&self, prefix: &str, aside: &[&str]) -> bool {
        let below = self.earlier.range(prefix.to_owned()..).map(|(name, _)| name);
        let mut names = below.take_while(|name| name.starts_with(prefix)).peekable();
        names.peek().is_some()
            && names
                .all(|name| aside.contains(&&name[prefix.len()..]) || self.standing(name) == Standing::Own)
    }

    /// Returns the path of the result folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Moves a file to the folder of earlier results.
    pub fn put_away(&self, name: &str) -> Result<(), BatchError> {
        let from = self.root.join(name);
        let to = self.free_place(name)?;
        fs::rename(&from, &to).map_err(|source| BatchError::Output { path: to, source })?;
        self.now().moved.push(name.to_owned());
        // the folder of the file is removed if it is empty now; `remove_dir` does not remove any
        // other folder
        match from.parent() {
            Some(parent) if parent != self.root => fs::remove_dir(parent).or(Ok(())),
            _ => Ok(()),
        }
    }

    /// Copies a file to the folder of earlier results.
    pub fn copy_away(&self, name: &str) -> Result<(), BatchError> {
        let to = self.free_place(name)?;
        fs::copy(self.root.join(name), &to).map_err(|source| BatchError::Output { path: to, source })?;
        self.now().moved.push(name.to_owned());
        Ok(())
    }

    /// Finds an unused path in the folder of earlier results for the file `name`, and creates the
    /// folders on that path.
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

    /// Ends a run in which no input was left out.
    ///
    /// Results of earlier runs that this run neither replaced nor kept are moved to the folder of
    /// earlier results, the list of files is written again, and the marker of an incomplete folder
    /// is removed.
    pub fn close(&self) -> Result<Leftovers, BatchError> {
        let mut left = Leftovers { place: self.root.join(OWN).join(EARLIER), ..Leftovers::default() };
        let (written, kept) = {
            let now = self.now();
            (now.written.clone(), now.kept.clone())
        };
        // no path in `kept` is the beginning of another one, so only the last path that does not
        // sort after `name` can be the beginning of `name`
        let below = |name: &str| kept.range::<str, _>((Bound::Unbounded, Bound::Included(name))).next_back();
        let holds = |name: &str| below(name).is_some_and(|prefix| name.starts_with(prefix.as_str()));
        let mut list = written.clone();
        for (name, hashes) in self.earlier.iter().filter(|(name, _)| !written.contains_key(*name)) {
            // kept results were compared with their hashes when they were kept, so a single hash is
            // right; there are several only after a run that was stopped or killed
            let kept = holds(name);
            match hashes.first().filter(|_| kept && hashes.len() == 1) {
                Some(hash) if self.root.join(name).exists() => {
                    list.insert(name.clone(), hash.clone());
                }
                _ => match (self.current(name), kept) {
                    (None, _) => {}
                    (Some(hash), true) => {
                        let listed = if hashes.contains(&hash) { Some(&hash) } else { hashes.first() };
                        list.extend(listed.map(|hash| (name.clone(), hash.clone())));
                    }
                    // all results are written by now, so a file that cannot be moved is reported
                    // instead of ending in an error
                    (Some(hash), false) if hashes.contains(&hash) && self.put_away(name).is_ok() => {}
                    (Some(_), false) => left.foreign.push(name.clone()),
                },
            }
        }
        list.remove(VOLATILE);
        if !written.contains_key(VOLATILE) && self.root.join(VOLATILE).is_file() {
            self.put_away(VOLATILE)?;
        }
        left.moved = std::mem::take(&mut self.now().moved);
        left.moved.sort_unstable();
        let lines: String = list.iter().map(|(name, hash)| format!("{}\n", line(hash, name))).collect();
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

/// Returns the line of the list for a file.
///
/// Line breaks and backslashes in the name are written as `sha256sum` does: as `\n`, `\r` and `\\`.
/// A backslash before the hash says that the name contains such replacements.
fn line(hash: &str, name: &str) -> String {
    if !name.contains(['\n', '\r', '\\']) {
        return format!("{hash}  {name}");
    }
    let name = name.replace('\\', r"\\").replace('\n', r"\n").replace('\r', r"\r");
    format!("\\{hash}  {name}")
}

/// Reads a line of the list and returns hash and name; `None` if the line is incomplete.
fn parsed(line: &str) -> Option<(String, String)> {
    let (hash, name) = line.split_once("  ")?;
    let Some(hash) = hash.strip_prefix('\\') else { return Some((hash.to_owned(), name.to_owned())) };
    let mut plain = String::new();
    let mut characters = name.chars();
    while let Some(c) = characters.next() {
        plain.push(match c {
            '\\' => match characters.next()? {
                'n' => '\n',
                'r' => '\r',
                other => other,
            },
            c => c,
        });
    }
    Some((hash.to_owned(), plain))
}

/// Writes bytes as lower-case hexadecimal digits.
pub(in crate::batch) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_survive_the_list_whatever_is_in_them() {
        for name in ["a.csv", "images/a  b/points.csv", "a\nb", "a\\n", "\\", "a\rb", "a\r"] {
            let written = line("12ab", name);
            assert!(!written.contains(['\n', '\r']), "{written:?}");
            assert_eq!(parsed(&written), Some(("12ab".to_owned(), name.to_owned())));
        }
    }

    #[test]
    fn a_line_that_was_cut_off_costs_no_other_line() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join(OWN)).unwrap();
        fs::write(folder.path().join(OWN).join(LIST), b"ab  one.csv\n\xff\xfe  garbage\ncd").unwrap();
        let ledger = Ledger::open(folder.path()).unwrap();
        ledger.note("two.csv", b"2").unwrap();
        let again = Ledger::open(folder.path()).unwrap();
        assert!(again.knows("one.csv") && again.knows("two.csv") && !again.knows("cd"));
    }
}
