use super::canvas::{Anchor, Area, Canvas, FRAME, INK, Style};
use super::{MosaicFigure, shown_unit, with_unit};
use crate::geometry::{Point, Rectangle, Window};
use crate::image::Plane;
use crate::mosaic::{LengthUnit, hexagonal_spacing};
use crate::report::ReportError;
use crate::report::picture::Shape;
use crate::report::picture::{png, stretched};
use crate::report::significant;
use image::imageops::thumbnail;
use image::{ExtendedColorType, GrayImage};
use ndarray::{Axis, Slice};

/// Side in px to which larger pictures are reduced before they are embedded.
///
/// Together with the limit on the area it leaves about 560 dpi in a row of square fields.
const LARGEST_SIDE: f64 = 1200.;
/// Area in px to which larger pictures are reduced before they are embedded.
const LARGEST_AREA: f64 = 0.6e6;
/// Number of points above which the points are embedded as a picture; as vectors, more points would
/// make the file large and slow to open.
const MOST_VECTOR_POINTS: usize = 4000;
/// Pixels per canvas unit of the picture of points (600 dpi).
const DOT_RESOLUTION: f64 = 6.;
/// Largest side of the picture of points, in px.
const LARGEST_DOT_SIDE: f64 = 1500.;
/// Radius of a point in hexagonal spacings.
const DOT_RADIUS: f64 = 0.2;
/// Smallest and largest radius of a point, in canvas units.
const DOT_RADIUS_BOUNDS: (f64, f64) = (0.1, 1.5);
/// Colour, on a picture, of the border of a window that is not a rectangle (orange of Okabe & Ito
/// 2008).
const OUTLINE_ON_PICTURE: &str = "#E69F00";
/// Width of the border of a window that is not a rectangle, in canvas units.
const OUTLINE_WIDTH: f64 = 0.8;
/// Largest share of the field's width that the scale bar takes.
const SCALE_BAR_SHARE: f64 = 0.4;

/// Map from the coordinates of a mosaic to the page.
///
/// In both y points down, and the scale is the same along x and y.
pub(super) struct Projection {
    area: Area,
    bounds: Rectangle,
    /// Canvas units per unit of the coordinates.
    pub(super) scale: f64,
}

impl Projection {
    /// Makes the map that takes `bounds` to `area`, which must have the same ratio of sides.
    pub(super) fn new(area: Area, bounds: Rectangle) -> Self {
        Self { area, bounds, scale: area.width / bounds.width() }
    }

    /// Returns the position of a point on the page.
    pub(super) fn place(&self, p: Point) -> (f64, f64) {
        (
            self.area.x + (p.x - self.bounds.x0()) * self.scale,
            self.area.y + (p.y - self.bounds.y0()) * self.scale,
        )
    }
}

/// Draws the part of the picture that lies inside the window.
pub(super) fn draw_picture(
    canvas: &mut Canvas,
    area: Area,
    figure: &MosaicFigure,
    picture: &Plane,
) -> Result<(), ReportError> {
    let bounds = figure.window.bounds();
    let projection = Projection::new(area, bounds);
    let (height, width) = picture.dim();
    let (columns, rows) = match figure.unit {
        LengthUnit::Pixel => {
            (pixels(bounds.x0(), bounds.x1(), width), pixels(bounds.y0(), bounds.y1(), height))
        }
        LengthUnit::Micrometre | LengthUnit::Unit => (0..width, 0..height),
    };
    if columns.is_empty() || rows.is_empty() {
        canvas.sentence(area, "No part of the picture lies inside the window.");
        return Ok(());
    }
    let place = match figure.unit {
        LengthUnit::Pixel => {
            let (x, y) = projection.place(Point::new(columns.start as f64 - 0.5, rows.start as f64 - 0.5));
            let scale = projection.scale;
            Area { x, y, width: columns.len() as f64 * scale, height: rows.len() as f64 * scale }
        }
        LengthUnit::Micrometre | LengthUnit::Unit => area,
    };
    let block = picture.slice_axis(Axis(0), Slice::from(rows)).slice_axis_move(Axis(1), Slice::from(columns));
    let grey = reduced(stretched(block));
    let bytes = png(grey.as_raw(), grey.width(), grey.height(), ExtendedColorType::L8)?;
    canvas.picture(&bytes, place, area);
    canvas.frame(area);
    draw_outline(canvas, &projection, figure.window, OUTLINE_ON_PICTURE);
    draw_scale_bar(canvas, area, figure);
    Ok(())
}

/// Returns the pixels of a row or column of `size` px that `from`..=`to` touches; pixel 0 covers
/// −½..½.
fn pixels(from: f64, to: f64, size: usize) -> std::ops::Range<usize> {
    // Bounds that are a hair beyond a pixel's edge must not take in the next pixel.
    let first = (from + 0.5 + 1e-6).floor().clamp(0., size as f64) as usize;
    let last = (to + 0.5 - 1e-6).ceil().clamp(0., size as f64) as usize;
    first..last
}

/// Returns the picture, reduced if its side or its area exceeds the limit.
fn reduced(grey: GrayImage) -> GrayImage {
    let (width, height) = (f64::from(grey.width()), f64::from(grey.height()));
    let factor = (LARGEST_SIDE / width.max(height)).min((LARGEST_AREA / (width * height)).sqrt());
    if factor >= 1. {
        return grey;
    }
    let side = |length: f64| ((length * factor).round() as u32).max(1);
    thumbnail(&grey, side(width), side(height))
}

