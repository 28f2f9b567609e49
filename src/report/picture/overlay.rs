use super::grey::{enlarged, png, stretched};
use super::ink::Shape;
use crate::image::Plane;
use crate::report::ReportError;
use image::{ExtendedColorType, Rgb, RgbImage};

/// Distance between neighbouring cones to which a picture is enlarged, in output px; nearer rings
/// would hide the cones.
const CLEAR_SPACING: f64 = 16.;
/// Largest side of an enlarged picture, in px; larger pictures are not enlarged.
const LARGEST_SIDE: usize = 4096;
/// Width of the line of a mark, in output px.
const LINE: f64 = 1.5;
/// Width of the dark line beneath a mark, in output px.
const HALO: f64 = 3.;
/// Opacity of the dark border around a mark, chosen by eye.
const HALO_OPACITY: f64 = 0.55;

/// The meaning of a mark.
///
/// Each kind has its own shape and colour (Okabe & Ito 2008, told apart by colour-blind readers).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MarkKind {
    /// A cone found, its truth unknown: an orange ring.
    Detection,
    /// A cone found and marked by hand: a blue ring.
    Hit,
    /// A cone marked by hand and not found: a yellow plus sign.
    Miss,
    /// A cone found and not marked by hand: a vermilion cross.
    FalseAlarm,
    /// A mark in the border, where nothing counts: a grey ring.
    Uncounted,
}

impl MarkKind {
    /// Returns red, green and blue of the mark.
    pub const fn colour(self) -> [u8; 3] {
        match self {
            Self::Detection => [0xE6, 0x9F, 0x00],
            Self::Hit => [0x56, 0xB4, 0xE9],
            Self::Miss => [0xF0, 0xE4, 0x42],
            Self::FalseAlarm => [0xD5, 0x5E, 0x00],
            Self::Uncounted => [0xA0, 0xA0, 0xA0],
        }
    }

    const fn shape(self) -> Shape {
        match self {
            Self::Detection | Self::Hit | Self::Uncounted => Shape::Ring,
            Self::Miss => Shape::Plus,
            Self::FalseAlarm => Shape::Cross,
        }
    }
}

/// Mark on an image.
///
/// All lengths are in px of the image; (0, 0) is the centre of its top-left pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverlayMark {
    /// Position of the mark along x, which points to the right.
    pub x: f64,
    /// Position of the mark along y, which points down.
    pub y: f64,
    /// Radius of a ring, or half the length of a cross.
    pub radius: f64,
    /// Meaning of the mark, with its shape and colour.
    pub kind: MarkKind,
}

/// Factor by which the border strip of the image, in which no mark counts, is darkened; chosen by
/// eye.
const BORDER_LIGHT: f64 = 0.5;

/// Draws an [`overlay()`] and darkens the border strip, in which no mark counts.
///
/// The strip is `border` px of the image wide.
pub fn overlay_with_border(picture: &Plane, marks: &[OverlayMark], spacing: f64, border: f64) -> RgbImage {
    draw(picture, marks, spacing, border)
}

/// Draws the image in grey, with `marks` on it.
///
/// The contrast is stretched from the 0.5th to the 99.5th percentile. The picture is enlarged by
/// the whole number that sets cones of `spacing` px at least 16 px apart, as long as no side
/// exceeds 4096 px; it is never reduced. Marks that are not finite are left out.
pub fn overlay(picture: &Plane, marks: &[OverlayMark], spacing: f64) -> RgbImage {
    draw(picture, marks, spacing, 0.)
}

/// Draws an overlay; a `border` of 0 darkens nothing.
fn draw(picture: &Plane, marks: &[OverlayMark], spacing: f64, border: f64) -> RgbImage {
    let (height, width) = picture.dim();
    let factor = enlargement(width, height, spacing);
    let grey = enlarged(&stretched(picture.view()), factor);
    let factor = f64::from(factor);
    let mut out = RgbImage::new(grey.width(), grey.height());
    let counts = |at: u32, side: u32| {
        let place = f64::from(at) + 0.5;
        place >= border * factor && f64::from(side) - place >= border * factor
    };
    for (x, y, pixel) in out.enumerate_pixels_mut() {
        let level = grey.get_pixel(x, y).0[0];
        let dark = border > 0. && !(counts(x, grey.width()) && counts(y, grey.height()));
        *pixel = Rgb([if dark { (f64::from(level) * BORDER_LIGHT) as u8 } else { level }; 3]);
    }
    let size = out.dimensions();
    for mark in marks.iter().filter(|m| m.x.is_finite() && m.y.is_finite() && m.radius.is_finite()) {
        // Pixel centres: position x of the image lies at (x + ½) factor − ½ of the enlarged image.
        let centre = ((mark.x + 0.5) * factor - 0.5, (mark.y + 0.5) * factor - 0.5);
        let radius = (mark.radius * factor).max(LINE);
        let shape = mark.kind.shape();
        shape.cover(size, centre, radius, HALO, |x, y, coverage| {
            blend(out.get_pixel_mut(x, y), [0; 3], coverage * HALO_OPACITY);
        });
        shape.cover(size, centre, radius, LINE, |x, y, coverage| {
            blend(out.get_pixel_mut(x, y), mark.kind.colour(), coverage);
        });
    }
    out
}

