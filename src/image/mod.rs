//! Reading PNG and TIFF as one grey plane, padding, filters. Knows nothing of cones.

mod error;
mod read;
mod write;

pub use error::ImageError;
pub use read::{MAX_PIXELS, decode, is_image_path, read};
pub use write::{BitDepth, write_grey, write_png, write_rgb_png, write_tiff};

/// Grey values, one `f32` a pixel, indexed `[[y, x]]`; (0, 0) is the top-left pixel. Stored row by row.
pub type Plane = ndarray::Array2<f32>;
