//! Images as grey planes: reading and writing PNG and TIFF, padding, Gaussian and Fourier filters.
//!
//! The module knows nothing of cones.
//!
//! # Examples
//! ```
//! use conemosaic::image::{BitDepth, decode, gaussian, imaged_part, write_png};
//! use conemosaic::prelude::*;
//!
//! let grey = |(y, x): (usize, usize)| if x < 8 { 0. } else { (x + y) as f32 / 80. };
//! let plane = Plane::from_shape_fn((32, 48), grey);
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("image.png");
//! write_png(&path, &plane, BitDepth::Sixteen)?;
//!
//! let back = read(&path)?; // rows × columns, grey values from 0 to 1
//! assert_eq!(back.dim(), (32, 48));
//! assert_eq!(decode(&std::fs::read(&path)?, "image.png")?, back);
//! assert_eq!(imaged_part(&back).left, 8); // the black margin was not imaged
//! assert_eq!(gaussian(&back, 2.).dim(), back.dim());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

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
pub use imaged::{ImagedPart, furniture_share, imaged_mask, imaged_part};
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