/// Returns the integer factor by which a picture is enlarged, at least 1.
fn enlargement(width: usize, height: usize, spacing: f64) -> u32 {
    let wanted = if spacing.is_finite() && spacing > 0. { (CLEAR_SPACING / spacing).ceil() } else { 1. };
    let allowed = LARGEST_SIDE / width.max(height).max(1);
    (wanted.min(allowed as f64) as u32).max(1)
}

/// Mixes a colour into a pixel.
fn blend(pixel: &mut Rgb<u8>, colour: [u8; 3], opacity: f64) {
    for (under, over) in pixel.0.iter_mut().zip(colour) {
        let mixed = f64::from(*under) * (1. - opacity) + f64::from(over) * opacity;
        *under = mixed.round() as u8;
    }
}

/// Encodes the picture as PNG, compressed for speed rather than size.
///
/// # Errors
/// Fails if the picture has no pixels.
pub fn encode_png(picture: &RgbImage) -> Result<Vec<u8>, ReportError> {
    png(picture.as_raw(), picture.width(), picture.height(), ExtendedColorType::Rgb8)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(x: f64, y: f64, kind: MarkKind) -> OverlayMark {
        OverlayMark { x, y, radius: 1.5, kind }
    }

    /// Returns the mean position of the pixels that are not grey, in px of the original.
    fn coloured_centre(out: &RgbImage, factor: f64) -> (f64, f64) {
        let coloured: Vec<_> = out
            .enumerate_pixels()
            .filter(|(_, _, p)| p.0.iter().max().unwrap() - p.0.iter().min().unwrap() > 60)
            .map(|(x, y, _)| ((f64::from(x) + 0.5) / factor - 0.5, (f64::from(y) + 0.5) / factor - 0.5))
            .collect();
        assert!(!coloured.is_empty());
        let n = coloured.len() as f64;
        (coloured.iter().map(|p| p.0).sum::<f64>() / n, coloured.iter().map(|p| p.1).sum::<f64>() / n)
    }

    #[test]
    fn marks_stand_where_the_cones_are_after_enlargement() {
        let picture = Plane::from_shape_fn((30, 40), |(y, x)| ((x * 7 + y * 3) % 11) as f32);
        for kind in [MarkKind::Detection, MarkKind::Hit, MarkKind::Miss, MarkKind::FalseAlarm] {
            let out = overlay(&picture, &[mark(12.3, 20.6, kind)], 4.);
            assert_eq!(out.dimensions(), (160, 120));
            let (x, y) = coloured_centre(&out, 4.);
            assert!((x - 12.3).abs() < 0.1 && (y - 20.6).abs() < 0.1, "{kind:?}: {x}, {y}");
        }
    }

    #[test]
    fn a_border_is_darkened_to_the_pixel_and_the_rest_is_not() {
        let picture = Plane::from_shape_fn((20, 30), |(y, x)| ((x * 7 + y * 3) % 11) as f32);
        let (plain, bordered) = (overlay(&picture, &[], 8.), overlay_with_border(&picture, &[], 8., 7.));
        for (x, y, pixel) in bordered.enumerate_pixels() {
            let inside = (14..46).contains(&x) && (14..26).contains(&y);
            let level = plain.get_pixel(x, y).0[0];
            assert_eq!(pixel.0[0], if inside { level } else { level / 2 }, "{x}, {y}");
        }
    }

    #[test]
    fn enlargement_separates_cones_but_never_exceeds_4096() {
        assert_eq!(enlargement(150, 150, 8.), 2);
        assert_eq!(enlargement(150, 150, 7.9), 3);
        assert_eq!(enlargement(150, 150, 40.), 1);
        assert_eq!(enlargement(2000, 100, 4.), 2);
        assert_eq!(enlargement(9000, 9000, 4.), 1);
        assert_eq!(enlargement(0, 0, f64::NAN), 1);
    }

    #[test]
    fn marks_that_are_not_finite_or_outside_are_left_out() {
        let picture = Plane::from_elem((8, 8), 1.);
        let marks = [mark(f64::NAN, 1., MarkKind::Hit), mark(1e7, -1e7, MarkKind::Miss)];
        assert_eq!(overlay(&picture, &marks, 16.), overlay(&picture, &[], 16.));
    }

    #[test]
    fn png_reads_back_to_the_same_pixels() {
        let picture = Plane::from_shape_fn((20, 30), |(y, x)| (x + y) as f32);
        let out = overlay(&picture, &[mark(5., 5., MarkKind::Hit)], 8.);
        let read = image::load_from_memory(&encode_png(&out).unwrap()).unwrap().to_rgb8();
        assert_eq!(read, out);
        assert!(encode_png(&RgbImage::new(0, 0)).is_err());
    }
}
