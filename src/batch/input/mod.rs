//! What a batch works on: files and their names, which image and which marks belong together, scales,
//! manifests, tables of other graders.

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
