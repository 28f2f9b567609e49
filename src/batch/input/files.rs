use crate::batch::BatchError;
use crate::image::{extensions_in_words, is_image_path};
use std::collections::{HashMap, HashSet};
use std::io;
use std::path::{Component, Path, PathBuf};
use walkdir::WalkDir;

/// A file to process, and the name under which its results are written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    /// Path of the file.
    pub path: PathBuf,
    /// Name of the results: the file name without its last extension. If several files share this
    /// name, names of folders, extensions or numbers make it unique within the batch.
    pub name: String,
}

/// Extensions by which coordinate files in folders are recognised. A file whose own path the user
/// names may have any extension.
const COORDINATE_EXTENSIONS: [&str; 7] = ["csv", "tsv", "txt", "json", "tar", "roi", "zip"];

/// Returns all images (PNG and TIFF files) among `paths` and in their subfolders.
///
/// The result has the order of `paths`; the files of a folder are sorted by name. Hidden files,
/// overlays drawn by this program and the content of the folder `except` (the output folder) are
/// left out. If `paths` contains the path of a file, that file is taken whatever its name. A file
/// that is found twice is listed once.
///
/// # Errors
/// Fails if a path does not exist, or if no image is found.
pub fn image_files(paths: &[PathBuf], except: Option<&Path>) -> Result<Vec<Input>, BatchError> {
    let files = walk(paths, except, |path| is_image_path(path) && !is_overlay(path))?;
    if files.is_empty() {
        let expected = format!("files ending in {}", extensions_in_words()).into();
        return Err(BatchError::Nothing { what: "images", paths: listed(paths), expected });
    }
    Ok(named(files))
}

/// Returns all coordinate files among `paths` and in their subfolders, in the order of
/// [`image_files`].
///
/// Tables and records that this program writes and that contain no coordinates are left out, unless
/// `paths` names them.
///
/// # Errors
/// Fails if a path does not exist, or if no coordinate file is found.
pub fn coordinate_files(paths: &[PathBuf], except: Option<&Path>) -> Result<Vec<Input>, BatchError> {
    let known = |path: &Path| COORDINATE_EXTENSIONS.contains(&extension(path).as_str()) && !is_table(path);
    let files = walk(paths, except, known)?;
    if files.is_empty() {
        let expected = "files ending in .csv, .tsv, .txt, .json, .tar, .roi or .zip".into();
        return Err(BatchError::Nothing { what: "coordinate files", paths: listed(paths), expected });
    }
    Ok(named(files))
}

/// Returns whether a file is an overlay that this program drew, and so not an image to be
/// processed.
///
/// An overlay is recognised by the file of coordinates, scores or metrics that lies beside it.
fn is_overlay(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default();
    if name == "overlay.png" {
        return path.with_file_name("metrics.json").is_file();
    }
    let drawn = name.to_str().and_then(|name| name.strip_suffix(".overlay.png"));
    let beside = |file: &str| path.with_file_name(file).is_file();
    drawn.is_some_and(|name| beside(&format!("{name}.csv")) || beside("validation.csv"))
}

/// Returns whether a file has the name of a table or record that this program writes and that
/// contains no coordinates.
fn is_table(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let known = [
        "summary.csv",
        "failures.csv",
        "l_infinity.csv",
        "validation.csv",
        "validation.json",
        "groups.csv",
        "froc.csv",
        "reliability.csv",
        "comparison.csv",
        "landmarks.csv",
        "rois.csv",
        "maps.csv",
        "profiles.csv",
        "pcf.csv",
        "metrics.json",
        "density_recovery.csv",
        "fourier_map.csv",
        "agreement.csv",
        "differences.csv",
        "regularity.csv",
        "finding.csv",
        "verdicts.csv",
        "summary.json",
        "options.json",
        "run.json",
    ];
    let endings = [
        ".pcf.csv",
        ".functions.csv",
        ".density_recovery.csv",
        ".spectrum.csv",
        ".envelope.csv",
        ".maps.csv",
        ".profiles.csv",
    ];
    known.contains(&&*name) || endings.iter().any(|ending| name.ends_with(ending))
}

/// Returns the paths as one line of text, for an error message.
fn listed(paths: &[PathBuf]) -> String {
    paths.iter().map(|p| p.display().to_string()).collect::<Vec<_>>().join(", ")
}

