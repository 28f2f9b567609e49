//! Sets `CONEMOSAIC_BUILD_HASH`, a SHA-256 of the source code, weights, tables and `Cargo.lock`, on
//! which the results of the program depend.
//!
//! A resumed run may keep an earlier result only if the same code and weights made it. The version
//! number cannot tell, as it stays the same while the code changes.

use sha2::{Digest, Sha256};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

fn main() -> io::Result<()> {
    let mut files = Vec::new();
    collect(Path::new("src"), &mut files)?;
    // `Cargo.lock` may be missing, as in a vendored copy
    files.extend(Some(PathBuf::from("Cargo.lock")).filter(|lock| lock.is_file()));
    files.sort();

    let mut hash = Sha256::new();
    for file in &files {
        let bytes = fs::read(file)?;
        // the lengths keep the end of one file from being taken for the start of the next
        hash.update(format!("{}\0{}\0", file.display().to_string().replace('\\', "/"), bytes.len()));
        hash.update(bytes);
    }
    let hex: String = hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    println!("cargo::rustc-env=CONEMOSAIC_BUILD_HASH={hex}");
    println!("cargo::rerun-if-changed=src");
    println!("cargo::rerun-if-changed=Cargo.lock");
    Ok(())
}

/// Adds all source files, weights and tables below `folder` to `files`, except those of the command
/// line.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        // results depend on the values of options, not on the command line that sets them; since
        // its code is not in the hash, an edit there recompiles only the binary
        if path.ends_with("cli") || path.ends_with("main.rs") {
            continue;
        }
        if path.is_dir() {
            collect(&path, files)?;
        } else if path
            .extension()
            .is_some_and(|kind| ["rs", "f32", "safetensors", "csv", "bin"].iter().any(|k| kind == *k))
        {
            files.push(path);
        }
    }
    Ok(())
}
