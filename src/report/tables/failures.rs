use super::{Row, Table, column};
use serde::Serialize;

/// A file that could not be worked on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Failure {
    /// Path as given.
    pub file: String,
    /// The reason, in one line.
    pub reason: String,
}

impl Row for Failure {
    type Of<'a> = &'a Self;
}

/// Files without results.
pub static FAILURES: Table<Failure> = Table {
    file: "failures.csv",
    commands: "all that take several files",
    about: "One row per file that failed; there is no such table if none did.",
    columns: &[
        column("file", "text", "The file, as given.").of(|f| f.file.as_str().into()),
        column("reason", "text", "Why, and what helps.").of(|f| f.reason.as_str().into()),
    ],
};
