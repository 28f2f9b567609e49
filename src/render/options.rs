use super::RenderError;
use super::error::check;
use crate::detect::{Modality, Polarity};

/// Longest side of a simulated image, px.
const MAX_SIDE: usize = 16_384;
/// Most pixels of a simulated image: 2²⁶, about 1 GB while it is being made.
const MAX_PIXELS: usize = 1 << 26;

/// How a mosaic is to be pictured. The unit s is the local hexagonal spacing of the cones.
///
/// [`RenderOptions::new`] gives values for each modality that look like real images of it;
/// [`Default`] is those of the confocal one.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOptions {
    /// What kind of image.
    pub modality: Modality,
    /// Which way round its contrast runs. `Negative` is the photographic negative, before noise.
    pub polarity: Polarity,
    /// Width, 1 to 16384 px.
    pub width: usize,
    /// Height, 1 to 16384 px.
    pub height: usize,
    /// Spacing taken for every cone, 2 to 1000 px; `None`: each cone's own, from its neighbours.
    pub spacing: Option<f64>,
    /// Size of a cone, 0.1 to 1.5 s. Confocal: full width at half maximum of its spot; split detector and histology:
    /// diameter of its inner segment.
    pub diameter: f64,
    /// Grey value where there is no cone, 0 to 1.
    pub brightness: f64,
    /// How far the average cone rises from its surround, 0 to 1 of the full range of grey.
    pub contrast: f64,
    /// Coefficient of variation of the cones' contrast (log-normal), 0 to 2.
    pub scatter: f64,
    /// Fraction of cones nearly without contrast, 0 to 1.
    pub dim: f64,
    /// Structure that is not a cone (haze, rods, grain of the tissue): its standard deviation, 0 to 2 times the contrast.
    pub texture: f64,
    /// Standard deviation of the illumination relative to its mean, 0 to 1.
    pub drift: f64,
    /// Standard deviation of an additional Gaussian blur (defocus, motion), 0 to 1 s.
    pub blur: f64,
    /// Standard deviation of the noise of a pixel at mid-grey, 0 to 0.5 of the full range of grey. Half its variance is that
    /// of photons (proportional to the grey value), half that of the detector (the same everywhere).
    pub noise: f64,
    /// Standard deviation of the Gaussian that correlates the noise of neighbouring pixels, 0 to 4 px: averaging registered
    /// frames resamples them. 0 is white noise. The noise of a pixel stays what `noise` says.
    pub grain: f64,
}

impl RenderOptions {
    /// Values that look like real images of the modality, 150 × 150 px.
    pub const fn new(modality: Modality) -> Self {
        let common = Self {
            modality,
            polarity: Polarity::Positive,
            width: 150,
            height: 150,
            spacing: None,
            diameter: 0.55,
            brightness: 0.045,
            contrast: 0.27,
            scatter: 0.65,
            dim: 0.03,
            texture: 0.07,
            drift: 0.12,
            blur: 0.05,
            noise: 0.01,
            grain: 0.8,
        };
        match modality {
            Modality::Confocal => common,
            Modality::Split => Self {
                diameter: 0.8,
                brightness: 0.5,
                contrast: 0.2,
                scatter: 0.35,
                dim: 0.03,
                texture: 0.22,
                drift: 0.14,
                blur: 0.06,
                noise: 0.02,
                grain: 0.8,
                ..common
            },
            Modality::Histology => Self {
                diameter: 0.8,
                brightness: 0.3,
                contrast: 0.35,
                scatter: 0.15,
                dim: 0.01,
                texture: 0.12,
                drift: 0.08,
                blur: 0.05,
                noise: 0.02,
                ..common
            },
        }
    }

    /// Whether every field is in its range.
    ///
    /// # Errors
    /// The first field that is not, with its range.
    pub fn validate(&self) -> Result<(), RenderError> {
        validate_size(self.width, self.height)?;
        if let Some(spacing) = self.spacing {
            check("spacing", spacing, (2., 1000.), "px")?;
        }
        check("diameter", self.diameter, (0.1, 1.5), "s")?;
        check("brightness", self.brightness, (0., 1.), "of the full range of grey")?;
        check("contrast", self.contrast, (0., 1.), "of the full range of grey")?;
        check("scatter", self.scatter, (0., 2.), "(coefficient of variation)")?;
        check("dim", self.dim, (0., 1.), "(fraction of the cones)")?;
        check("texture", self.texture, (0., 2.), "times the contrast")?;
        check("drift", self.drift, (0., 1.), "of the mean illumination")?;
        check("blur", self.blur, (0., 1.), "s")?;
        check("noise", self.noise, (0., 0.5), "of the full range of grey")?;
        check("grain", self.grain, (0., 4.), "px")
    }
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self::new(Modality::Confocal)
    }
}

/// Refuses images without a pixel and those that would not fit into memory.
pub(super) fn validate_size(width: usize, height: usize) -> Result<(), RenderError> {
    check("width", width as f64, (1., MAX_SIDE as f64), "px")?;
    check("height", height as f64, (1., MAX_SIDE as f64), "px")?;
    if width * height > MAX_PIXELS {
        return Err(RenderError::TooLarge { width, height, limit: MAX_PIXELS });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_values_of_every_modality_are_within_their_ranges() {
        for modality in Modality::ALL {
            assert_eq!(RenderOptions::new(modality).validate(), Ok(()));
        }
    }

    #[test]
    fn a_value_out_of_range_is_an_error_that_says_the_range() {
        let o = RenderOptions::default;
        let wrong = [
            (RenderOptions { width: 0, ..o() }, "width is 0: it must be from 1 to 16384 px"),
            (RenderOptions { height: 20_000, ..o() }, "height is 20000: it must be from 1 to 16384 px"),
            (RenderOptions { spacing: Some(1.), ..o() }, "spacing is 1: it must be from 2 to 1000 px"),
            (RenderOptions { diameter: 0., ..o() }, "diameter is 0: it must be from 0.1 to 1.5 s"),
            (RenderOptions { brightness: -0.1, ..o() }, "brightness is -0.1: it must be from 0 to 1"),
            (RenderOptions { contrast: f64::NAN, ..o() }, "contrast is NaN: it must be from 0 to 1"),
            (RenderOptions { scatter: 3., ..o() }, "scatter is 3: it must be from 0 to 2"),
            (RenderOptions { dim: 1.5, ..o() }, "dim is 1.5: it must be from 0 to 1"),
            (RenderOptions { texture: -1., ..o() }, "texture is -1: it must be from 0 to 2"),
            (RenderOptions { drift: 2., ..o() }, "drift is 2: it must be from 0 to 1"),
            (RenderOptions { blur: f64::INFINITY, ..o() }, "blur is inf: it must be from 0 to 1 s"),
            (RenderOptions { noise: 0.6, ..o() }, "noise is 0.6: it must be from 0 to 0.5"),
            (RenderOptions { grain: 5., ..o() }, "grain is 5: it must be from 0 to 4 px"),
        ];
        for (options, says) in wrong {
            let message = options.validate().unwrap_err().to_string();
            assert!(message.starts_with(says), "{message}");
        }
        let huge = RenderOptions { width: 16_384, height: 16_384, ..o() };
        assert!(huge.validate().unwrap_err().to_string().contains("at most 67108864 pixels"));
    }
}
