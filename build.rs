//! Sets `CONEMOSAIC_BUILD_HASH`, a SHA-256 of everything that decides what the program computes.
//!
//! A resumed run may keep an earlier result only if the same code and weights made it. The version
//! cannot tell, as it stays the same while the code changes.

use sha2::{Digest, Sha256};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

fn main() -> io::Result<()> {
    let mut files = Vec::new();
    collect(Path::new("src"), &mut files)?;
    // the crate must also build without its lock file, as in a vendored copy
    files.extend(Some(PathBuf::from("Cargo.lock")).filter(|lock| lock.is_file()));
    files.sort();

    let mut hash = Sha256::new();
    for file in &files {
        let bytes = fs::read(file)?;
        // the lengths keep the end of one file from being read as the start of the next
        hash.update(format!("{}\0{}\0", file.display().to_string().replace('\\', "/"), bytes.len()));
        hash.update(bytes);
    }
    let hex: String = hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    println!("cargo::rustc-env=CONEMOSAIC_BUILD_HASH={hex}");
    println!("cargo::rerun-if-changed=src");
    println!("cargo::rerun-if-changed=Cargo.lock");
    Ok(())
}

/// Adds the code and the weights below `folder` to `files`.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        // results depend on options, not on the words of the command line that set them; leaving
        // the command line out of the hash lets an edit there recompile the binary only
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
