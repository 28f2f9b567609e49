use super::done::POINTS;
use crate::batch::input::image_name;
use crate::batch::{BatchError, Input, coordinate_files};
use crate::mosaic::io::ReadOptions;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Files of cones that were marked by hand, corrected or found by another program, one file per
/// image.
#[derive(Clone, Debug)]
pub struct GivenCones {
    /// Options of reading the files.
    pub read: ReadOptions,
    /// The folder that was searched for files, or the only file.
    place: PathBuf,
    /// Paths of the files, with the name of the image to which they belong as key.
    files: BTreeMap<String, Vec<PathBuf>>,
}

impl GivenCones {
    /// Finds the files of cones. `place` is the folder to search, with its subfolders, or a single
    /// file.
    ///
    /// A file belongs to the image of the same name; the extension and `_coords` at the end of the
    /// name do not count. A file `NAME/points.csv`, as this program writes it, belongs to the image
    /// NAME.
    ///
    /// # Errors
    /// Fails if `place` does not exist or contains no coordinate file.
    pub fn find(place: &Path, read: ReadOptions) -> Result<Self, BatchError> {
        let mut files: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
        for found in coordinate_files(&[place.to_owned()], None)? {
            files.entry(name_of(&found.path)).or_default().push(found.path);
        }
        Ok(Self { read, place: place.to_owned(), files })
    }

    /// Returns the path of the file of cones that belongs to an image.
    ///
    /// # Errors
    /// Fails if there is no such file, or more than one.
    pub(super) fn file_of(&self, input: &Input) -> Result<&Path, BatchError> {
        let stem = input.path.file_stem().unwrap_or_default().to_string_lossy();
        // a single file is meant for the image, whatever its name
        let only = self.place.is_file().then(|| self.files.values().next()).flatten();
        let found = only.or_else(|| self.files.get(&input.name)).or_else(|| self.files.get(&*stem));
        match found.map(Vec::as_slice) {
            Some([one]) => Ok(one),
            Some([first, second, ..]) => Err(BatchError::Pairing {
                file: input.path.clone(),
                problem: format!(
                    "both {} and {} have its name: keep only one of them",
                    first.display(),
                    second.display()
                ),
            }),
            _ => Err(BatchError::Pairing {
                file: input.path.clone(),
                problem: format!(
                    "its cones are not in {}: expected {stem}.csv, {stem}_coords.csv or {stem}/{POINTS} \
                     there",
                    self.place.display()
                ),
            }),
        }
    }

    /// Returns the path of the folder or file of cones, for the record of a run.
    pub(super) fn describe(&self) -> String {
        self.place.display().to_string()
    }
}
/// Returns the name of the image to which a file of cones belongs.
fn name_of(file: &Path) -> String {
    let folder = file.parent().and_then(Path::file_name);
    match (file.file_name(), folder) {
        (Some(name), Some(folder)) if name == POINTS => folder.to_string_lossy().into_owned(),
        _ => image_name(file),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_belong_to_the_image_of_their_name_or_folder() {
        assert_eq!(name_of(Path::new("report/images/a.1/points.csv")), "a.1");
        assert_eq!(name_of(Path::new("marks/a.1_coords.csv")), "a.1");
        assert_eq!(name_of(Path::new("marks/a.1.csv")), "a.1");
    }
}
