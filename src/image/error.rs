use super::{extensions_in_words, formats_in_words};
use std::io;
use thiserror::Error;

/// Reasons why an image cannot be read or written; in every variant, `name` is the name of the
/// file.
#[derive(Debug, Error)]
pub enum ImageError {
    /// File that cannot be opened or read.
    #[error("{name}: cannot be read ({source}): check that it exists and may be read")]
    Read {
        /// Name of the file.
        name: String,
        /// Error of the operating system.
        source: io::Error,
    },
    /// File that cannot be written.
    #[error(
        "{name}: cannot be written ({source}): check that its folder exists, may be written to and has room"
    )]
    Write {
        /// Name of the file.
        name: String,
        /// Error of the operating system.
        source: io::Error,
    },
    /// File without any content.
    #[error("{name}: the file is empty: copy or export the image again")]
    Empty {
        /// Name of the file.
        name: String,
    },
    /// File that has none of the formats that are read, whatever its name.
    #[error("{name}: expected a {formats} image, found {found}: save it as {formats}", formats = formats_in_words())]
    NotAnImage {
        /// Name of the file.
        name: String,
        /// Kind of file that the first bytes look like.
        found: &'static str,
    },
    /// File that begins as it should, but is damaged or cut short further on.
    #[error("{name}: the {format} file is damaged or incomplete ({reason}): copy or export the image again")]
    Damaged {
        /// Name of the file.
        name: String,
        /// Name of the file's format.
        format: &'static str,
        /// Message of the decoder.
        reason: String,
    },
    /// Sound file of a kind that is not read.
    #[error(
        "{name}: this kind of {format} image is not supported ({reason}): save it as 8-bit or 16-bit grey \
         {formats}",
        formats = formats_in_words()
    )]
    Unsupported {
        /// Name of the file.
        name: String,
        /// Name of the file's format.
        format: &'static str,
        /// Property of the image that is not supported, in words.
        reason: String,
    },
    /// Image without width or without height.
    #[error("{name}: an image of {width} × {height} px has no pixels: export the image again")]
    NoPixels {
        /// Name of the file.
        name: String,
        /// Width of the image in px.
        width: u32,
        /// Height of the image in px.
        height: u32,
    },
    /// Image or file that needs more memory than is reasonable.
    #[error("{name}: {size} is too large, since at most {limit} can be read: cut the image into parts")]
    TooLarge {
        /// Name of the file.
        name: String,
        /// Size of the image or the file, with its unit.
        size: String,
        /// Largest size that is read, with its unit.
        limit: String,
    },
    /// File that contains several images.
    #[error(
        "{name}: holds {pages} pages, expected one image: save the page to be measured (or the average of \
         all) as a file of its own"
    )]
    SeveralPages {
        /// Name of the file.
        name: String,
        /// Number of images in the file.
        pages: usize,
    },
    /// Pixel that is infinite or not a number.
    #[error(
        "{name}: pixel ({x}, {y}) is {value}, expected finite numbers only: fill or crop the parts that \
         were not imaged"
    )]
    NotFinite {
        /// Name of the file.
        name: String,
        /// Column of the pixel, from 0.
        x: usize,
        /// Row of the pixel, from 0.
        y: usize,
        /// Value of the pixel.
        value: f32,
    },
    /// Name of a file to be written that does not tell the format.
    #[error("{name}: the name does not say in which format to write: end it in {}", extensions_in_words())]
    UnknownExtension {
        /// Name of the file.
        name: String,
    },
}

/// Returns the message of a decoder on one line.
pub(super) fn one_line(error: impl std::fmt::Display) -> String {
    error.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
