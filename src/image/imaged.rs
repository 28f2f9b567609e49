use super::Plane;
use image::{GrayImage, Luma};
use imageproc::region_labelling::{Connectivity, connected_components};

/// Smaller regions, as a part of the image, are dark places rather than places that were not imaged.
const SMALLEST: f64 = 0.005;

/// The part of an image that was not imaged: black regions that touch its border and cover at least 0.5 % of it each, as
/// montages and registered averages leave them.
pub fn empty_fraction(plane: &Plane) -> f64 {
    let (height, width) = plane.dim();
    let (Ok(w), Ok(h)) = (u32::try_from(width), u32::try_from(height)) else { return 0. };
    // the commonest case, an image without margin, needs no labelling
    let dark = plane.iter().filter(|&&v| v == 0.).count();
    if (dark as f64) < SMALLEST * plane.len() as f64 {
        return 0.;
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
    let least = SMALLEST * plane.len() as f64;
    let empty: usize = (1..count).filter(|&k| touches[k] && sizes[k] as f64 >= least).map(|k| sizes[k]).sum();
    empty as f64 / plane.len() as f64
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
    }

    #[test]
    fn an_image_without_margin_has_no_empty_part() {
        let plane = Plane::from_shape_fn((50, 50), |(y, x)| ((7 * x + 11 * y) % 251) as f32);
        assert_eq!(empty_fraction(&plane), 0.);
    }
}
