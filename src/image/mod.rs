//! Reading PNG and TIFF as one grey plane, padding, Gaussian and Fourier filters. Knows nothing of cones.

mod empty;
mod error;
mod fourier;
mod gaussian;
mod imaged;
mod outline;
mod pad;
mod read;
mod rows;
mod write;

pub use empty::EmptyPixels;
pub use error::ImageError;
pub(crate) use fourier::signed_frequency;
pub use fourier::{Spectrum, fast_length};
pub use gaussian::gaussian;
pub use imaged::{ImagedPart, imaged_mask, imaged_part};
pub use outline::imaged_area;
pub use pad::{block_means, crop, mirror, reflect_pad};
pub use read::{MAX_PIXELS, decode, is_image_path, read, read_bytes};
pub(crate) use rows::{PARALLEL_PIXELS, fill_rows};
pub use write::{BitDepth, write_grey, write_png, write_tiff};

/// Grey values, one `f32` a pixel, indexed `[[y, x]]`; (0, 0) is the top-left pixel. Stored row by row.
pub type Plane = ndarray::Array2<f32>;
