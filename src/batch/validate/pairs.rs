use super::{Detected, ValidationOptions};
use crate::batch::coordinate_files;
use crate::batch::input::{image_beside, image_in, image_name, says_coords};
use crate::batch::{BatchError, Input};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Search for the image and the detections that belong to a file of marks.
#[derive(Clone, Copy)]
pub(super) struct Pairs<'a> {
    /// The folder of marks, or the only file of marks.
    pub reference: &'a Path,
    /// Options that say where images and detections lie.
    pub options: &'a ValidationOptions,
}

impl Pairs<'_> {
    /// Finds the files of marks, and returns one per image, with the name of the image. Also
    /// returns the other coordinate files that were found beside them.
    ///
    /// A file counts as a file of marks if its name ends in `_coords`, or if an image or detections
    /// of the same name are found. If a folder contains both `NAME_coords` and `NAME`, only
    /// `NAME_coords` is returned.
    pub fn marks(&self, out: &Path) -> Result<(Vec<Input>, Vec<PathBuf>), BatchError> {
        let files = coordinate_files(&[self.reference.to_owned()], Some(out))?;
        let belongs = |input: &Input| {
            says_coords(&input.path)
                || image_beside(&input.path).is_some()
                || self.image(&input.path).is_some()
                || self.detections(&input.path, &self.options.detected).is_some()
        };
        let (mut marks, ignored): (Vec<Input>, Vec<Input>) = files.into_iter().partition(belongs);
        let twice: Vec<PathBuf> =
            marks.iter().filter(|m| says_coords(&m.path)).map(|m| m.path.clone()).collect();
        marks.retain(|m| {
            says_coords(&m.path)
                || !twice
                    .iter()
                    .any(|t| t.parent() == m.path.parent() && image_name(t) == image_name(&m.path))
        });
        if marks.is_empty() {
            let paths = self.reference.display().to_string();
            let expected = "NAME_coords.csv, or NAME.csv beside NAME.png or NAME.tif".into();
            return Err(BatchError::Nothing { what: "hand marks", paths, expected });
        }
        let mut taken: HashSet<String> = marks.iter().map(|m| m.name.clone()).collect();
        for mark in &mut marks {
            if let Some(short) = mark.name.strip_suffix("_coords")
                && taken.insert(short.to_owned())
            {
                mark.name = short.to_owned();
            }
        }
        Ok((marks, ignored.into_iter().map(|i| i.path).collect()))
    }

    /// Returns the image that belongs to a file of marks; `None` if there is none.
    pub fn image(&self, marks: &Path) -> Option<PathBuf> {
        match &self.options.images {
            Some(given) => self.sought(given, marks, |folder| image_in(folder, &image_name(marks))),
            None => image_beside(marks),
        }
    }

    /// Returns the file of detections that belongs to a file of marks; `None` if there is none. The
    /// file of marks itself is never returned.
    pub fn detections(&self, marks: &Path, detected: &Detected) -> Option<PathBuf> {
        let Detected::Files { path: given, .. } = detected else { return None };
        let name = image_name(marks);
        let own = marks.canonicalize().ok();
        let is_other = |path: &PathBuf| path.canonicalize().ok() != own;
        let in_folder = |folder: &Path| {
            let files = [folder.join(format!("{name}.csv")), folder.join(format!("{name}_coords.csv"))];
            files.into_iter().find(|path| path.is_file() && is_other(path))
        };
        self.sought(given, marks, in_folder).filter(is_other)
    }

    /// Returns `given` if it is a file that belongs to `marks`. If `given` is a folder, returns the
    /// file that `in_folder` finds in one of its two [`places`](Self::places).
    fn sought(
        &self,
        given: &Path,
        marks: &Path,
        in_folder: impl Fn(&Path) -> Option<PathBuf>,
    ) -> Option<PathBuf> {
        if given.is_file() {
            return self.belongs(given, marks).then(|| given.to_owned());
        }
        self.places(marks, given).iter().find_map(|folder| in_folder(folder))
    }

    /// Returns whether `file`, which the user named instead of a folder, belongs to a file of
    /// marks.
    ///
    /// If there is only one file of marks, the two always belong together. Otherwise both must name
    /// the same image.
    fn belongs(&self, file: &Path, marks: &Path) -> bool {
        self.reference.is_file() || image_name(file) == image_name(marks)
    }

    /// Returns the two folders in which to search. If the marks lie in a subfolder of the reference
    /// folder, the first is the subfolder of `folder` with the same relative path. The second is
    /// `folder` itself.
    fn places(&self, marks: &Path, folder: &Path) -> [PathBuf; 2] {
        let below = marks.parent().and_then(|p| p.strip_prefix(self.reference).ok()).unwrap_or(Path::new(""));
        [folder.join(below), folder.to_owned()]
    }
}
