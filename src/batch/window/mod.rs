//! Windows: the areas in which the cones of an image, or the points of a file, could have been
//! seen.

mod crop;
mod length;
mod of_coordinates;
mod of_image;

pub use crop::Crop;
pub use length::Length;
pub use of_coordinates::Region;
pub use of_image::ImageWindow;

pub(super) use of_coordinates::Regions;
pub(super) use of_image::{Cut, ImageWindows};
