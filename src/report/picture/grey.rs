//! Grey pictures of images: contrast, enlargement and encoding.
//!
//! 1. [`stretched`] maps the grey values between two percentiles linearly to 0..255.
//! 2. [`enlarged`] interpolates linearly between pixel centres.
//! 3. [`png()`] encodes the pixels.

use crate::report::ReportError;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, GrayImage, ImageEncoder};
use ndarray::ArrayView2;

/// Share of the pixels that become black: a few dark pixels must not determine the contrast.
const BLACK: f64 = 0.005;
/// Share of the pixels that stay below white: a few bright pixels must not determine the contrast.
const WHITE: f64 = 0.995;

/// Approximate number of pixels from which a percentile is computed; more would only cost time.
///
/// Up to twice as many are used, because every n-th pixel is taken, with n odd.
const SAMPLE: usize = 1 << 17;

/// Returns the plane in 8 bits, its 0.5th percentile black and its 99.5th white.
///
/// A constant plane is mid-grey, and NaN is black.
pub(in crate::report) fn stretched(plane: ArrayView2<f32>) -> GrayImage {
    let (height, width) = plane.dim();
    // An odd step keeps the sample from running down a few columns of an image of even width.
    let step = (plane.len() / SAMPLE) | 1;
    let mut sample: Vec<f32> = plane.iter().step_by(step).copied().filter(|v| v.is_finite()).collect();
    let low = percentile(&mut sample, BLACK);
    let high = percentile(&mut sample, WHITE);
    let level = |v: f32| match high - low {
        _ if v.is_nan() => 0,
        range if range > 0. => ((v - low) / range * 255. + 0.5).clamp(0., 255.) as u8,
        _ => 128,
    };
    let pixels = plane.iter().map(|&v| level(v)).collect();
    GrayImage::from_raw(width as u32, height as u32, pixels).unwrap_or_default()
}

/// Returns the value below which a share (0–1) of the sample lies.
fn percentile(sample: &mut [f32], share: f64) -> f32 {
    if sample.is_empty() {
        return 0.;
    }
    let rank = ((sample.len() - 1) as f64 * share).round() as usize;
    *sample.select_nth_unstable_by(rank, f32::total_cmp).1
}

/// Returns the picture enlarged `factor` times, interpolated linearly between pixel centres.
///
/// The border is repeated. This is several times as fast as `image::imageops::resize`.
pub(super) fn enlarged(grey: &GrayImage, factor: u32) -> GrayImage {
    let factor = factor.max(1) as usize;
    let (width, height) = (grey.width() as usize, grey.height() as usize);
    if factor == 1 || width == 0 || height == 0 {
        return grey.clone();
    }
    // For every output pixel along a side: the two pixels it lies between, and the share of the
    // second.
    let taps = |size: usize| -> Vec<(usize, usize, f32)> {
        let tap = |i: usize| {
            let at = ((i as f32 + 0.5) / factor as f32 - 0.5).clamp(0., (size - 1) as f32);
            let first = at as usize;
            (first, (first + 1).min(size - 1), at - first as f32)
        };
        (0..size * factor).map(tap).collect()
    };
    let mix = |a: f32, b: f32, share: f32| a + (b - a) * share;
    let (columns, rows) = (taps(width), taps(height));
    let source = grey.as_raw();
    let line = |y: usize| &source[y * width..(y + 1) * width];
    let mut pixels = Vec::with_capacity(columns.len() * rows.len());
    for (above, below, share) in rows {
        let between: Vec<f32> =
            line(above).iter().zip(line(below)).map(|(&a, &b)| mix(a.into(), b.into(), share)).collect();
        pixels.extend(
            columns.iter().map(|&(left, right, s)| (mix(between[left], between[right], s) + 0.5) as u8),
        );
    }
    GrayImage::from_raw((width * factor) as u32, (height * factor) as u32, pixels).unwrap_or_default()
}

/// Encodes pixels as PNG, for speed rather than size, because a run writes hundreds of pictures.
pub(in crate::report) fn png(
    pixels: &[u8],
    width: u32,
    height: u32,
    colour: ExtendedColorType,
) -> Result<Vec<u8>, ReportError> {
    let mut bytes = Vec::with_capacity(pixels.len() / 2 + 1024);
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Sub)
        .write_image(pixels, width, height, colour)
        .map_err(|source| ReportError::Png { width, height, source })?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Plane;

    #[test]
    fn half_a_percent_at_either_end_saturates() {
        let plane = Plane::from_shape_fn((100, 100), |(y, x)| (y * 100 + x) as f32);
        let grey = stretched(plane.view());
        let share = |level: u8| grey.pixels().filter(|p| p.0[0] == level).count() as f64 / 1e4;
        assert!((0.005..0.009).contains(&share(0)), "{}", share(0));
        assert!((0.005..0.009).contains(&share(255)), "{}", share(255));
    }

    #[test]
    fn enlargement_keeps_pixel_centres_and_is_linear_between() {
        let grey = GrayImage::from_fn(20, 10, |x, y| image::Luma([(x * 8 + y * 5) as u8]));
        let large = enlarged(&grey, 3);
        assert_eq!(large.dimensions(), (60, 30));
        for (x, y, pixel) in grey.enumerate_pixels() {
            assert_eq!(large.get_pixel(3 * x + 1, 3 * y + 1), pixel);
        }
        assert_eq!(large.get_pixel(3 * 4 + 2, 3 * 2 + 1).0[0], 4 * 8 + 2 * 5 + 3);
        assert_eq!(enlarged(&GrayImage::new(0, 0), 4).dimensions(), (0, 0));
    }

    #[test]
    fn constant_planes_are_mid_grey_and_nan_is_black() {
        let mut plane = Plane::from_elem((4, 4), 7.);
        plane[[0, 1]] = f32::NAN;
        let grey = stretched(plane.view());
        assert_eq!((grey.get_pixel(0, 0).0[0], grey.get_pixel(1, 0).0[0]), (128, 0));
    }
}