/// Draws the points that lie in the window, and the border of the window.
pub(super) fn draw_points(canvas: &mut Canvas, area: Area, figure: &MosaicFigure) -> Result<(), ReportError> {
    let projection = Projection::new(area, figure.window.bounds());
    let inside = |p: &&Point| figure.window.contains(**p);
    let dots: Vec<_> = figure.points.iter().filter(inside).map(|&p| projection.place(p)).collect();
    if dots.is_empty() {
        canvas.sentence(area, "The mosaic has no points.");
    } else {
        let drawn = figure.window.area() * projection.scale * projection.scale;
        let spacing = hexagonal_spacing(dots.len(), drawn).unwrap_or_default();
        let radius = (spacing * DOT_RADIUS).clamp(DOT_RADIUS_BOUNDS.0, DOT_RADIUS_BOUNDS.1);
        if dots.len() <= MOST_VECTOR_POINTS {
            canvas.dots(&dots, radius);
        } else {
            draw_dot_picture(canvas, area, &dots, radius)?;
        }
        if figure.window.rings().is_empty() {
            canvas.frame(area);
        }
        draw_outline(canvas, &projection, figure.window, FRAME);
    }
    draw_scale_bar(canvas, area, figure);
    Ok(())
}

/// Draws the outline of a window that is not a rectangle.
pub(super) fn draw_outline(canvas: &mut Canvas, projection: &Projection, window: &Window, colour: &str) {
    for ring in window.rings() {
        let corners = ring.iter().chain(ring.first()).map(|&p| projection.place(p)).collect();
        canvas.polyline(corners, colour, OUTLINE_WIDTH, None);
    }
}

/// Draws points as an embedded picture; `dots` and `radius` are in canvas units.
fn draw_dot_picture(
    canvas: &mut Canvas,
    area: Area,
    dots: &[(f64, f64)],
    radius: f64,
) -> Result<(), ReportError> {
    let resolution = DOT_RESOLUTION.min(LARGEST_DOT_SIDE / area.width.max(area.height));
    let side = |length: f64| ((length * resolution).round() as u32).max(1);
    let mut sheet = GrayImage::from_pixel(side(area.width), side(area.height), image::Luma([255]));
    let size = sheet.dimensions();
    for &(x, y) in dots {
        let centre = ((x - area.x) * resolution - 0.5, (y - area.y) * resolution - 0.5);
        Shape::Disc.cover(size, centre, radius * resolution, 0., |x, y, coverage| {
            let level = &mut sheet.get_pixel_mut(x, y).0[0];
            *level = (f64::from(*level) * (1. - coverage)).round() as u8;
        });
    }
    canvas.picture(&png(sheet.as_raw(), size.0, size.1, ExtendedColorType::L8)?, area, area);
    Ok(())
}

fn draw_scale_bar(canvas: &mut Canvas, area: Area, figure: &MosaicFigure) {
    let (factor, unit) = shown_unit(figure.um_per_unit, figure.unit);
    scale_bar(canvas, area, figure.window.bounds().width() * factor, unit);
}

/// Draws a scale bar of a round length below a field, with the length that it stands for.
///
/// The field is `shown_width` of `unit` wide.
pub(super) fn scale_bar(canvas: &mut Canvas, area: Area, shown_width: f64, unit: &str) {
    let length = round_below(shown_width * SCALE_BAR_SHARE);
    let right = area.x + length / shown_width * area.width;
    let y = area.bottom() + 8.;
    canvas.line((area.x, y), (right, y), INK, 2.);
    let label = with_unit(&significant(length, 1), unit);
    canvas.text(right + 4., y + 3., &label, Style::Note, Anchor::Start);
}

/// Returns the largest of 1, 2, 5 × 10ᵏ that is not above `x`.
fn round_below(x: f64) -> f64 {
    let decade = 10f64.powf(x.log10().floor());
    [5., 2.].into_iter().map(|step| step * decade).find(|&length| length <= x).unwrap_or(decade)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_bars_have_round_lengths() {
        let lengths = [99., 49., 20., 1.5, 0.4, 0.07].map(round_below);
        for (length, expected) in lengths.into_iter().zip([50., 20., 20., 1., 0.2, 0.05]) {
            assert!((length / expected - 1.).abs() < 1e-12, "{length} {expected}");
        }
    }

    #[test]
    fn whole_image_window_takes_every_pixel_and_crops_take_theirs() {
        assert_eq!(pixels(-0.5, 149.5, 150), 0..150);
        assert_eq!(pixels(9.5, 19.5, 150), 10..20);
        assert_eq!(pixels(10., 20., 150), 10..21);
        assert!(pixels(200., 300., 150).is_empty());
        assert_eq!(pixels(-50., 300., 150), 0..150);
    }

    #[test]
    fn large_pictures_are_reduced_and_small_ones_kept() {
        assert_eq!(reduced(GrayImage::new(150, 150)).dimensions(), (150, 150));
        assert_eq!(reduced(GrayImage::new(4000, 1000)).dimensions(), (1200, 300));
        let (width, height) = reduced(GrayImage::new(3000, 3000)).dimensions();
        assert_eq!((width, height), (775, 775));
    }
}
