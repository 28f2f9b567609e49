//! HTML pages about a run, a validation and the reproduced paper, all built on one skeleton.

mod document;
mod names;
mod paper;
mod run;
mod skeleton;
mod validation;

pub use document::{Document, Headline, Section};
pub use run::{expected_errors, page};
pub use validation::{ScoredImage, ValidationPage, validation_page};
