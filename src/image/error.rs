use super::{extensions_in_words, formats_in_words};
use std::io;
use thiserror::Error;

/// An image that cannot be read or written. `name` is its file.
#[derive(Debug, Error)]
pub enum ImageError {
    /// The file cannot be opened or read.
    #[error("{name}: cannot be read ({source}): check that it exists and may be read")]
    Read {
        /// The file.
        name: String,
        /// What the system says.
        source: io::Error,
    },
    /// The file cannot be written.
    #[error(
        "{name}: cannot be written ({source}): check that its folder exists, may be written to and has room"
    )]
    Write {
        /// The file.
        name: String,
        /// What the system says.
        source: io::Error,
    },
    /// Nothing in it.
    #[error("{name}: the file is empty: copy or export the image again")]
    Empty {
        /// The file.
        name: String,
    },
    /// None of the formats that are read, whatever it is called.
    #[error("{name}: expected a {formats} image, found {found}: save it as {formats}", formats = formats_in_words())]
    NotAnImage {
        /// The file.
        name: String,
        /// What its first bytes look like.
        found: &'static str,
    },
    /// It begins well and then does not go on.
    #[error("{name}: damaged or cut short {format} ({reason}): copy or export the image again")]
    Damaged {
        /// The file.
        name: String,
        /// Name of its format.
        format: &'static str,
        /// What the decoder says.
        reason: String,
    },
    /// Sound, but of a kind that is not read.
    #[error(
        "{name}: {format} of a kind that is not read ({reason}): save it as 8 or 16 bit grey {formats}",
        formats = formats_in_words()
    )]
    Unsupported {
        /// The file.
        name: String,
        /// Name of its format.
        format: &'static str,
        /// What kind.
        reason: String,
    },
    /// No width or no height.
    #[error("{name}: {width} × {height} px hold no picture: export the image again")]
    NoPixels {
        /// The file.
        name: String,
        /// Width in px.
        width: u32,
        /// Height in px.
        height: u32,
    },
    /// More than memory should be asked to hold.
    #[error("{name}: {size} is too large, at most {limit} can be read: cut the image into parts")]
    TooLarge {
        /// The file.
        name: String,
        /// How large it is.
        size: String,
        /// How large it may be.
        limit: String,
    },
    /// Several images in one file.
    #[error(
        "{name}: holds {pages} pages, expected one image: save the page to be measured (or the average) by itself"
    )]
    SeveralPages {
        /// The file.
        name: String,
        /// How many images.
        pages: usize,
    },
    /// A pixel that is infinite or not a number.
    #[error(
        "{name}: pixel ({x}, {y}) is {value}: every pixel must be a finite number; fill or crop what was not imaged"
    )]
    NotFinite {
        /// The file.
        name: String,
        /// Column, from 0.
        x: usize,
        /// Row, from 0.
        y: usize,
        /// What stands there.
        value: f32,
    },
    /// The name of the file to be written does not tell its format.
    #[error("{name}: expected a name that ends in {}", extensions_in_words())]
    UnknownExtension {
        /// The file.
        name: String,
    },
}

/// The message of a decoder on one line.
pub(super) fn one_line(error: impl std::fmt::Display) -> String {
    error.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
