use super::grey::{Alpha, Layout, luma};
use super::{MAX_PIXELS, check_size};
use crate::image::error::one_line;
use crate::image::{ImageError, Plane};
use std::io::{Cursor, ErrorKind};
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{TiffError, TiffFormatError};

/// Value of the tag PhotometricInterpretation for grey with white as 0 (TIFF 6.0, p. 37).
const WHITE_IS_ZERO: u16 = 0;
/// Value of the tag PhotometricInterpretation for grey with black as 0.
const BLACK_IS_ZERO: u16 = 1;
/// Value of the tag PhotometricInterpretation for colour.
const RGB: u16 = 2;
/// Value of the tag PhotometricInterpretation for indexes of a palette.
const PALETTE: u16 = 3;
/// Bits of the tag NewSubfileType (TIFF 6.0, p. 36) for a smaller version of another image and for
/// a transparency mask.
const NOT_AN_IMAGE: u32 = 0b101;
/// Value of the tag ExtraSamples for alpha that is not yet multiplied in (TIFF 6.0, p. 31).
const UNASSOCIATED_ALPHA: u16 = 2;
/// Value of the tag ExtraSamples for alpha that is already multiplied in.
const ASSOCIATED_ALPHA: u16 = 1;
/// Value of the tag PlanarConfiguration for samples stored plane by plane.
const PLANAR: u16 = 2;

/// Decoder of a TIFF file in memory.
type Source<'a> = Decoder<Cursor<&'a [u8]>>;

/// Decodes the only picture in the bytes of a TIFF file.
pub(in crate::image) fn decode(bytes: &[u8], name: &str) -> Result<Plane, ImageError> {
    let place = Place { name };
    let mut decoder = open(bytes).map_err(|e| place.failed(e))?;
    let directory = decoder.ifd_pointer().map_or(0, |p| p.0);
    let pages = count_pages(&mut decoder);
    if pages > 1 && !is_next_missing(bytes, directory) {
        return Err(ImageError::SeveralPages { name: name.to_owned(), pages });
    }
    let mut decoder = open(bytes).map_err(|e| place.failed(e))?;
    let (width, height) = decoder.dimensions().map_err(|e| place.failed(e))?;
    check_size(width, height, name)?;
    let photometric = tag::<u16>(&mut decoder, Tag::PhotometricInterpretation).unwrap_or(BLACK_IS_ZERO);
    match photometric {
        WHITE_IS_ZERO | BLACK_IS_ZERO | RGB => samples_to_grey(&mut decoder, photometric == RGB, &place),
        PALETTE => palette_to_grey(bytes, &mut decoder, &place),
        other => Err(place.unsupported(format!("photometric interpretation {other}"))),
    }
}

/// Opens the bytes of a file, with limits on the memory that decoding may take.
fn open(bytes: &[u8]) -> Result<Source<'_>, TiffError> {
    let mut limits = Limits::default();
    // the largest kind of pixel that is read, RGBA of 32 bits, takes 16 bytes
    limits.decoding_buffer_size = 16 * MAX_PIXELS;
    // in bytes: 512 MiB for buffers within the decoder, 16 MiB for the value of one tag
    limits.intermediate_buffer_size = 1 << 29;
    limits.ifd_value_size = 16 << 20;
    Ok(Decoder::new(Cursor::new(bytes))?.with_limits(limits))
}

/// Returns the number of pages in the file, without smaller versions and masks of another page.
///
/// A page that cannot be parsed counts, too.
fn count_pages(decoder: &mut Source) -> usize {
    let mut pages = 1;
    while decoder.more_images() {
        if decoder.next_image().is_err() {
            return pages + 1;
        }
        let kind = tag::<u32>(decoder, Tag::NewSubfileType).unwrap_or(0);
        pages += usize::from(kind & NOT_AN_IMAGE == 0);
    }
    pages
}

