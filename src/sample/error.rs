use super::Parameter;
use thiserror::Error;

/// Points that could not be made.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SampleError {
    /// No sampler has that name.
    #[error("there is no sampler “{name}”{hint}: there are {names}")]
    Unknown {
        /// What was asked for.
        name: String,
        /// Every name there is.
        names: String,
        /// The name that may have been meant, as a question; empty if none resembles it.
        hint: String,
    },
    /// The sampler has no parameter of that name.
    #[error("{sampler} has no parameter “{name}”{hint}: {known}")]
    UnknownParameter {
        /// Name of the sampler.
        sampler: &'static str,
        /// What was to be set.
        name: String,
        /// The name that may have been meant, as a question; empty if none resembles it.
        hint: String,
        /// What can be set.
        known: String,
    },
    /// A parameter cannot have that value.
    #[error("{sampler}: {parameter}={value} is not possible: expected a number, {expected}")]
    Value {
        /// Name of the sampler.
        sampler: &'static str,
        /// Name of the parameter.
        parameter: &'static str,
        /// What it was to be.
        value: String,
        /// What it can be.
        expected: String,
    },
    /// Cells could not be made equal.
    #[error(
        "{sampler}: the masses of {n} cells stay {error:.1e} (relative) apart: use another n or seed, or a smoother density"
    )]
    Unequal {
        /// Name of the sampler.
        sampler: &'static str,
        /// Number of points.
        n: usize,
        /// Greatest relative deviation of a mass.
        error: f64,
    },
    /// More points than fit into memory.
    #[error("{n} points were asked for: at most {max} can be made")]
    TooMany {
        /// Asked for.
        n: usize,
        /// The most there can be.
        max: usize,
    },
    /// A window so long and thin that a pattern in it has no meaning.
    #[error("the window is {aspect:.3e} times as long as wide: at most {max:.0e} is possible")]
    TooThin {
        /// Longer side over shorter side.
        aspect: f64,
        /// The most it can be.
        max: f64,
    },
    /// A curve to be reached is none.
    #[error("{what} {problem}")]
    Target {
        /// Which kind of curve.
        what: &'static str,
        /// What is wrong with it.
        problem: String,
    },
    /// Every attempt ran full before the last point was placed.
    #[error(
        "{sampler} found room for at most {placed} of {n} points in {attempts} attempts: use another n or a wider window"
    )]
    NoRoom {
        /// Name of the sampler.
        sampler: &'static str,
        /// Asked for.
        n: usize,
        /// The most points any attempt placed.
        placed: usize,
        /// How often it began anew.
        attempts: usize,
    },
}

/// Names that differ by more letters are other words.
const MISSPELT: usize = 3;

impl SampleError {
    pub(super) fn unknown(name: &str, names: &[&str]) -> Self {
        Self::Unknown { name: name.to_owned(), names: names.join(", "), hint: hint(name, names) }
    }

    pub(super) fn unknown_parameter(sampler: &'static str, name: &str, parameters: &[Parameter]) -> Self {
        let names: Vec<&str> = parameters.iter().map(|p| p.name).collect();
        let known = match names.is_empty() {
            true => "it has no parameters".to_owned(),
            false => format!("it has {}", names.join(", ")),
        };
        Self::UnknownParameter { sampler, name: name.to_owned(), hint: hint(name, &names), known }
    }
}

fn hint(name: &str, names: &[&str]) -> String {
    let resembling = names.iter().map(|n| (strsim::levenshtein(name, n), n)).min();
    match resembling {
        Some((edits, closest)) if edits <= MISSPELT => format!(" (did you mean {closest}?)"),
        _ => String::new(),
    }
}
