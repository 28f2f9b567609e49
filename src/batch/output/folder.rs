use super::ledger::{Ledger, Standing};
use crate::batch::BatchError;
use crate::files::{sync_folder, write_atomically};
use serde::Serialize;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The result folder, or a folder inside it, into which results are written.
///
/// A file or folder gets its final name only when it is complete. Every file is listed in the
/// ledger.
pub(in crate::batch) struct OutputFolder {
    path: PathBuf,
    /// Path of this folder inside the result folder, ending in a slash; empty for the result folder
    /// itself.
    prefix: String,
    /// The ledger of the result folder.
    ledger: Arc<Ledger>,
}

impl OutputFolder {
    pub(super) fn new(path: &Path, prefix: &str, ledger: &Arc<Ledger>) -> Self {
        Self { path: path.to_owned(), prefix: prefix.to_owned(), ledger: Arc::clone(ledger) }
    }

    /// Returns the path of the file `name` in this folder.
    pub fn join(&self, name: impl AsRef<Path>) -> PathBuf {
        self.path.join(name)
    }

    /// Writes a file. If there is a file of that name that a person made or changed, it is moved to
    /// the folder of earlier results first.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), BatchError> {
        let listed = format!("{}{name}", self.prefix);
        // a folder that is still being filled has a temporary path and contains only the program's
        // own files; a person's files under the later path are saved by `replace_folder`
        let path = self.join(name);
        let in_place = path == self.ledger.root().join(&listed);
        if in_place && self.ledger.would_lose(&listed, bytes) {
            self.ledger.put_away(&listed)?;
        }
        self.ledger.note(&listed, bytes)?;
        if in_place {
            self.ledger.sync()?;
        }
        write_atomically(&path, |writer| writer.write_all(bytes))
            .map_err(|source| BatchError::Output { path, source })
    }

    /// Writes a value as indented JSON, so that people can read it too.
    pub fn write_json(&self, name: &str, value: &impl Serialize) -> Result<(), BatchError> {
        let mut json = serde_json::to_vec_pretty(value)?;
        json.push(b'\n');
        self.write(name, &json)
    }

    /// Opens a subfolder, and creates it if it is missing.
    pub fn folder(&self, name: &str) -> Result<Self, BatchError> {
        let path = self.join(name);
        fs::create_dir_all(&path).map_err(|source| BatchError::Output { path: path.clone(), source })?;
        Ok(Self::new(&path, &format!("{}{name}/", self.prefix), &self.ledger))
    }

    /// Fills a new subfolder under a temporary name, and renames it to `name` when it is complete.
    ///
    /// Until then, and also if `fill` fails, an earlier folder called `name` stays where it is. Its
    /// files that a person has changed are copied to the folder of earlier results before it is
    /// replaced.
    ///
    /// # Errors
    /// Fails if the earlier folder contains files that the program has not written, if `fill`
    /// fails, or if the operating system refuses.
    pub fn replace_folder(
        &self,
        name: &str,
        fill: impl FnOnce(&Self) -> Result<(), BatchError>,
    ) -> Result<(), BatchError> {
        let (partial, place) = (self.join(format!(".{name}.partial")), self.join(name));
        let prefix = format!("{}{name}/", self.prefix);
        let refused = |source: io::Error| BatchError::Output { path: place.clone(), source };
        if let Some(file) = self.foreign_in(name) {
            return Err(BatchError::ForeignFolder { path: place, file });
        }
        remove_folder(&partial).map_err(refused)?;
        fs::create_dir(&partial).map_err(refused)?;
        let done = fill(&Self::new(&partial, &prefix, &self.ledger)).and_then(|()| {
            self.ledger.sync()?;
            sync_folder(&partial);
            self.rescue_changed(name)?;
            let old = self.join(format!(".{name}.old"));
            remove_folder(&old).map_err(refused)?;
            if place.is_dir() {
                fs::rename(&place, &old).map_err(refused)?;
            }
            fs::rename(&partial, &place).map_err(refused)?;
            sync_folder(&self.path);
            remove_folder(&old).map_err(refused)
        });
        if done.is_err() {
            // the error is reported anyway: a second one about tidying up would add nothing
            let _ = remove_folder(&partial);
            self.ledger.forget(&prefix);
        }
        done
    }

    /// Tidies up this folder after a run that was killed.
    ///
    /// Unfinished files and folders are removed. If the run was killed between the two renames of
    /// [`Self::replace_folder`], the earlier folder gets its name back.
    pub fn sweep(&self) {
        for name in names_in(&self.path) {
            let Some(hidden) = name.strip_prefix('.') else { continue };
            let path = self.join(&name);
            // only folders whose results are in the ledger are touched: others may belong to a
            // person
            let ours = |result: &&str| self.ledger.knows_below(&format!("{}{result}/", self.prefix));
            // errors do no harm: a file or folder that cannot be removed is replaced later or is
            // ignored
            if hidden.starts_with("conemosaic-") && hidden.ends_with(".tmp") {
                let _ = fs::remove_file(&path);
            } else if hidden.strip_suffix(".partial").filter(ours).is_some() {
                let _ = remove_folder(&path);
            } else if let Some(result) = hidden.strip_suffix(".old").filter(ours) {
                let place = self.join(result);
                let _ = if place.exists() { remove_folder(&path) } else { fs::rename(&path, &place) };
            }
        }
    }

    /// Copies files of a subfolder that a person has changed to the folder of earlier results,
    /// before the subfolder is replaced.
    fn rescue_changed(&self, name: &str) -> Result<(), BatchError> {
        let listed =
            names_in(&self.join(name)).into_iter().map(|file| format!("{}{name}/{file}", self.prefix));
        listed
            .filter(|file| self.ledger.knows(file) && self.ledger.standing(file) == Standing::Changed)
            .try_for_each(|file| self.ledger.copy_away(&file))
    }

    /// Returns whether a subfolder exists and the program has written files into it.
    pub fn has_results(&self, name: &str) -> bool {
        self.join(name).is_dir() && self.ledger.knows_below(&format!("{}{name}/", self.prefix))
    }

    /// Returns the first file of a subfolder that is not in the ledger; `None` if all files are.
    /// Files that file managers create are ignored.
    fn foreign_in(&self, name: &str) -> Option<String> {
        let known = |file: &str| self.ledger.knows(&format!("{}{name}/{file}", self.prefix));
        names_in(&self.join(name))
            .into_iter()
            .find(|file| !OF_SYSTEMS.contains(&file.as_str()) && !known(file))
    }
}

/// Names of files that file managers create in folders that they show. They are nobody's work and
/// may be lost.
const OF_SYSTEMS: [&str; 3] = [".DS_Store", "Thumbs.db", "desktop.ini"];

/// Returns the sorted names of the files and folders in a folder; empty if the folder cannot be
/// read.
fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> =
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort_unstable();
    names
}

/// Removes the folder `path` with its content; if `path` is a link, removes only the link. Succeeds
/// if nothing exists there.
fn remove_folder(path: &Path) -> io::Result<()> {
    let link = fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink());
    let removed = if link { fs::remove_file(path) } else { fs::remove_dir_all(path) };
    match removed {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other,
    }
}
