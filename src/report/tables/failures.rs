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
    commands: "all commands that take several files",
    about: "One row per file that failed. The table does not exist if no file failed.",
    columns: &[
        column("file", "text", "Path of the file, as given.").of(|f| f.file.as_str().into()),
        column("reason", "text", "Reason for the failure, with advice on what to do.")
            .of(|f| f.reason.as_str().into()),
    ],
};
