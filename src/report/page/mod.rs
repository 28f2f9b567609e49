//! Pages to be read: of a run, of a validation, of the remade paper. All stand on one skeleton.

mod document;
mod names;
mod paper;
mod run;
mod skeleton;
mod validation;

pub use document::{Document, Headline, Section};
pub use run::{expected_errors, page};
pub use validation::{ScoredImage, ValidationPage, validation_page};
