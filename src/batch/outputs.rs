use super::BatchError;
use crate::files::write_atomically;
use serde::Serialize;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A folder for results. Files and folders appear in it whole or not at all.
pub(super) struct OutputFolder {
    path: PathBuf,
}

impl OutputFolder {
    /// Makes the folder where it is missing and tries whether it can be written to.
    pub fn create(path: &Path) -> Result<Self, BatchError> {
        let refused = |source: io::Error| BatchError::Output { path: path.to_owned(), source };
        fs::create_dir_all(path).map_err(refused)?;
        tempfile_probe(path).map_err(refused)?;
        Ok(Self { path: path.to_owned() })
    }

    pub fn join(&self, name: impl AsRef<Path>) -> PathBuf {
        self.path.join(name)
    }

    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), BatchError> {
        let path = self.join(name);
        write_atomically(&path, |writer| writer.write_all(bytes))
            .map_err(|source| BatchError::Output { path, source })
    }

    /// A record as JSON to be read by people too.
    pub fn write_json(&self, name: &str, value: &impl Serialize) -> Result<(), BatchError> {
        let mut json = serde_json::to_vec_pretty(value)?;
        json.push(b'\n');
        self.write(name, &json)
    }

    pub fn remove(&self, name: &str) -> Result<(), BatchError> {
        let path = self.join(name);
        match fs::remove_file(&path) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => {
                Err(BatchError::Output { path, source })
            }
            _ => Ok(()),
        }
    }

    /// A sub-folder of the files `known` that takes its place, instead of earlier results, when `fill` has filled it.
    /// A folder that holds anything else is somebody's and stays.
    pub fn replace_folder(
        &self,
        name: &str,
        known: &[&str],
        fill: impl FnOnce(&OutputFolder) -> Result<(), BatchError>,
    ) -> Result<(), BatchError> {
        self.refuse_foreign(name, known)?;
        let partial = self.join(format!(".{name}.partial"));
        let refused = |source: io::Error| BatchError::Output { path: partial.clone(), source };
        remove_folder(&partial).map_err(refused)?;
        fs::create_dir(&partial).map_err(refused)?;
        let done = fill(&OutputFolder { path: partial.clone() }).and_then(|()| {
            let place = self.join(name);
            remove_folder(&place).and_then(|()| fs::rename(&partial, &place)).map_err(refused)
        });
        if done.is_err() {
            // the reason is already on its way to the user
            let _ = remove_folder(&partial);
        }
        done
    }

    /// Removes a sub-folder of earlier results, unless it holds anything but the files `known`.
    pub fn remove_results(&self, name: &str, known: &[&str]) -> Result<(), BatchError> {
        self.refuse_foreign(name, known)?;
        let path = self.join(name);
        remove_folder(&path).map_err(|source| BatchError::Output { path, source })
    }

    fn refuse_foreign(&self, name: &str, known: &[&str]) -> Result<(), BatchError> {
        let path = self.join(name);
        let foreign = fs::read_dir(&path)
            .into_iter()
            .flatten()
            .flatten()
            .any(|entry| !known.iter().any(|k| entry.file_name() == *k));
        if foreign { Err(BatchError::ForeignFolder { path }) } else { Ok(()) }
    }
}

fn remove_folder(path: &Path) -> io::Result<()> {
    match fs::remove_dir_all(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other,
    }
}

/// Permissions alone do not tell (read-only file systems, quotas): write and remove.
fn tempfile_probe(folder: &Path) -> io::Result<()> {
    let probe = folder.join(format!(".conemosaic-{}", std::process::id()));
    fs::write(&probe, b"")?;
    fs::remove_file(&probe)
}
