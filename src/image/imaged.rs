use super::Plane;
use image::{GrayImage, Luma};
use imageproc::region_labelling::{Connectivity, connected_components};

/// Smaller regions, as a part of the image, are dark places rather than places that were not imaged.
const SMALLEST: f64 = 0.005;

/// The smallest upright rectangle of an image that holds all that was imaged, in px.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImagedPart {
    /// First row.
    pub top: usize,
    /// First column.
    pub left: usize,
    /// Number of rows.
    pub height: usize,
    /// Number of columns.
    pub width: usize,
}

/// Finds the imaged part. What was not imaged are black regions that touch the border and cover at least 0.5 % of the
/// image each, as montages and registered averages leave them. All of the image if nothing of it was.
pub fn imaged_part(plane: &Plane) -> ImagedPart {
    let (height, width) = plane.dim();
    let whole = ImagedPart { top: 0, left: 0, height, width };
    let Some(empty) = empty_pixels(plane) else { return whole };
    let mut rows = (usize::MAX, 0);
    let mut columns = (usize::MAX, 0);
    for (i, _) in empty.iter().enumerate().filter(|(_, empty)| !**empty) {
        let (y, x) = (i / width, i % width);
        rows = (rows.0.min(y), rows.1.max(y));
        columns = (columns.0.min(x), columns.1.max(x));
    }
    if rows.0 > rows.1 {
        return whole;
    }
    let (height, width) = (rows.1 - rows.0 + 1, columns.1 - columns.0 + 1);
    ImagedPart { top: rows.0, left: columns.0, height, width }
}

/// How much of an image was not imaged, as a part of its area; see [`imaged_part`].
pub fn empty_fraction(plane: &Plane) -> f64 {
    let empty = empty_pixels(plane).map_or(0, |empty| empty.iter().filter(|e| **e).count());
    empty as f64 / plane.len().max(1) as f64
}

/// For every pixel, row by row, whether it was not imaged; `None` if all were.
pub(super) fn empty_pixels(plane: &Plane) -> Option<Vec<bool>> {
    let (height, width) = plane.dim();
    let least = SMALLEST * plane.len() as f64;
    let (w, h) = (u32::try_from(width).ok()?, u32::try_from(height).ok()?);
    // the commonest case, an image without margin, needs no labelling
    let black = plane.iter().filter(|&&v| v == 0.).count();
    if black == 0 || (black as f64) < least {
        return None;
    }
    let mask = GrayImage::from_fn(w, h, |x, y| Luma([u8::from(plane[[y as usize, x as usize]] == 0.)]));
    let labels = connected_components(&mask, Connectivity::Four, Luma([0]));
    let count = labels.iter().copied().max().unwrap_or(0) as usize + 1;
    let (mut sizes, mut touches) = (vec![0usize; count], vec![false; count]);
    for (x, y, label) in labels.enumerate_pixels() {
        let label = label.0[0] as usize;
        sizes[label] += 1;
        touches[label] |= x == 0 || y == 0 || x + 1 == w || y + 1 == h;
    }
    let margin: Vec<bool> = (0..count).map(|k| k > 0 && touches[k] && sizes[k] as f64 >= least).collect();
    margin.contains(&true).then(|| labels.iter().map(|label| margin[*label as usize]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_black_margin_is_empty_and_a_dark_spot_is_not() {
        let plane = Plane::from_shape_fn((100, 100), |(y, x)| {
            let spot = (40..60).contains(&x) && (40..60).contains(&y);
            if x < 20 || spot { 0. } else { 0.5 + 0.001 * (x + y) as f32 }
        });
        assert_eq!(empty_fraction(&plane), 0.2);
        assert_eq!(imaged_part(&plane), ImagedPart { top: 0, left: 20, height: 100, width: 80 });
    }

    #[test]
    fn an_image_without_margin_has_no_empty_part() {
        let plane = Plane::from_shape_fn((50, 50), |(y, x)| ((7 * x + 11 * y) % 251) as f32);
        assert_eq!(empty_fraction(&plane), 0.);
    }

    #[test]
    fn a_black_image_has_no_part_that_stands_out() {
        let part = imaged_part(&Plane::zeros((30, 40)));
        assert_eq!(part, ImagedPart { top: 0, left: 0, height: 30, width: 40 });
    }
}
