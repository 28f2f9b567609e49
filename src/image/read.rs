mod grey;
pub(super) mod png;
pub(super) mod tiff;

use super::{Format, ImageError, Plane};
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

/// Largest number of pixels an image may have: 2²⁷, some 11,500 × 11,500, whose grey values take
/// 512 MiB.
pub const MAX_PIXELS: usize = 1 << 27;
/// Largest size of a file in bytes: 2 GiB.
///
/// The largest kind of pixel that is read, RGBA of 32 bits, takes 16 bytes.
const MAX_BYTES: u64 = 16 * MAX_PIXELS as u64;

/// Reads the image in a PNG or TIFF file as one grey plane; see [`decode`].
///
/// # Errors
/// Fails if the file cannot be read, or if [`decode`] fails.
pub fn read(path: &Path) -> Result<Plane, ImageError> {
    decode(&read_bytes(path)?, &path.display().to_string())
}

/// Reads the bytes of a file, unless it is larger than 2 GiB.
///
/// An image of [`MAX_PIXELS`] takes at most this size.
///
/// # Errors
/// Fails if the file cannot be read or is larger than 2 GiB.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, ImageError> {
    let name = path.display().to_string();
    let unreadable = |source| ImageError::Read { name: name.clone(), source };
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(unreadable)?;
    file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > MAX_BYTES {
        let size = format!("a file of more than {MAX_BYTES} bytes");
        return Err(ImageError::TooLarge { name, size, limit: format!("{MAX_BYTES} bytes") });
    }
    Ok(bytes)
}

/// Decodes the image in the bytes of a PNG or TIFF file as one grey plane.
///
/// The format is recognised by the content; `name` serves for error messages only.
///
/// - Unsigned integers of b bits are divided by 2ᵇ − 1 and lie in [0, 1]. Signed ones are divided
///   by 2ᵇ⁻¹ − 1 and lie in [−1, 1]. Floating-point values stay as they are.
/// - Colour becomes its luma by Rec. 601, .299 R + .587 G + .114 B, as in MATLAB, OpenCV and
///   Pillow; equal R, G and B keep their value exactly. Palettes are looked up first. Gamma and
///   colour profiles are ignored. A colour-coded picture, in which two channels each dominate
///   at least 1 % of the pixels (cones drawn in red, green and blue), becomes the largest channel
///   instead, so that all colours are equally bright.
/// - Transparent pixels were not imaged and become black: grey is multiplied by alpha, unless the
///   file says that this was done already.
/// - TIFF may have strips or tiles, any byte order, and be a BigTIFF; it may be uncompressed or
///   compressed by LZW, Deflate or PackBits. WhiteIsZero is inverted. Thumbnails and masks beside
///   the image are skipped; several images are an error.
///
/// # Errors
/// Fails if the bytes are not a PNG or TIFF file, are damaged or are of a kind that is not read.
/// Fails also if the image is larger than [`MAX_PIXELS`], has no pixel, has several pages, or has a
/// pixel that is not a finite number.
pub fn decode(bytes: &[u8], name: &str) -> Result<Plane, ImageError> {
    if bytes.is_empty() {
        return Err(ImageError::Empty { name: name.to_owned() });
    }
    let Some(format) = Format::of_bytes(bytes) else {
        return Err(ImageError::NotAnImage { name: name.to_owned(), found: looks_like(bytes) });
    };
    let plane = (format.decode)(bytes, name)?;
    match plane.indexed_iter().find(|(_, v)| !v.is_finite()) {
        Some(((y, x), &value)) => Err(ImageError::NotFinite { name: name.to_owned(), x, y, value }),
        None => Ok(plane),
    }
}

/// Refuses images without a pixel and images that are unreasonably large.
fn check_size(width: u32, height: u32, name: &str) -> Result<(), ImageError> {
    let name = name.to_owned();
    if width == 0 || height == 0 {
        return Err(ImageError::NoPixels { name, width, height });
    }
    if u64::from(width) * u64::from(height) > MAX_PIXELS as u64 {
        let size = format!("{width} × {height} px");
        return Err(ImageError::TooLarge { name, size, limit: format!("{MAX_PIXELS} pixels") });
    }
    Ok(())
}

/// Describes the first bytes of a file that has none of the formats that are read.
fn looks_like(bytes: &[u8]) -> &'static str {
    /// First bytes of files of other common kinds, and their names in messages.
    const KINDS: [(&[u8], &str); 10] = [
        (b"\x89PNG", "a damaged PNG signature (was it transferred as text?)"),
        (b"\xff\xd8\xff", "a JPEG image"),
        (b"GIF8", "a GIF image"),
        (b"BM", "a BMP image"),
        (b"RIFF", "a WebP image or an AVI film"),
        (b"%PDF", "a PDF document"),
        (b"PK\x03\x04", "a ZIP archive"),
        (b"\x1f\x8b", "a gzip archive"),
        (b"\x89HDF", "an HDF5 or MATLAB file"),
        (b"MATLAB 5.0", "a MATLAB file"),
    ];
    if let Some((_, kind)) = KINDS.iter().find(|(signature, _)| bytes.starts_with(signature)) {
        return kind;
    }
    let start = &bytes[..bytes.len().min(512)];
    let text = start.iter().all(|&b| b >= 0x20 || matches!(b, b'\t' | b'\n' | b'\r'));
    if text { "text" } else { "data of an unknown kind" }
}
