use super::BatchError;
use crate::image::is_image_path;
use std::collections::{HashMap, HashSet};
use std::path::{Component, Path, PathBuf};
use walkdir::WalkDir;

/// A file to work on and the name its results get.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    /// Where it is.
    pub path: PathBuf,
    /// File name less its last extension; unique within the batch.
    pub name: String,
}

/// Extensions of coordinate files in folders; a file named outright may have any.
const COORDINATE_EXTENSIONS: [&str; 7] = ["csv", "tsv", "txt", "json", "tar", "roi", "zip"];

/// All PNG and TIFF files among `paths` and below their folders, in the order given, folders in order of name. Hidden
/// files and what lies in `except` (the output folder) are left out; a file found twice counts once.
///
/// # Errors
/// If a path does not exist or there is no image at all.
pub fn image_files(paths: &[PathBuf], except: Option<&Path>) -> Result<Vec<Input>, BatchError> {
    let files = walk(paths, except, is_image_path)?;
    if files.is_empty() {
        let expected = "files ending in .png, .tif or .tiff";
        return Err(BatchError::Nothing { what: "images", paths: listed(paths), expected });
    }
    Ok(named(files))
}

/// All coordinate files among `paths` and below their folders, as [`image_files`] for images.
///
/// # Errors
/// If a path does not exist or there is no coordinate file at all.
pub fn coordinate_files(paths: &[PathBuf], except: Option<&Path>) -> Result<Vec<Input>, BatchError> {
    let known = |path: &Path| {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        COORDINATE_EXTENSIONS.contains(&extension.as_str())
    };
    let files = walk(paths, except, known)?;
    if files.is_empty() {
        let expected = "files ending in .csv, .tsv, .txt, .json, .tar, .roi or .zip";
        return Err(BatchError::Nothing { what: "coordinate files", paths: listed(paths), expected });
    }
    Ok(named(files))
}

fn listed(paths: &[PathBuf]) -> String {
    paths.iter().map(|p| p.display().to_string()).collect::<Vec<_>>().join(", ")
}

fn walk(
    paths: &[PathBuf],
    except: Option<&Path>,
    wanted: impl Fn(&Path) -> bool,
) -> Result<Vec<PathBuf>, BatchError> {
    let except = except.and_then(|p| p.canonicalize().ok());
    let excluded = |path: &Path| except.is_some() && path.canonicalize().ok() == except;
    let mut seen = HashSet::new();
    let mut files = Vec::new();
    let mut add = |path: PathBuf| {
        if seen.insert(path.canonicalize().unwrap_or_else(|_| path.clone())) {
            files.push(path);
        }
    };
    for given in paths {
        let kind =
            given.metadata().map_err(|source| BatchError::Unreadable { path: given.clone(), source })?;
        if !kind.is_dir() {
            add(given.clone());
            continue;
        }
        let hidden = |name: &std::ffi::OsStr| name.to_string_lossy().starts_with('.');
        let entries =
            WalkDir::new(given).follow_links(true).sort_by_file_name().into_iter().filter_entry(|e| {
                e.depth() == 0 || !(hidden(e.file_name()) || e.file_type().is_dir() && excluded(e.path()))
            });
        for entry in entries {
            let entry = entry.map_err(|error| BatchError::Unreadable {
                path: error.path().unwrap_or(given).to_owned(),
                source: error
                    .into_io_error()
                    .unwrap_or_else(|| std::io::Error::other("a folder contains itself")),
            })?;
            if entry.file_type().is_file() && wanted(entry.path()) {
                add(entry.into_path());
            }
        }
    }
    Ok(files)
}

/// Gives every file the name of its results: the file name less its last extension. Equal names get as many of
/// their folders prefixed as tell them apart, and if only the extension differs, that is appended.
fn named(files: Vec<PathBuf>) -> Vec<Input> {
    let mut names: Vec<String> = files.iter().map(|f| stem(f)).collect();
    for folders in 1..16 {
        let clashing = clashes(&names);
        if clashing.is_empty() {
            break;
        }
        for i in clashing {
            names[i] = with_folders(&files[i], folders);
        }
    }
    for i in clashes(&names) {
        let extension = files[i].extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        names[i] = format!("{}_{extension}", names[i]);
    }
    // what still clashes has strange folders; a number always tells files apart
    let mut taken: HashSet<String> = HashSet::new();
    for name in &mut names {
        let wish = name.clone();
        let mut count = 1;
        while !taken.insert(folded(name)) {
            count += 1;
            *name = format!("{wish}_{count}");
        }
    }
    files.into_iter().zip(names).map(|(path, name)| Input { path, name }).collect()
}

/// Some file systems take names that differ in case for the same.
fn folded(name: &str) -> String {
    name.to_lowercase()
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

fn with_folders(path: &Path, count: usize) -> String {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let folders: Vec<String> = absolute
        .parent()
        .into_iter()
        .flat_map(Path::components)
        .filter_map(|c| match c {
            Component::Normal(name) => Some(name.to_string_lossy().into_owned()),
            _ => None,
        })
        .collect();
    let first = folders.len().saturating_sub(count);
    [&folders[first..], &[stem(path)]].concat().join("_")
}

fn clashes(names: &[String]) -> Vec<usize> {
    let mut counts: HashMap<String, usize> = HashMap::new();
    for name in names {
        *counts.entry(folded(name)).or_default() += 1;
    }
    (0..names.len()).filter(|&i| counts[&folded(&names[i])] > 1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(files: &[&str]) -> Vec<String> {
        named(files.iter().map(PathBuf::from).collect()).into_iter().map(|i| i.name).collect()
    }

    #[test]
    fn a_name_loses_its_last_extension_only() {
        assert_eq!(names(&["/a/JC_0.08_aligned.png"]), ["JC_0.08_aligned"]);
    }

    #[test]
    fn equal_names_get_their_folders_prefixed() {
        assert_eq!(names(&["/a/x/1.png", "/a/y/1.png", "/a/2.png"]), ["x_1", "y_1", "2"]);
        assert_eq!(names(&["/p/x/1.png", "/q/x/1.png"]), ["p_x_1", "q_x_1"]);
    }

    #[test]
    fn names_are_unique_whatever_happens() {
        assert_eq!(names(&["/a/1.png", "/a/1.tif"]), ["a_1_png", "a_1_tif"]);
        assert_eq!(
            names(&["/a/x/1.png", "/a/y/1.png", "/a/x_1.png"]).iter().collect::<HashSet<_>>().len(),
            3
        );
        assert_eq!(names(&["/a/x/1.png", "/a/X/1.png"]).len(), 2);
    }

    #[test]
    fn the_output_folder_is_not_an_input() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("report");
        std::fs::create_dir(&out).unwrap();
        for file in ["a.PNG", "b.tiff", "notes.txt", ".hidden.png", "report/overlay.png"] {
            std::fs::write(folder.path().join(file), "").unwrap();
        }
        let found =
            image_files(&[folder.path().to_owned(), folder.path().join("a.PNG")], Some(&out)).unwrap();
        assert_eq!(found.iter().map(|i| i.name.as_str()).collect::<Vec<_>>(), ["a", "b"]);
    }

    #[test]
    fn an_empty_folder_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let error = image_files(&[folder.path().to_owned()], None).unwrap_err();
        assert!(error.to_string().starts_with("no images in"));
    }
}
