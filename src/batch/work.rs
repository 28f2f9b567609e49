use super::{BatchError, Failure, Input, Progress};
use rayon::prelude::*;
use std::sync::Mutex;

/// Does `work` for every input on all cores, in about the order given, and reports each. Results come back in the
/// order of the inputs; failures stop nobody. `work` also returns the line that tells a person what came out.
pub(super) fn for_each<T: Send>(
    inputs: &[Input],
    progress: &dyn Progress,
    work: impl Fn(&Input) -> Result<(T, String), BatchError> + Sync,
) -> (Vec<T>, Vec<Failure>) {
    progress.begin(inputs.len());
    let results = Mutex::new(Vec::with_capacity(inputs.len()));
    inputs.iter().enumerate().par_bridge().for_each(|(index, input)| {
        let result = match work(input) {
            Ok((value, line)) => {
                progress.done(&input.name, Ok(&line));
                Ok(value)
            }
            Err(error) => {
                let file = input.path.display().to_string();
                let reason = one_line(&error);
                let reason = if reason.contains(&file) { reason } else { format!("{file}: {reason}") };
                progress.done(&input.name, Err(&reason));
                Err(Failure { file, reason })
            }
        };
        results.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push((index, result));
    });
    progress.end();
    let mut results = results.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
    results.sort_by_key(|(index, _)| *index);
    let (mut values, mut failures) = (Vec::new(), Vec::new());
    for (_, result) in results {
        match result {
            Ok(value) => values.push(value),
            Err(failure) => failures.push(failure),
        }
    }
    (values, failures)
}

/// The error and what caused it, without line breaks.
fn one_line(error: &BatchError) -> String {
    error.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