/// Returns the files among `paths`, and the files in the folders among `paths` for which `wanted`
/// returns `true`. Hidden files and folders are left out.
///
/// The folder `except` is not searched. A file that is found twice is listed once.
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
            match entry {
                Ok(entry) if entry.file_type().is_file() && wanted(entry.path()) => add(entry.into_path()),
                Ok(_) => {}
                // a link back to a folder above, which is being searched already
                Err(error) if error.loop_ancestor().is_some() => {}
                // a file or folder that cannot be examined is listed all the same: it will fail by
                // itself when it is read, and stop no other
                Err(error) => match error.path() {
                    Some(path) if path != given => {
                        let folder = path.symlink_metadata().is_ok_and(|m| m.is_dir());
                        if folder || wanted(path) {
                            add(path.to_owned());
                        }
                    }
                    _ => {
                        let source = error.into_io_error().unwrap_or_else(|| io::ErrorKind::Other.into());
                        return Err(BatchError::Unreadable { path: given.clone(), source });
                    }
                },
            }
        }
    }
    Ok(files)
}

/// Gives every file the name of its results: the file name without its last extension, made unique.
///
/// If files share a name, the names of their innermost folders are put before it, as many as are
/// needed to tell the files apart. If the files differ only in their extensions, the extension is
/// appended.
fn named(files: Vec<PathBuf>) -> Vec<Input> {
    let mut names: Vec<String> = files.iter().map(|f| stem(f)).collect();
    // names that still clash with 15 folder names before them get a number below
    for folders in 1..16 {
        // a second or further folder name only helps to tell apart files in different folders
        let helps = |a: &Path, b: &Path| folders == 1 || a.parent() != b.parent();
        let clashing = clashes(&files, &names, helps);
        if clashing.is_empty() {
            break;
        }
        for i in clashing {
            names[i] = with_folders(&files[i], folders);
        }
    }
    for i in clashes(&files, &names, |a, b| extension(a) != extension(b)) {
        names[i] = format!("{}_{}", names[i], extension(&files[i]));
    }
    // names may still differ only in case, or be equal because of underscores in names of folders:
    // a number always tells them apart
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

/// Returns the name in lower case, for comparisons: some file systems treat names that differ only
/// in case as the same.
fn folded(name: &str) -> String {
    name.to_lowercase()
}

/// Returns the file name without its last extension, or `image` if nothing usable is left.
fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    // "...png" has the stem "..", which as the name of a folder would lead out of the results
    if matches!(&*stem, "" | "." | "..") { "image".into() } else { stem.into_owned() }
}

/// Returns the stem of a file with the names of its `count` innermost folders before it, joined by
/// underscores.
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

/// Returns the extension of a file in lower case.
fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

/// Returns the indices of files that share their name with another file, where `matters` returns
/// `true` for the paths of the two. `names` has one name per file.
fn clashes(files: &[PathBuf], names: &[String], matters: impl Fn(&Path, &Path) -> bool) -> Vec<usize> {
    let mut groups: HashMap<String, Vec<usize>> = HashMap::new();
    for (i, name) in names.iter().enumerate() {
        groups.entry(folded(name)).or_default().push(i);
    }
    let clash = |&i: &usize| {
        let group = groups.get(&folded(&names[i])).map_or(&[][..], Vec::as_slice);
        group.iter().any(|&k| k != i && matters(&files[i], &files[k]))
    };
    (0..names.len()).filter(clash).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(files: &[&str]) -> Vec<String> {
        named(files.iter().map(PathBuf::from).collect()).into_iter().map(|i| i.name).collect()
    }

    #[test]
    fn no_name_is_a_way_to_another_folder() {
        assert_eq!(names(&["/a/...png"]), ["image"]);
        assert_eq!(names(&["/a/..png"]), ["image"]);
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
        assert_eq!(names(&["/p/a/1.png", "/p/a/1.tif"]), ["a_1_png", "a_1_tif"]);
        assert_eq!(names(&["/p/a/X.png", "/p/a/x.png"]), ["a_X", "a_x_2"]);
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
    fn results_of_earlier_runs_are_no_inputs() {
        let folder = tempfile::tempdir().unwrap();
        let tables = [
            "a.pcf.csv",
            "a.maps.csv",
            "a.profiles.csv",
            "summary.csv",
            "summary.json",
            "rois.csv",
            "landmarks.csv",
        ];
        for file in ["a.png", "a.csv", "a.overlay.png", "b.overlay.png"].iter().chain(&tables) {
            std::fs::write(folder.path().join(file), "").unwrap();
        }
        let names = |inputs: Vec<Input>| inputs.into_iter().map(|i| i.name).collect::<Vec<_>>();
        let paths = [folder.path().to_owned()];
        assert_eq!(names(image_files(&paths, None).unwrap()), ["a", "b.overlay"]);
        assert_eq!(names(coordinate_files(&paths, None).unwrap()), ["a"]);
    }

    #[test]
    fn an_empty_folder_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let error = image_files(&[folder.path().to_owned()], None).unwrap_err();
        assert!(error.to_string().starts_with("no images in"));
    }
}