/// Returns whether the file says nothing of a second page: the offset of the next directory, which
/// follows the entries of the first one, is missing or lies beyond the end of the file.
///
/// Some instruments leave the field out: a value of the directory, or the pixels, are stored in its
/// place.
fn is_next_missing(bytes: &[u8], directory: u64) -> bool {
    let fields = Fields::of(bytes);
    let found = || {
        let start = usize::try_from(directory).ok()?;
        let (count_bytes, entry_bytes, value_at) = fields.sizes();
        let value_bytes = entry_bytes - value_at;
        let entries = usize::try_from(fields.number(start, count_bytes)?).ok()?;
        let end = start.checked_add(count_bytes)?.checked_add(entries.checked_mul(entry_bytes)?)?;
        let Some(next) = fields.number(end, value_bytes) else { return Some(true) };
        if next >= bytes.len() as u64 {
            return Some(true);
        }
        let field = end as u64..end as u64 + value_bytes as u64;
        let taken = |at: usize| {
            let [kind, tag] = [fields.number(at + 2, 2)?, fields.number(at, 2)?];
            let count = fields.number(at + 4, value_at - 4)?;
            let size = match kind {
                1 | 2 | 6 | 7 => 1,
                3 | 8 => 2,
                4 | 9 | 11 | 13 => 4,
                _ => 8u64,
            };
            let outside = count.checked_mul(size)? > value_bytes as u64;
            // a single strip of pixels has its offset in the entry itself
            let strip = tag == u64::from(Tag::StripOffsets.to_u16());
            let offset = fields.number(at + value_at, if outside || size >= 4 { value_bytes } else { 2 })?;
            Some((outside || strip && count == 1) && field.contains(&offset))
        };
        Some((0..entries).any(|i| taken(start + count_bytes + i * entry_bytes) == Some(true)))
    };
    found().unwrap_or(false)
}

/// Numbers in the bytes of a TIFF file, in its byte order.
struct Fields<'a> {
    bytes: &'a [u8],
    little: bool,
    big_tiff: bool,
}

impl<'a> Fields<'a> {
    fn of(bytes: &'a [u8]) -> Self {
        let little = bytes.starts_with(b"II");
        // the version after the byte order is 42 (“*”) in a classic TIFF and 43 (“+”) in a BigTIFF
        let big_tiff = bytes.get(if little { 2 } else { 3 }) == Some(&b'+');
        Self { bytes, little, big_tiff }
    }

    /// Returns the number of bytes of the number of entries, of an entry, and of the part of an
    /// entry before its value.
    const fn sizes(&self) -> (usize, usize, usize) {
        if self.big_tiff { (8, 20, 12) } else { (2, 12, 8) }
    }

    /// Returns the unsigned number of `length` bytes at `from`, or `None` beyond the end.
    fn number(&self, from: usize, length: usize) -> Option<u64> {
        let field = self.bytes.get(from..from.checked_add(length)?)?;
        let join = |sum: u64, &byte: &u8| sum << 8 | u64::from(byte);
        Some(if self.little { field.iter().rev().fold(0, join) } else { field.iter().fold(0, join) })
    }
}

/// Returns the value of a tag, or `None` if the tag is missing or of another type.
fn tag<T: TryFrom<u64>>(decoder: &mut Source, tag: Tag) -> Option<T> {
    decoder.find_tag_unsigned(tag).ok().flatten()
}

/// Returns the first value of a tag that may have several, or `None` if the tag is missing or of
/// another type.
fn first(decoder: &mut Source, tag: Tag) -> Option<u16> {
    decoder.find_tag_unsigned_vec::<u16>(tag).ok().flatten()?.first().copied()
}

/// Decodes a picture of grey or colour samples.
fn samples_to_grey(decoder: &mut Source, colour: bool, place: &Place) -> Result<Plane, ImageError> {
    let (width, height) = decoder.dimensions().map_err(|e| place.failed(e))?;
    let bits = first(decoder, Tag::BitsPerSample).unwrap_or(1);
    let channels = tag::<u16>(decoder, Tag::SamplesPerPixel).unwrap_or(1);
    let extra = first(decoder, Tag::ExtraSamples);
    let colours = if colour { 3 } else { 1 };
    let has_alpha = channels > colours && matches!(extra, Some(ASSOCIATED_ALPHA | UNASSOCIATED_ALPHA));
    if channels != colours + u16::from(has_alpha) {
        return Err(
            place.unsupported(format!("{channels} channels, expected grey or RGB, with or without alpha"))
        );
    }
    let layout = Layout {
        width: width as usize,
        height: height as usize,
        channels: usize::from(channels),
        colour,
        alpha: if has_alpha && extra == Some(UNASSOCIATED_ALPHA) { Alpha::Straight } else { Alpha::None },
        planar: tag::<u16>(decoder, Tag::PlanarConfiguration) == Some(PLANAR),
    };
    let samples = read_samples(decoder, place)?;
    let unsigned = |max: f64| move |v: f64| (v / max) as f32;
    let grey = match samples {
        DecodingResult::U8(v) if bits < 8 && channels == 1 => {
            let max = f64::from((1u16 << bits) - 1);
            layout.grey(&unpack(&v, bits, layout.width, layout.height), |v| unsigned(max)(f64::from(v)))
        }
        DecodingResult::U8(v) if bits == 8 => layout.grey(&v, |v| f32::from(v) / f32::from(u8::MAX)),
        DecodingResult::U16(v) if bits == 16 => layout.grey(&v, |v| f32::from(v) / f32::from(u16::MAX)),
        DecodingResult::U32(v) if bits == 32 => {
            layout.grey(&v, |v| unsigned(f64::from(u32::MAX))(f64::from(v)))
        }
        DecodingResult::U64(v) => layout.grey(&v, |v| unsigned(u64::MAX as f64)(v as f64)),
        DecodingResult::I8(v) => layout.grey(&v, |v| f32::from(v) / f32::from(i8::MAX)),
        DecodingResult::I16(v) => layout.grey(&v, |v| f32::from(v) / f32::from(i16::MAX)),
        DecodingResult::I32(v) => layout.grey(&v, |v| unsigned(f64::from(i32::MAX))(f64::from(v))),
        DecodingResult::I64(v) => layout.grey(&v, |v| unsigned(i64::MAX as f64)(v as f64)),
        DecodingResult::F16(v) => layout.grey(&v, f32::from),
        DecodingResult::F32(v) => layout.grey(&v, |v| v),
        DecodingResult::F64(v) => layout.grey(&v, |v| v as f32),
        _ => return Err(place.unsupported(format!("{bits} bits per sample"))),
    };
    grey.ok_or_else(|| place.too_few())
}

