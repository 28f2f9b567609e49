use super::{Detected, ValidationOptions};
use crate::batch::coordinate_files;
use crate::batch::input::{image_beside, image_in, image_name, says_coords};
use crate::batch::{BatchError, Input};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Which files belong to a file of marks.
#[derive(Clone, Copy)]
pub(super) struct Pairs<'a> {
    pub reference: &'a Path,
    pub options: &'a ValidationOptions,
}

impl Pairs<'_> {
    /// The files of marks, one an image and called like it, and what else lies there: a file counts if it is called
    /// `…_coords` or an image or a detection has its name.
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

    /// The image that belongs to a file of marks.
    pub fn image(&self, marks: &Path) -> Option<PathBuf> {
        match &self.options.images {
            Some(given) => self.sought(given, marks, |folder| image_in(folder, &image_name(marks))),
            None => image_beside(marks),
        }
    }

    /// The file of detections that belongs to a file of marks, never that file itself.
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

    /// The given file, if it belongs to a file of marks, or what `in_folder` finds in a given folder.
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

    /// Whether a file that was given instead of a folder belongs to a file of marks: to the only one, whatever their names.
    fn belongs(&self, file: &Path, marks: &Path) -> bool {
        self.reference.is_file() || image_name(file) == image_name(marks)
    }

    /// The folder that lies below the one given as the marks lie below the reference, and the one given.
    fn places(&self, marks: &Path, folder: &Path) -> [PathBuf; 2] {
        let below = marks.parent().and_then(|p| p.strip_prefix(self.reference).ok()).unwrap_or(Path::new(""));
        [folder.join(below), folder.to_owned()]
    }
}
