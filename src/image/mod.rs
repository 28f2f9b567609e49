//! Images as grey planes: reading and writing PNG and TIFF, padding, Gaussian and Fourier filters.
//!
//! The module knows nothing of cones.

mod empty;
mod error;
mod format;
mod fourier;
mod gaussian;
mod imaged;
mod modality;
mod outline;
mod pad;
mod read;
mod rows;
mod window;
mod write;

pub use empty::EmptyPixels;
pub use error::ImageError;
pub use format::{FORMATS, Format, extensions, extensions_in_words, formats_in_words, is_image_path};
pub(crate) use fourier::signed_frequency;
pub use fourier::{Spectrum, fast_length};
pub use gaussian::gaussian;
pub use imaged::{ImagedPart, imaged_mask, imaged_part};
pub use modality::{Modality, Polarity};
pub use outline::imaged_area;
pub use pad::{block_means, crop, mirror, reflect_pad};
pub use read::{MAX_PIXELS, decode, read, read_bytes};
pub(crate) use rows::{PARALLEL_PIXELS, fill_rows, plane_of, values};
pub use write::{BitDepth, write_grey, write_png, write_tiff};

/// Grey values, one `f32` per pixel, indexed `[[y, x]]` and stored row by row.
///
/// Pixel (0, 0) is the top-left one.
pub type Plane = ndarray::Array2<f32>;