/// Reads every sample of the picture, in all planes.
fn read_samples(decoder: &mut Source, place: &Place) -> Result<DecodingResult, ImageError> {
    let mut samples = DecodingResult::U8(Vec::new());
    decoder.read_image_to_buffer(&mut samples).map_err(|e| place.failed(e))?;
    Ok(samples)
}

/// Unpacks samples of fewer than 8 bits, from the most significant bits of each byte to the least.
///
/// Every row begins with a new byte.
fn unpack(packed: &[u8], bits: u16, width: usize, height: usize) -> Vec<u8> {
    let bits = usize::from(bits);
    let row_bytes = (width * bits).div_ceil(8);
    let mask = (1u16 << bits) - 1;
    let sample = |row: &[u8], x: usize| {
        let (byte, shift) = (x * bits / 8, 16 - bits - x * bits % 8);
        // two bytes are needed, because samples of 3, 5, 6 and 7 bits may lie across a boundary of
        // bytes
        let pair = u16::from_be_bytes([row[byte], row.get(byte + 1).copied().unwrap_or(0)]);
        ((pair >> shift) & mask) as u8
    };
    let rows = packed.chunks_exact(row_bytes).take(height);
    rows.flat_map(|row| (0..width).map(move |x| sample(row, x))).collect()
}

/// Decodes a picture of palette indexes.
///
/// The decoder refuses palettes. The indexes in such a file are stored in the same way as grey
/// samples, so the decoder gets a copy of the file that declares them as grey.
fn palette_to_grey(bytes: &[u8], decoder: &mut Source, place: &Place) -> Result<Plane, ImageError> {
    let (width, height) = decoder.dimensions().map_err(|e| place.failed(e))?;
    let bits = first(decoder, Tag::BitsPerSample).unwrap_or(1);
    if bits > 16 || tag::<u16>(decoder, Tag::SamplesPerPixel).unwrap_or(1) != 1 {
        return Err(
            place.unsupported("a palette of more than 16 bits or with additional channels".to_owned())
        );
    }
    let colours = decoder.get_tag_u16_vec(Tag::ColorMap).map_err(|e| place.failed(e))?;
    let entries = 1usize << bits;
    let [red, green, blue] = [0, 1, 2].map(|c| colours.get(c * entries..(c + 1) * entries));
    let (Some(red), Some(green), Some(blue)) = (red, green, blue) else {
        return Err(place.damaged(format!(
            "a palette of {} numbers, expected {}",
            colours.len(),
            3 * entries
        )));
    };
    let scale = |v: u16| f32::from(v) / f32::from(u16::MAX);
    let lookup = |index: usize| {
        let index = index.min(entries - 1);
        luma(scale(red[index]), scale(green[index]), scale(blue[index]))
    };
    let directory = decoder.ifd_pointer().map_or(0, |p| p.0);
    let Some(copy) = called_grey(bytes, directory) else {
        return Err(place.damaged("no photometric interpretation".to_owned()));
    };
    let mut decoder = open(&copy).map_err(|e| place.failed(e))?;
    let (width, height) = (width as usize, height as usize);
    let layout = Layout { width, height, channels: 1, colour: false, alpha: Alpha::None, planar: false };
    let grey = match read_samples(&mut decoder, place)? {
        DecodingResult::U8(v) if bits < 8 => {
            layout.grey(&unpack(&v, bits, width, height), |i| lookup(i.into()))
        }
        DecodingResult::U8(v) if bits == 8 => layout.grey(&v, |i| lookup(i.into())),
        DecodingResult::U16(v) if bits == 16 => layout.grey(&v, |i| lookup(i.into())),
        _ => return Err(place.unsupported(format!("a palette of {bits} bits"))),
    };
    grey.ok_or_else(|| place.too_few())
}

