//! Atomic writing of files: a file appears complete or not at all.
//!
//! # Examples
//! ```
//! use conemosaic::files::write_atomically;
//! use std::io::Write;
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("points.csv");
//! write_atomically(&path, |file| file.write_all(b"x_px,y_px\n"))?;
//! assert_eq!(std::fs::read(&path)?, b"x_px,y_px\n");
//! # Ok::<(), std::io::Error>(())
//! ```

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Writes a file completely or not at all.
///
/// The content goes into a temporary file in the same folder, which is synced to the disk and then
/// renamed to `path`. A failure, a panic, an interruption or a loss of power leaves an earlier file
/// at `path` as it was. Devices and pipes are written directly.
///
/// # Errors
/// Fails if the operating system refuses or `write` returns an error. The temporary file is then
/// removed.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> io::Result<()> {
    if fs::metadata(path).is_ok_and(|m| !m.is_file() && !m.is_dir()) {
        let mut writer = BufWriter::new(OpenOptions::new().write(true).open(path)?);
        write(&mut writer)?;
        return writer.flush();
    }
    // a symbolic link must stay a link to the same file, so the file behind it is replaced
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let (temporary, file) = Temporary::beside(&target)?;
    let mut writer = BufWriter::new(file);
    write(&mut writer)?;
    // without the sync, a loss of power could leave the new name on an empty file
    writer.into_inner()?.sync_all()?;
    fs::rename(&temporary.0, &target)
}

/// Syncs the list of names in a folder to the disk, if the operating system can, so that renames in
/// the folder survive a loss of power.
pub fn sync_folder(path: &Path) {
    // Windows does not open folders as files and does not need this call. On other systems a
    // refusal is ignored, as the program could do nothing about it.
    if let Ok(folder) = File::open(path) {
        let _ = folder.sync_all();
    }
}

/// Temporary file that is removed when dropped, unless it has been renamed by then.
struct Temporary(PathBuf);

impl Temporary {
    /// Creates a temporary file with a new name in the folder of `target`.
    fn beside(target: &Path) -> io::Result<(Self, File)> {
        /// Number of names of temporary files that this process has tried. It makes names unique
        /// among threads, and the process number does so among processes.
        static COUNT: AtomicU64 = AtomicU64::new(0);
        loop {
            let count = COUNT.fetch_add(1, Ordering::Relaxed);
            let path = target.with_file_name(format!(".conemosaic-{}-{count}.tmp", std::process::id()));
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => return Ok((Self(path), file)),
                // an earlier process with the same number was killed and left this file behind: try
                // the next name
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
                Err(e) => return Err(e),
            }
        }
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // after a rename there is nothing to remove
        let _ = fs::remove_file(&self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn failure_leaves_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.csv");
        write_atomically(&path, |w| w.write_all(b"first")).unwrap();
        let failed = write_atomically(&path, |w| {
            w.write_all(b"half of the sec")?;
            Err(io::Error::other("the disk is full"))
        });
        assert!(failed.unwrap_err().to_string().contains("the disk is full"));
        assert_eq!(fs::read(&path).unwrap(), b"first");
        assert_eq!(names(folder.path()), ["points.csv"]);
    }

    #[test]
    fn missing_folders_and_folders_as_files_are_errors() {
        let folder = tempfile::tempdir().unwrap();
        assert!(write_atomically(&folder.path().join("none/points.csv"), |_| Ok(())).is_err());
        assert!(write_atomically(folder.path(), |_| Ok(())).is_err());
        assert!(names(folder.path()).is_empty());
        assert!(write_atomically(Path::new(""), |_| Ok(())).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_keep_pointing_to_the_file_that_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write_atomically(&link, |w| w.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    }
}
