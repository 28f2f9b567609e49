use super::{Failure, Progress};
use crate::batch::{BatchError, Input};
use rayon::prelude::*;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Results of [`for_each()`] for the files of a batch.
pub(in crate::batch) struct Worked<T> {
    /// Results of the files that succeeded, in the order of the inputs.
    pub done: Vec<T>,
    /// Files that failed, with the reasons, in the order of the inputs.
    pub failures: Vec<Failure>,
    /// Number of files that were not begun because the batch was stopped.
    pub left: usize,
}

/// Calls `work` for every input and reports each result to `progress`. Inputs are processed on all
/// cores, roughly in their order.
///
/// An error or a panic in one file does not stop the others. Besides its result, `work` returns the
/// line that is shown to the user about the file.
pub(in crate::batch) fn for_each<T: Send>(
    inputs: &[Input],
    progress: &dyn Progress,
    work: impl Fn(&Input) -> Result<(T, String), BatchError> + Sync,
) -> Worked<T> {
    progress.begin(inputs.len());
    let results = Mutex::new(Vec::with_capacity(inputs.len()));
    let left = AtomicUsize::new(0);
    inputs.iter().enumerate().par_bridge().for_each(|(index, input)| {
        if progress.stopped() {
            left.fetch_add(1, Ordering::Relaxed);
            return;
        }
        // a panic leaves nothing half-changed that other files use: results are written completely
        // or not at all
        let attempt = catch_unwind(AssertUnwindSafe(|| work(input)));
        let result = match attempt {
            Ok(Ok((value, line))) => {
                progress.done(&input.name, Ok(&line));
                Ok(value)
            }
            Ok(Err(error)) => Err(failed(input, &progress.words(&error), progress)),
            Err(panic) => Err(failed(input, &internal(panic.as_ref()), progress)),
        };
        results.lock().unwrap_or_else(PoisonError::into_inner).push((index, result));
    });
    progress.end();
    let mut results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.sort_by_key(|(index, _)| *index);
    let mut worked = Worked { done: Vec::new(), failures: Vec::new(), left: left.into_inner() };
    for (_, result) in results {
        match result {
            Ok(value) => worked.done.push(value),
            Err(failure) => worked.failures.push(failure),
        }
    }
    worked
}

/// Reports the failure of a file to `progress` and returns it. Line breaks in `reason` become
/// spaces, and the path of the file is put before it unless it names the file already.
fn failed(input: &Input, reason: &str, progress: &dyn Progress) -> Failure {
    let file = input.path.display().to_string();
    let reason = reason.split_whitespace().collect::<Vec<_>>().join(" ");
    let reason = if reason.contains(&file) { reason } else { format!("{file}: {reason}") };
    progress.done(&input.name, Err(&reason));
    Failure { file, reason }
}

/// Returns the text of the error for a panic, with the message of the panic.
fn internal(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    format!(
        "internal error ({}): please report it with this file; the other files are not affected",
        text.unwrap_or("no message")
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batch::Silent;

    fn inputs(n: usize) -> Vec<Input> {
        (0..n).map(|k| Input { path: format!("{k}.png").into(), name: k.to_string() }).collect()
    }

    #[test]
    fn a_panic_in_one_file_is_a_failure_of_that_file() {
        let worked = for_each(&inputs(5), &Silent, |input| match input.name.as_str() {
            "3" => panic!("index out of bounds"),
            name => Ok((name.to_owned(), String::new())),
        });
        assert_eq!(worked.done, ["0", "1", "2", "4"]);
        assert_eq!(worked.failures.len(), 1);
        assert!(worked.failures[0].reason.starts_with("3.png: internal error (index out of bounds)"));
        assert_eq!(worked.left, 0);
    }

    #[test]
    fn a_stopped_batch_begins_no_further_file() {
        struct StopAfterOne(AtomicUsize);
        impl Progress for StopAfterOne {
            fn begin(&self, _total: usize) {}
            fn done(&self, _name: &str, _outcome: Result<&str, &str>) {
                self.0.fetch_add(1, Ordering::SeqCst);
            }
            fn end(&self) {}
            fn stopped(&self) -> bool {
                self.0.load(Ordering::SeqCst) > 0
            }
        }
        let progress = StopAfterOne(AtomicUsize::new(0));
        let worked = for_each(&inputs(1000), &progress, |input| Ok((input.name.clone(), String::new())));
        assert!(worked.left > 0 && worked.done.len() + worked.left == 1000);
    }
}
