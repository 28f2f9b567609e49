use super::Parameter;
use thiserror::Error;

/// Reason why points could not be made.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SampleError {
    /// Name that belongs to no sampler.
    #[error("there is no sampler “{name}”{hint}: choose from {names}")]
    Unknown {
        /// Name that was asked for.
        name: String,
        /// Names of all samplers, separated by commas.
        names: String,
        /// Suggestion of a similar name, as a question; empty if no name is similar.
        hint: String,
    },
    /// Name that belongs to no parameter of the sampler.
    #[error("{sampler} has no parameter “{name}”{hint}: {known}")]
    UnknownParameter {
        /// Name of the sampler.
        sampler: &'static str,
        /// Name of the parameter that was to be set.
        name: String,
        /// Suggestion of a similar name, as a question; empty if no name is similar.
        hint: String,
        /// Sentence about the parameters that can be set.
        known: String,
    },
    /// Value that a parameter cannot have.
    #[error("{sampler}: {parameter}={value} is not allowed: expected a number ({expected})")]
    Value {
        /// Name of the sampler.
        sampler: &'static str,
        /// Name of the parameter.
        parameter: &'static str,
        /// Value that was asked for.
        value: String,
        /// Description of the values that are allowed.
        expected: String,
    },
    /// Power cells that could not be given equal masses.
    #[error(
        "{sampler}: the {n} cells could not be given equal masses (they still differ by {error:.1e} of a \
         mass): use another n or seed, or a smoother density"
    )]
    Unequal {
        /// Name of the sampler.
        sampler: &'static str,
        /// Number of points, each of which has one cell.
        n: usize,
        /// Largest relative deviation of a cell's mass from the common mass.
        error: f64,
    },
    /// Number of points that does not fit into memory.
    #[error("{n} points were asked for, but at most {max} can be made: ask for fewer")]
    TooMany {
        /// Number of points asked for.
        n: usize,
        /// Largest number of points that can be made.
        max: usize,
    },
    /// Window so long and thin that a pattern in it has no meaning.
    #[error(
        "the window is {aspect:.3e} times as long as wide, but at most {max:.0e} is possible: use a wider \
         window"
    )]
    TooThin {
        /// Ratio of the longer side to the shorter one.
        aspect: f64,
        /// Largest ratio that is allowed.
        max: f64,
    },
    /// Rows of a target curve that do not describe a curve.
    #[error("{what} {problem}")]
    Target {
        /// Kind of the curve, as the subject of the message.
        what: &'static str,
        /// Description of the problem, as the predicate of the message.
        problem: String,
    },
    /// Too little room for all points, in every attempt.
    #[error(
        "{sampler} found room for at most {placed} of {n} points in {attempts} attempts: use another n or a wider window"
    )]
    NoRoom {
        /// Name of the sampler.
        sampler: &'static str,
        /// Number of points asked for.
        n: usize,
        /// Largest number of points that any attempt placed.
        placed: usize,
        /// Number of attempts that were made.
        attempts: usize,
    },
}

/// Largest number of edits (insertions, deletions, replacements of a letter) at which a similar
/// name is suggested.
///
/// Names that differ by more edits are taken for other words.
const MISSPELT: usize = 3;

impl SampleError {
    /// Returns the error for the sampler name `name`, with a suggestion from `names`.
    pub(super) fn unknown(name: &str, names: &[&str]) -> Self {
        Self::Unknown { name: name.to_owned(), names: names.join(", "), hint: hint(name, names) }
    }

    /// Returns the error for the parameter name `name`, with a suggestion from `parameters`.
    pub(super) fn unknown_parameter(sampler: &'static str, name: &str, parameters: &[Parameter]) -> Self {
        let names: Vec<&str> = parameters.iter().map(|p| p.name).collect();
        let known = match names.is_empty() {
            true => "it has no parameters".to_owned(),
            false => format!("choose from {}", names.join(", ")),
        };
        Self::UnknownParameter { sampler, name: name.to_owned(), hint: hint(name, &names), known }
    }
}

/// Returns a suggestion of the name most similar to `name`, or an empty text if none is similar.
fn hint(name: &str, names: &[&str]) -> String {
    let resembling = names.iter().map(|n| (strsim::levenshtein(name, n), n)).min();
    match resembling {
        Some((edits, closest)) if edits <= MISSPELT => format!(" (did you mean {closest}?)"),
        _ => String::new(),
    }
}
