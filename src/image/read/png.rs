use super::grey::{Alpha, Layout};
use super::{MAX_PIXELS, check_size};
use crate::image::error::one_line;
use crate::image::{ImageError, Plane};
use image::codecs::png::PngDecoder;
use image::{ImageDecoder, Limits};
use std::io::Cursor;

/// Decodes the picture in the bytes of a PNG file.
///
/// The decoder itself expands palettes and samples of fewer than 8 bits.
pub(in crate::image) fn decode(bytes: &[u8], name: &str) -> Result<Plane, ImageError> {
    let failed = |error: image::ImageError| {
        let (name, format, reason) = (name.to_owned(), "PNG", one_line(&error));
        match error {
            image::ImageError::Unsupported(_) => ImageError::Unsupported { name, format, reason },
            _ => ImageError::Damaged { name, format, reason },
        }
    };
    if let Some((width, height)) = size_in_header(bytes) {
        check_size(width, height, name)?;
    }
    let mut limits = Limits::default();
    // the largest kind of pixel in a PNG file, RGBA of 16 bits, takes 8 bytes
    limits.max_alloc = Some(8 * MAX_PIXELS as u64);
    let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits).map_err(failed)?;
    let (width, height) = decoder.dimensions();
    check_size(width, height, name)?;
    if decoder.is_apng().map_err(failed)? {
        let reason = "animated".to_owned();
        return Err(ImageError::Unsupported { name: name.to_owned(), format: "PNG", reason });
    }
    let kind = decoder.color_type();
    let layout = Layout {
        width: width as usize,
        height: height as usize,
        channels: usize::from(kind.channel_count()),
        colour: kind.has_color(),
        alpha: if kind.has_alpha() { Alpha::Straight } else { Alpha::None },
        planar: false,
    };
    let two_bytes = kind.bytes_per_pixel() / kind.channel_count() == 2;
    let mut samples = vec![0u8; usize::try_from(decoder.total_bytes()).unwrap_or(0)];
    decoder.read_image(&mut samples).map_err(failed)?;
    let grey = if two_bytes {
        let (pairs, _) = samples.as_chunks::<2>();
        layout.grey(pairs, |pair| f32::from(u16::from_ne_bytes(pair)) / f32::from(u16::MAX))
    } else {
        layout.grey(&samples, |v| f32::from(v) / f32::from(u8::MAX))
    };
    let reason = "fewer pixels than its header says".to_owned();
    grey.ok_or_else(|| ImageError::Damaged { name: name.to_owned(), format: "PNG", reason })
}

/// Returns the width and the height in the header of a PNG file, or `None` if there is no header.
///
/// They are read here because the decoder gives no plain message if one of them is 0.
fn size_in_header(bytes: &[u8]) -> Option<(u32, u32)> {
    let number = |from: usize| bytes.get(from..from + 4)?.try_into().ok().map(u32::from_be_bytes);
    (bytes.get(12..16)? == b"IHDR").then_some(())?;
    Some((number(16)?, number(20)?))
}
