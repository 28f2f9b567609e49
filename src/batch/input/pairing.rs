use crate::image::extensions;
use std::path::{Path, PathBuf};

/// Returns the name of the image to which a coordinate file belongs: the name of the file without
/// its extension and without `_coords` at the end.
pub(in crate::batch) fn image_name(coordinates: &Path) -> String {
    let stem = coordinates.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    stem.strip_suffix("_coords").map_or(stem.clone(), str::to_owned)
}

/// Returns whether the name of a file ends in `_coords` before the extension, which means that it
/// is a file of hand marks.
pub(in crate::batch) fn says_coords(path: &Path) -> bool {
    path.file_stem().unwrap_or_default().to_string_lossy().ends_with("_coords")
}

/// Returns the image called `name` in `folder`; `None` if there is none.
///
/// The extension of the image may be in lower case, in upper case or capitalised.
pub(in crate::batch) fn image_in(folder: &Path, name: &str) -> Option<PathBuf> {
    let spellings: [fn(&str) -> String; 3] = [str::to_owned, str::to_uppercase, capitalised];
    let endings = spellings.iter().flat_map(|spelt| extensions().map(spelt));
    endings.map(|e| folder.join(format!("{name}.{e}"))).find(|p| p.is_file())
}

/// Returns a word with the first letter in upper case.
fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Returns the image that lies beside a coordinate file and has its name (see [`image_name`]);
/// `None` if there is no such image.
pub(in crate::batch) fn image_beside(coordinates: &Path) -> Option<PathBuf> {
    let folder = coordinates.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    image_in(folder, &image_name(coordinates))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_belong_to_the_image_of_their_name() {
        assert_eq!(image_name(Path::new("a/JC_0.08_x_coords.csv")), "JC_0.08_x");
        assert_eq!(image_name(Path::new("JC_0.08_x.csv")), "JC_0.08_x");
    }
}