/// Returns a copy of the file in which the directory at `offset` declares the samples as grey
/// (BlackIsZero).
///
/// Returns `None` if that directory has no photometric interpretation.
fn called_grey(bytes: &[u8], offset: u64) -> Option<Vec<u8>> {
    let fields = Fields::of(bytes);
    let number = |from, length| fields.number(from, length);
    let start = usize::try_from(offset).ok()?;
    let (count_bytes, entry_bytes, value_at) = fields.sizes();
    let entries = usize::try_from(number(start, count_bytes)?).ok()?;
    let wanted = u64::from(Tag::PhotometricInterpretation.to_u16());
    let entry = (0..entries)
        .map_while(|i| start.checked_add(count_bytes)?.checked_add(i.checked_mul(entry_bytes)?))
        .take_while(|&at| at < bytes.len())
        .find(|&at| number(at, 2) == Some(wanted))?;
    // a value of type 4 has 32 bits, any other is taken for one of 16 bits
    let long = number(entry + 2, 2)? == 4;
    let value: &[u8] = match (fields.little, long) {
        (true, false) => &[1, 0],
        (false, false) => &[0, 1],
        (true, true) => &[1, 0, 0, 0],
        (false, true) => &[0, 0, 0, 1],
    };
    let at = entry + value_at;
    let mut copy = bytes.to_vec();
    copy.get_mut(at..at + value.len())?.copy_from_slice(value);
    Some(copy)
}

/// File that an error is about.
struct Place<'a> {
    /// Name of the file.
    name: &'a str,
}

impl Place<'_> {
    /// Returns the error for a damaged file; `reason` says what is wrong with it.
    fn damaged(&self, reason: String) -> ImageError {
        ImageError::Damaged { name: self.name.to_owned(), format: "TIFF", reason }
    }

    /// Returns the error for a file of a kind that is not read; `reason` names the kind.
    fn unsupported(&self, reason: String) -> ImageError {
        ImageError::Unsupported { name: self.name.to_owned(), format: "TIFF", reason }
    }

    /// Returns the error for a file that contains fewer pixels than its header says.
    fn too_few(&self) -> ImageError {
        self.damaged("fewer pixels than its header says".to_owned())
    }

    /// Converts an error of the decoder into one that names the file and a remedy.
    fn failed(&self, error: TiffError) -> ImageError {
        match error {
            TiffError::FormatError(TiffFormatError::InvalidDimensions(width, height)) => {
                ImageError::NoPixels { name: self.name.to_owned(), width, height }
            }
            TiffError::IoError(e) if e.kind() == ErrorKind::UnexpectedEof => {
                self.damaged("it ends too early".to_owned())
            }
            TiffError::UnsupportedError(e) => self.unsupported(one_line(e)),
            TiffError::LimitsExceeded => ImageError::TooLarge {
                name: self.name.to_owned(),
                size: "the size given in its header".to_owned(),
                limit: format!("{MAX_PIXELS} pixels"),
            },
            other => self.damaged(one_line(other)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a grey TIFF of 2 × 2 px. Its resolution is stored right after the entries if
    /// `next` is `None`, and after the field for the next directory otherwise.
    fn small(next: Option<u32>) -> Vec<u8> {
        let entries = 7u16;
        let values = 10 + 12 * u32::from(entries) + if next.is_some() { 4 } else { 0 };
        let mut bytes = b"II*\0\x08\0\0\0".to_vec();
        bytes.extend(entries.to_le_bytes());
        for (tag, kind, count, value) in [
            (256u16, 4u16, 1u32, 2u32),
            (257, 4, 1, 2),
            (258, 3, 1, 8),
            (262, 3, 1, 1),
            (273, 4, 1, values + 8),
            (279, 4, 1, 4),
            (282, 5, 1, values),
        ] {
            bytes.extend([tag.to_le_bytes(), kind.to_le_bytes()].concat());
            bytes.extend([count.to_le_bytes(), value.to_le_bytes()].concat());
        }
        bytes.extend(next.into_iter().flat_map(u32::to_le_bytes));
        bytes.extend([20u32.to_le_bytes(), 1u32.to_le_bytes()].concat());
        bytes.extend([0, 51, 102, 255]);
        bytes
    }

    #[test]
    fn a_missing_offset_of_the_next_page_is_no_page() {
        let plain = decode(&small(Some(0)), "a.tif").unwrap();
        assert_eq!(decode(&small(None), "a.tif").unwrap(), plain);
        assert_eq!(decode(&small(Some(u32::MAX)), "a.tif").unwrap(), plain);
        let stack = decode(&small(Some(8 + 12)), "a.tif");
        assert!(matches!(stack, Err(ImageError::SeveralPages { .. })), "{stack:?}");
    }
}
