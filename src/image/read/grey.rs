//! Conversion of decoded samples, in any layout, to one grey plane.

use crate::image::Plane;
use ndarray::Array2;

/// Smallest saturation (0–1, 1 − smallest / largest channel) of a coloured pixel, and smallest
/// value of its largest channel as a fraction of the picture's.
const COLOURED: (f32, f32) = (0.5, 0.2);
/// Smallest share of the pixels that each of two channels dominates in a colour-coded picture.
const CODED: f64 = 0.01;

/// Treatment of the alpha (opacity) sample of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Alpha {
    /// No treatment: alpha is absent or already multiplied in.
    None,
    /// Multiplication of grey by alpha, since alpha is stored but not yet multiplied in.
    Straight,
}

/// Layout and meaning of the samples of a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    /// Width of the picture in px.
    pub(super) width: usize,
    /// Height of the picture in px.
    pub(super) height: usize,
    /// Number of samples per pixel, at least one. The colour samples (three, or one of grey) come
    /// first, then alpha if it is used; any further samples are ignored.
    pub(super) channels: usize,
    /// `true` if every pixel begins with a red, a green and a blue sample, `false` if it begins
    /// with a single grey sample.
    pub(super) colour: bool,
    /// Treatment of the alpha sample that follows the colour or grey.
    pub(super) alpha: Alpha,
    /// `true` if the samples are stored plane by plane, `false` if pixel by pixel.
    pub(super) planar: bool,
}

impl Layout {
    /// Returns the samples as a grey plane; `value` turns a sample into a number.
    ///
    /// Returns `None` if there are fewer samples than the layout needs.
    pub(super) fn grey<T: Copy>(&self, samples: &[T], value: impl Fn(T) -> f32) -> Option<Plane> {
        let pixels = self.width.checked_mul(self.height)?;
        let colours = if self.colour { 3 } else { 1 };
        let needed = colours + usize::from(self.alpha != Alpha::None);
        if self.channels < needed || samples.len() < pixels.checked_mul(self.channels)? {
            return None;
        }
        let (step, stride) = if self.planar { (1, pixels) } else { (self.channels, 1) };
        let colour = |pixel: usize| [0, 1, 2].map(|c| value(samples[pixel * step + c * stride]));
        let coded = self.colour && is_colour_coded((0..pixels).map(colour));
        let grey = (0..pixels).map(|pixel| {
            let sample = |channel: usize| value(samples[pixel * step + channel * stride]);
            let grey = if coded {
                colour(pixel).into_iter().fold(f32::NEG_INFINITY, f32::max)
            } else if self.colour {
                luma(sample(0), sample(1), sample(2))
            } else {
                sample(0)
            };
            match self.alpha {
                Alpha::None => grey,
                Alpha::Straight => grey * sample(colours),
            }
        });
        Array2::from_shape_vec((self.height, self.width), grey.collect()).ok()
    }
}

/// Returns whether colours code classes, such as cones drawn in red, green and blue.
///
/// In such pictures each of at least two channels exceeds twice both others in 1 % of the pixels.
/// Tinted pictures and heat scales of one hue, whose luma grows with brightness, are not coded.
fn is_colour_coded(pixels: impl Iterator<Item = [f32; 3]> + Clone) -> bool {
    let brightest = pixels.clone().flatten().fold(0f32, f32::max);
    let (mut dominated, mut all) = ([0usize; 3], 0usize);
    for pixel in pixels {
        all += 1;
        let mut order = [0, 1, 2];
        order.sort_by(|&a: &usize, &b| pixel[b].total_cmp(&pixel[a]));
        let [top, middle, _] = order.map(|c| pixel[c]);
        if top >= COLOURED.1 * brightest && middle <= (1. - COLOURED.0) * top && top > 0. {
            dominated[order[0]] += 1;
        }
    }
    dominated.iter().filter(|n| **n as f64 >= CODED * all as f64 && **n > 0).count() >= 2
}

/// Returns the luma of a colour by ITU-R Rec. 601.
pub(super) fn luma(r: f32, g: f32, b: f32) -> f32 {
    // the weights add up to 1 only within rounding, and grey must stay exactly the same grey
    if r == g && g == b { r } else { 0.299 * r + 0.587 * g + 0.114 * b }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(colours: [[u8; 3]; 3]) -> Plane {
        let layout =
            Layout { width: 30, height: 10, channels: 3, colour: true, alpha: Alpha::None, planar: false };
        let samples: Vec<u8> = (0..300).flat_map(|k| colours[k / 5 % 3]).collect();
        layout.grey(&samples, |v| f32::from(v) / 255.).unwrap()
    }

    #[test]
    fn red_green_and_blue_cones_are_equally_bright() {
        let coded = picture([[200, 20, 20], [20, 200, 20], [20, 20, 200]]);
        assert!(coded.iter().all(|v| *v == 200. / 255.));
    }

    #[test]
    fn tinted_and_grey_pictures_keep_their_luma() {
        let colours = [[90, 0, 0], [255, 120, 0], [255, 255, 255]];
        let hot = picture(colours);
        assert_eq!(hot[[0, 5]], luma(1., 120. / 255., 0.));
        assert_eq!(picture([[7; 3]; 3])[[0, 0]], 7. / 255.);
    }
}
