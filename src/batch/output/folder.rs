use super::ledger::{Ledger, Standing};
use crate::batch::BatchError;
use crate::files::{sync_folder, write_atomically};
use serde::Serialize;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A folder inside a result folder, or that folder itself. Files and folders appear in it whole or
/// not at all, and the ledger knows them.
pub(in crate::batch) struct OutputFolder {
    path: PathBuf,
    /// Put before a name to make it a path from the result folder.
    prefix: String,
    ledger: Arc<Ledger>,
}

impl OutputFolder {
    pub(super) fn new(path: &Path, prefix: &str, ledger: &Arc<Ledger>) -> Self {
        Self { path: path.to_owned(), prefix: prefix.to_owned(), ledger: Arc::clone(ledger) }
    }

    /// Returns where a file of that name lies.
    pub fn join(&self, name: impl AsRef<Path>) -> PathBuf {
        self.path.join(name)
    }

    /// Writes a file. One of that name that a person has made or changed is put away first.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), BatchError> {
        let listed = format!("{}{name}", self.prefix);
        // a partial folder is the program's own, whatever stands under its later name
        let path = self.join(name);
        if path == self.ledger.root().join(&listed)
            && self.ledger.standing(&listed) == Standing::Changed
            && fs::read(&path).is_ok_and(|there| there != bytes)
        {
            self.ledger.put_away(&listed)?;
        }
        self.ledger.note(&listed, bytes)?;
        write_atomically(&path, |writer| writer.write_all(bytes))
            .map_err(|source| BatchError::Output { path, source })
    }

    /// Writes a record as JSON to be read by people too.
    pub fn write_json(&self, name: &str, value: &impl Serialize) -> Result<(), BatchError> {
        let mut json = serde_json::to_vec_pretty(value)?;
        json.push(b'\n');
        self.write(name, &json)
    }

    /// Opens a folder inside this one, and makes it where it is missing.
    pub fn folder(&self, name: &str) -> Result<Self, BatchError> {
        let path = self.join(name);
        fs::create_dir_all(&path).map_err(|source| BatchError::Output { path: path.clone(), source })?;
        Ok(Self::new(&path, &format!("{}{name}/", self.prefix), &self.ledger))
    }

    /// Fills a sub-folder beside its place and puts it there when it is whole. Until then, and if
    /// `fill` fails, earlier results stay.
    ///
    /// # Errors
    /// If the earlier folder holds files that the program has not written, or if `fill` or the
    /// operating system refuses.
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
            sync_folder(&partial);
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
            // the reason is already on its way to the user
            let _ = remove_folder(&partial);
            self.ledger.forget(&prefix);
        }
        done
    }

    /// Puts back a folder whose replacement was cut off between its two renames.
    pub fn recover_folder(&self, name: &str) {
        let (old, place) = (self.join(format!(".{name}.old")), self.join(name));
        if old.is_dir() && !place.exists() {
            // if that fails the image is done anew
            let _ = fs::rename(&old, &place);
        }
    }

    /// Tells whether a sub-folder holds results that the program has written.
    pub fn has_results(&self, name: &str) -> bool {
        self.join(name).is_dir() && self.ledger.knows_below(&format!("{}{name}/", self.prefix))
    }

    /// Returns the first file of a sub-folder whose name the ledger does not know.
    fn foreign_in(&self, name: &str) -> Option<String> {
        let prefix = format!("{}{name}/", self.prefix);
        let mut names: Vec<String> = fs::read_dir(self.join(name))
            .into_iter()
            .flatten()
            .flatten()
            .map(|entry| entry.file_name().to_string_lossy().into_owned())
            .collect();
        names.sort_unstable();
        names.into_iter().find(|file| !self.ledger.knows(&format!("{prefix}{file}")))
    }
}

fn remove_folder(path: &Path) -> io::Result<()> {
    match fs::remove_dir_all(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other,
    }
}
