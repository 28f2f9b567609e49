//! Error for an invalid choice: a word that is not among the values that an option accepts.
//!
//! # Examples
//! ```
//! use conemosaic::image::Modality;
//!
//! let error = "infrared".parse::<Modality>().unwrap_err();
//! assert_eq!(error.choices(), ["confocal", "split", "histology"]);
//! ```

use strum::VariantNames;
use thiserror::Error;

/// Error for an invalid choice: a word that names no variant of an enum.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("“{given}” is not one of {}", .choices.join(", "))]
pub struct UnknownChoice {
    given: String,
    choices: &'static [&'static str],
}

impl UnknownChoice {
    /// Returns the error for the word `given`, which names no variant of the enum `T`.
    pub fn among<T: VariantNames>(given: &str) -> Self {
        Self { given: given.to_owned(), choices: T::VARIANTS }
    }

    /// Returns the words that would have been accepted.
    pub const fn choices(&self) -> &'static [&'static str] {
        self.choices
    }
}

#[cfg(test)]
mod tests {
    use crate::image::Modality;

    #[test]
    fn the_error_names_every_choice() {
        let error = "infrared".parse::<Modality>().unwrap_err();
        assert_eq!(error.to_string(), "“infrared” is not one of confocal, split, histology");
        assert_eq!(error.choices(), ["confocal", "split", "histology"]);
    }
}
