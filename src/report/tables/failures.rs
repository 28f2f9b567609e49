use super::{Row, Table, column};
use serde::Serialize;

/// A file that could not be processed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Failure {
    /// Path of the file, as set by the user.
    pub file: String,
    /// Reason of the failure, in one line.
    pub reason: String,
}

impl Row for Failure {
    type Of<'a> = &'a Self;
}

/// The table of files without results.
pub static FAILURES: Table<Failure> = Table {
    file: "failures.csv",
    commands: "all commands that take several files",
    about: "One row per file that failed; the table is not written if none did.",
    columns: &[
        column("file", "text", "Path of the file, as given.").of(|f| f.file.as_str().into()),
        column("reason", "text", "Reason of the failure, and what to do about it.")
            .of(|f| f.reason.as_str().into()),
    ],
};
