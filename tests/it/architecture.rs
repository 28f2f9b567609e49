//! Modules import each other only as the table in ARCHITECTURE.md allows.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Modules that each module may import besides itself.
const ALLOWED: &[(&str, &[&str])] = &[
    ("choice", &[]),
    ("files", &[]),
    ("geometry", &[]),
    ("numeric", &[]),
    ("image", &["choice", "files", "geometry", "numeric"]),
    ("mosaic", &["choice", "files", "geometry", "numeric"]),
    ("stats", &["choice", "geometry", "numeric", "mosaic"]),
    ("sample", &["geometry", "numeric", "mosaic", "stats"]),
    ("detect", &["choice", "image", "geometry", "numeric", "mosaic"]),
    ("compare", &["choice", "geometry", "numeric", "mosaic", "stats", "sample"]),
    ("render", &["image", "geometry", "numeric", "mosaic"]),
    // `report` writes down the results of all these modules, so it needs their types
    ("report", &["image", "geometry", "numeric", "mosaic", "stats", "sample", "compare", "detect"]),
    (
        "batch",
        &[
            "choice", "files", "image", "geometry", "numeric", "mosaic", "stats", "sample", "detect",
            "compare", "report",
        ],
    ),
];

/// Files and folders below `src` whose strings may name flags of the command line: the command line
/// itself, and the tables and pages that say which command writes them.
const FLAGS: &[&str] = &["cli", "report/tables", "report/metrics", "report/landmarks.rs"];

/// Strings that may contain two hyphens before a letter in all other files: the command that builds
/// the program, and the colours of a page's style sheet.
const STRINGS: &[&str] = &["cargo install --path . --features onnx", "var(--", ":root {"];

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

fn files_below(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files_below(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") && !path.ends_with("tests.rs") {
            found.push(path);
        }
    }
}

/// Returns, for every file below `src`, the parts of its path and its code without comments and
/// tests.
fn code() -> Vec<(Vec<String>, String)> {
    let mut files = Vec::new();
    files_below(&source(), &mut files);
    files.sort();
    assert!(files.len() > 100, "the source is not where it is looked for");
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).unwrap();
        let own = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        let lines: Vec<&str> = own.lines().filter(|l| !l.trim_start().starts_with("//")).collect();
        let below = path.strip_prefix(source()).unwrap().with_extension("");
        (below.iter().map(|p| p.to_string_lossy().into_owned()).collect(), lines.join("\n"))
    };
    files.into_iter().map(read).collect()
}

fn identifier(text: &str) -> &str {
    let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len());
    &text[..end]
}

/// Returns the names that directly follow `prefix` (such as `crate::`) in the imports of `code`,
/// including all names in braces after it.
///
/// With `paths_only`, only names are returned that are modules: those followed by `::` or a
/// semicolon.
fn named_after(code: &str, prefix: &str, paths_only: bool) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for (at, _) in code.match_indices(prefix) {
        // in super::super::x the second `super` is a folder further up
        if code[..at].ends_with("::") {
            continue;
        }
        let rest = &code[at + prefix.len()..];
        let parts: Vec<&str> = match rest.strip_prefix('{') {
            Some(inner) => inner.split('}').next().unwrap_or_default().split(',').collect(),
            None => vec![rest],
        };
        for part in parts.iter().map(|p| p.trim_start()) {
            let name = identifier(part);
            if !name.is_empty() && (!paths_only || part[name.len()..].starts_with([':', ';'])) {
                names.insert(name.to_owned());
            }
        }
    }
    names
}

#[test]
fn modules_import_only_what_stands_below_them() {
    let mut wrong = Vec::new();
    for (path, code) in code() {
        let module = path[0].as_str();
        if matches!(module, "lib" | "main" | "cli" | "prelude") {
            continue;
        }
        let allowed = ALLOWED.iter().find(|(name, _)| *name == module);
        let (_, allowed) = allowed.unwrap_or_else(|| panic!("{module} has no line in ALLOWED"));
        for name in named_after(&code, "crate::", false) {
            if name != module && !allowed.contains(&name.as_str()) {
                wrong.push(format!("{} imports {name}", path.join("/")));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn what_may_be_imported_goes_one_way() {
    for (k, (module, allowed)) in ALLOWED.iter().enumerate() {
        for name in *allowed {
            let place = ALLOWED.iter().position(|(other, _)| other == name);
            assert!(
                place.is_some_and(|p| p < k),
                "{module} may import {name}, which does not stand below it"
            );
        }
    }
}

/// Only imports that name the other file are checked, not those through the `mod.rs` of the folder.
#[test]
fn files_of_one_folder_import_each_other_one_way() {
    let mut folders: BTreeMap<String, BTreeMap<String, BTreeSet<String>>> = BTreeMap::new();
    for (path, code) in code() {
        let (file, folder) = path.split_last().unwrap();
        if folder.is_empty() || file == "mod" {
            continue;
        }
        let folder = folder.join("/");
        let mut names = named_after(&code, "super::", true);
        let full = format!("crate::{}::", folder.replace('/', "::"));
        names.extend(named_after(&code, &full, true));
        names.remove(file);
        folders.entry(folder).or_default().insert(file.clone(), names);
    }
    for (folder, mut files) in folders {
        // repeatedly removes files that import no other file still listed: circles remain, and
        // files that lead into circles
        loop {
            let left: BTreeSet<String> = files.keys().cloned().collect();
            let before = files.len();
            files.retain(|_, names| names.iter().any(|n| left.contains(n)));
            if files.len() == before {
                break;
            }
        }
        // repeatedly removes files that no other file still listed imports: only circles, and files
        // between circles, remain
        loop {
            let wanted: BTreeSet<String> = files.values().flatten().cloned().collect();
            let before = files.len();
            files.retain(|file, _| wanted.contains(file));
            if files.len() == before {
                break;
            }
        }
        assert!(files.is_empty(), "in {folder} these import each other in circles: {:?}", files.keys());
    }
}

#[test]
fn only_the_command_line_names_its_flags() {
    let mut wrong = Vec::new();
    for (path, code) in code() {
        let path = path.join("/");
        if FLAGS.iter().any(|f| path.starts_with(f.trim_end_matches(".rs"))) {
            continue;
        }
        for line in code.lines().filter(|line| !STRINGS.iter().any(|s| line.contains(s))) {
            let names = |(at, _): (usize, &str)| line[at + 2..].starts_with(|c: char| c.is_ascii_lowercase());
            if line.match_indices("--").any(names) {
                wrong.push(format!("{path}: {}", line.trim()));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
