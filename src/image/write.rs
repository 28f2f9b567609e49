use super::error::one_line;
use super::{Format, ImageError, Plane};
use crate::files::write_atomically;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use std::io::{self, Cursor, Write};
use std::path::Path;
use tiff::encoder::{TiffEncoder, colortype};

/// Number of bits per grey value in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BitDepth {
    /// Eight bits: 256 grey values.
    Eight,
    /// Sixteen bits: 65,536 grey values.
    Sixteen,
}

/// Writes a plane as grey PNG or TIFF, by the extension of the name (`.png`, `.tif`, `.tiff`).
///
/// Values from 0 to 1 are rounded to the nearest grey; values outside are clamped. If writing
/// fails, no incomplete file is left.
///
/// # Errors
/// Fails if the extension is none of these, a pixel is not a finite number, the plane has no pixel,
/// or the file cannot be written.
pub fn write_grey(path: &Path, plane: &Plane, depth: BitDepth) -> Result<(), ImageError> {
    let unknown = || ImageError::UnknownExtension { name: path.display().to_string() };
    (Format::of_path(path).ok_or_else(unknown)?.write)(path, plane, depth)
}

/// Writes a plane with values from 0 to 1 as grey PNG; see [`write_grey`].
///
/// # Errors
/// Fails if a pixel is not a finite number, the plane has no pixel, or the file cannot be written.
pub fn write_png(path: &Path, plane: &Plane, depth: BitDepth) -> Result<(), ImageError> {
    let (width, height) = check(path, plane)?;
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new(&mut bytes);
    let encoded = match depth {
        BitDepth::Eight => encoder.write_image(&eight_bits(plane), width, height, ExtendedColorType::L8),
        BitDepth::Sixteen => {
            let samples: Vec<u8> = sixteen_bits(plane).iter().flat_map(|v| v.to_ne_bytes()).collect();
            encoder.write_image(&samples, width, height, ExtendedColorType::L16)
        }
    };
    encoded.map_err(|e| unwritable(path, io::Error::other(one_line(e))))?;
    write_whole(path, &bytes)
}

/// Writes a plane with values from 0 to 1 as grey TIFF, uncompressed so that every program reads
/// it; see [`write_grey`].
///
/// # Errors
/// Fails if a pixel is not a finite number, the plane has no pixel, or the file cannot be written.
pub fn write_tiff(path: &Path, plane: &Plane, depth: BitDepth) -> Result<(), ImageError> {
    let (width, height) = check(path, plane)?;
    let mut bytes = Cursor::new(Vec::new());
    let encoded = TiffEncoder::new(&mut bytes).and_then(|mut encoder| match depth {
        BitDepth::Eight => encoder.write_image::<colortype::Gray8>(width, height, &eight_bits(plane)),
        BitDepth::Sixteen => encoder.write_image::<colortype::Gray16>(width, height, &sixteen_bits(plane)),
    });
    encoded.map_err(|e| unwritable(path, io::Error::other(one_line(e))))?;
    write_whole(path, bytes.get_ref())
}

/// Returns the width and the height of `plane` in px, after checking that it can be written.
///
/// `path` names the file in errors.
///
/// # Errors
/// Fails if the plane has no pixel, or if a pixel is not a finite number.
fn check(path: &Path, plane: &Plane) -> Result<(u32, u32), ImageError> {
    let name = || path.display().to_string();
    let (rows, columns) = plane.dim();
    let side = |pixels: usize| u32::try_from(pixels).unwrap_or(u32::MAX);
    let (width, height) = (side(columns), side(rows));
    if width == 0 || height == 0 {
        return Err(ImageError::NoPixels { name: name(), width, height });
    }
    match plane.indexed_iter().find(|(_, v)| !v.is_finite()) {
        Some(((y, x), &value)) => Err(ImageError::NotFinite { name: name(), x, y, value }),
        None => Ok((width, height)),
    }
}

fn eight_bits(plane: &Plane) -> Vec<u8> {
    plane.iter().map(|v| (v.clamp(0., 1.) * f32::from(u8::MAX)).round() as u8).collect()
}

fn sixteen_bits(plane: &Plane) -> Vec<u16> {
    plane.iter().map(|v| (v.clamp(0., 1.) * f32::from(u16::MAX)).round() as u16).collect()
}

fn unwritable(path: &Path, source: io::Error) -> ImageError {
    ImageError::Write { name: path.display().to_string(), source }
}

fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), ImageError> {
    write_atomically(path, |writer| writer.write_all(bytes)).map_err(|e| unwritable(path, e))
}
