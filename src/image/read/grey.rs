//! Conversion of decoded samples, in any layout, to one grey plane.

use crate::image::Plane;
use ndarray::Array2;

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
        let grey = (0..pixels).map(|pixel| {
            let sample = |channel: usize| value(samples[pixel * step + channel * stride]);
            let grey = if self.colour { luma(sample(0), sample(1), sample(2)) } else { sample(0) };
            match self.alpha {
                Alpha::None => grey,
                Alpha::Straight => grey * sample(colours),
            }
        });
        Array2::from_shape_vec((self.height, self.width), grey.collect()).ok()
    }
}

/// Returns the luma of a colour by ITU-R Rec. 601.
pub(super) fn luma(r: f32, g: f32, b: f32) -> f32 {
    // the weights add up to 1 only within rounding, and grey must stay exactly the same grey
    if r == g && g == b { r } else { 0.299 * r + 0.587 * g + 0.114 * b }
}
