use crate::image::Plane;
use ndarray::Array2;

/// What the samples of a pixel mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Alpha {
    /// There is none, or it is not to be applied.
    None,
    /// Grey is to be multiplied by it.
    Straight,
}

/// Where the samples of a picture stand and what they mean.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Samples a pixel, at least one; those after the colour and the alpha count for nothing.
    pub(super) channels: usize,
    /// Three colour samples come first, not one.
    pub(super) colour: bool,
    /// What comes after the colour.
    pub(super) alpha: Alpha,
    /// One plane after the other, not one pixel after the other.
    pub(super) planar: bool,
}

impl Layout {
    /// The grey plane of samples that `value` turns into numbers; `None` if there are not as many as there should be.
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

/// Luma by ITU-R Rec. 601.
pub(super) fn luma(r: f32, g: f32, b: f32) -> f32 {
    // The weights add up to 1 only within rounding: grey must stay grey.
    if r == g && g == b { r } else { 0.299 * r + 0.587 * g + 0.114 * b }
}
