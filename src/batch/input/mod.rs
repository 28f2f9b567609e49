//! Inputs of a batch: the files and their names, the images that belong to marks, scales,
//! manifests, and tables of other graders.

mod files;
mod labels;
mod pairing;
mod readings;
mod scales;

pub use files::{Input, coordinate_files, image_files};
pub use labels::{GroupBy, Labels};
pub use scales::ScaleSource;

pub(super) use labels::Label;
pub(super) use pairing::{image_beside, image_in, image_name, says_coords};
pub(super) use readings::{Readings, chosen_columns};
