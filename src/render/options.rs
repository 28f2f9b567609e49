use super::RenderError;
use super::error::check;
use crate::image::{Modality, Polarity};
use serde::Serialize;

/// Largest side of a simulated image, in px; larger images are refused.
const MAX_SIDE: usize = 16_384;
/// Largest number of pixels of a simulated image: 2²⁶. Making such an image takes about 1 GB of
/// memory.
const MAX_PIXELS: usize = 1 << 26;

/// Shape of the spot that a cone's light makes; all shapes have the same full width at half
/// maximum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PointSpread {
    /// Gaussian spot, as aberrations and the registration of frames leave it.
    Gaussian,
    /// Airy pattern of a clear round pupil, with its rings.
    Airy,
}

/// Options for the simulated image of a mosaic.
///
/// “Spacings” are hexagonal spacings of the cones: the local spacing for the sizes of cones, the
/// median spacing for vessels and blur. [`RenderOptions::new`] gives, for each modality, values
/// that make the image look real; [`Default`] gives the values for confocal images.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RenderOptions {
    /// Kind of image: confocal, split detector or histology.
    pub modality: Modality,
    /// Sign of the contrast; `Negative` inverts the grey values before noise is added.
    pub polarity: Polarity,
    /// Width of the image, 1 to 16384 px.
    pub width: usize,
    /// Height of the image, 1 to 16384 px.
    pub height: usize,
    /// Spacing assumed for every cone, 2 to 1000 px, or `None` to derive the spacing at each cone
    /// from its neighbours.
    pub spacing: Option<f64>,
    /// Shape of a cone's spot in confocal images; other modalities do not use it.
    pub psf: PointSpread,
    /// Size of a cone, 0.1 to 1.5 local hexagonal spacings.
    ///
    /// In confocal images, this is the full width at half maximum of a cone's spot; in
    /// split-detector and histological images, the diameter of a cone's inner segment.
    pub diameter: f64,
    /// Coefficient of variation of the cones' sizes that is added to the variation of their
    /// spacings, 0 to 0.5.
    pub size_scatter: f64,
    /// Grey value where there is no cone, 0 to 1.
    pub brightness: f64,
    /// Brightness of the average cone above its surround, 0 to 1 of the full range of grey.
    pub contrast: f64,
    /// Coefficient of variation of the cones' contrast (log-normal), 0 to 2.
    pub scatter: f64,
    /// Fraction of cones whose contrast is reduced to between 0 and 0.3 of its value, 0 to 1.
    pub dim: f64,
    /// Fraction of cones that are not drawn at all, 0 to 1.
    pub missing: f64,
    /// Fraction of confocal cones that show several small peaks instead of one spot, 0 to 1.
    pub multimodal: f64,
    /// Number of rods per cone, 0 to 30; rods fill the room between the cones.
    pub rods: f64,
    /// Contrast of a rod relative to that of a cone, 0 to 2.
    pub rod_contrast: f64,
    /// Direction of light and shade, -360 to 360 degrees clockwise from x.
    ///
    /// In split-detector images, it points from the dark to the bright side of a cone; in
    /// histological images, towards the bright side of a disc. Confocal images do not use it.
    pub orientation: f64,
    /// Difference between the middle of an average cone and its surround in split-detector images,
    /// -2 to 2 times the contrast.
    ///
    /// A segment that stands upright has a dark and a bright half, and its middle is as bright as
    /// the surround. One that leans is brighter in its middle, or darker if the value is negative.
    pub lean: f64,
    /// Ratio of a cone's length across the direction of light and shade to its length along that
    /// direction, in split-detector images, 0.5 to 2.
    pub elongation: f64,
    /// Strength with which discs in histological images are lit from one side, 0 to 2.
    ///
    /// From the centre of a disc to its bright side, the brightness rises by √2 × `shading` times
    /// the peak of the disc; to the other side it falls as much. Large values give Nomarski
    /// contrast.
    pub shading: f64,
    /// Depth of the dark outline of discs in histological images, 0 to 3 times the contrast.
    pub outline: f64,
    /// Standard deviation of the grain within the discs of histological images, 0 to 2 times the
    /// contrast.
    ///
    /// The grain stands for mitochondria in an electron micrograph.
    pub granules: f64,
    /// Level of the section above the widest plane of the inner segments in histological images, 0
    /// to 0.95 of their half axis.
    ///
    /// The segments are taken as ellipsoids. If the level is above 0, cells are cut at different
    /// levels and differ in size.
    pub section: f64,
    /// Standard deviation of structure that is not a cone (haze, rods, grain of the tissue), 0 to 2
    /// times the contrast.
    pub texture: f64,
    /// Standard deviation of the illumination relative to its mean, 0 to 1.
    pub drift: f64,
    /// Number of blood vessels that enter the image from its border and branch, 0 to 50.
    ///
    /// Vessels are shadows; in split-detector images they are a relief.
    pub vessels: usize,
    /// Width of a vessel where it enters the image, 0.5 to 50 median spacings of the cones.
    pub vessel_width: f64,
    /// Fraction of the light that is lost in the middle of a vessel, 0 to 1.
    pub vessel_depth: f64,
    /// Standard deviation of an additional Gaussian blur (defocus, motion), 0 to 1 median spacings
    /// of the cones.
    pub blur: f64,
    /// Standard deviation of the noise of a pixel at mid-grey, 0 to 0.5 of the full range of grey.
    pub noise: f64,
    /// Fraction of the variance of the noise at mid-grey that is due to photons, 0 to 1.
    ///
    /// Photon noise is Poisson, with a variance proportional to the grey value. The rest is
    /// detector noise: Gaussian, and equally strong everywhere.
    pub photons: f64,
    /// Standard deviation of the Gaussian by which noise is smoothed, so that the noise of
    /// neighbouring pixels is correlated, 0 to 4 px.
    ///
    /// Averaging registered frames resamples them, which correlates their noise. 0 gives white
    /// noise. The standard deviation of a pixel's noise stays `noise`.
    pub grain: f64,
    /// Number of tiles along the longer side of a montage, 0 to 64; 0 and 1 give a single frame.
    ///
    /// Tiles overlap, are turned by up to 5°, and differ in brightness. Pixels outside all tiles
    /// are 0, all others at least 1/255.
    pub montage: usize,
}

impl RenderOptions {
    /// Returns options that make a 150 × 150 px image of the modality look real.
    ///
    /// The values were set so that grey level, spread, skewness, spectrum and scatter of brightness
    /// match those of real images.
    pub const fn new(modality: Modality) -> Self {
        let common = Self {
            modality,
            polarity: Polarity::Positive,
            width: 150,
            height: 150,
            spacing: None,
            psf: PointSpread::Gaussian,
            diameter: 0.55,
            size_scatter: 0.06,
            brightness: 0.045,
            contrast: 0.27,
            scatter: 0.65,
            dim: 0.03,
            missing: 0.,
            multimodal: 0.,
            rods: 0.,
            rod_contrast: 0.4,
            orientation: 0.,
            lean: 0.,
            elongation: 1.12,
            shading: 0.12,
            outline: 0.45,
            granules: 0.,
            section: 0.,
            texture: 0.07,
            drift: 0.12,
            vessels: 0,
            vessel_width: 3.,
            vessel_depth: 0.6,
            blur: 0.05,
            noise: 0.01,
            photons: 0.5,
            grain: 0.8,
            montage: 0,
        };
        match modality {
            Modality::Confocal => common,
            Modality::Split => Self {
                diameter: 0.8,
                size_scatter: 0.08,
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
                size_scatter: 0.05,
                orientation: 45.,
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

    /// Checks that every field is in its range.
    ///
    /// # Errors
    /// Fails if a field is out of its range; the error names the first such field and its range.
    pub fn validate(&self) -> Result<(), RenderError> {
        validate_size(self.width, self.height)?;
        if let Some(spacing) = self.spacing {
            check("spacing", spacing, (2., 1000.), "px")?;
        }
        // units that the message of the error names
        const GREY: &str = "of the full range of grey";
        const OF_CONES: &str = "(fraction of the cones)";
        const CONTRASTS: &str = "times the contrast";
        let ranges = [
            ("diameter", self.diameter, (0.1, 1.5), "spacings"),
            ("size_scatter", self.size_scatter, (0., 0.5), "(coefficient of variation)"),
            ("brightness", self.brightness, (0., 1.), GREY),
            ("contrast", self.contrast, (0., 1.), GREY),
            ("scatter", self.scatter, (0., 2.), "(coefficient of variation)"),
            ("dim", self.dim, (0., 1.), OF_CONES),
            ("missing", self.missing, (0., 1.), OF_CONES),
            ("multimodal", self.multimodal, (0., 1.), OF_CONES),
            ("rods", self.rods, (0., 30.), "rods per cone"),
            ("rod_contrast", self.rod_contrast, (0., 2.), CONTRASTS),
            ("orientation", self.orientation, (-360., 360.), "degrees"),
            ("lean", self.lean, (-2., 2.), CONTRASTS),
            ("elongation", self.elongation, (0.5, 2.), "(length across divided by length along)"),
            ("shading", self.shading, (0., 2.), "times the height of a disc"),
            ("outline", self.outline, (0., 3.), CONTRASTS),
            ("granules", self.granules, (0., 2.), CONTRASTS),
            ("section", self.section, (0., 0.95), "half axes"),
            ("texture", self.texture, (0., 2.), CONTRASTS),
            ("drift", self.drift, (0., 1.), "of the mean illumination"),
            ("vessels", self.vessels as f64, (0., 50.), "(number of vessels)"),
            ("vessel_width", self.vessel_width, (0.5, 50.), "spacings"),
            ("vessel_depth", self.vessel_depth, (0., 1.), "of the light"),
            ("blur", self.blur, (0., 1.), "spacings"),
            ("noise", self.noise, (0., 0.5), GREY),
            ("photons", self.photons, (0., 1.), "of the noise's variance"),
            ("montage", self.montage as f64, (0., 64.), "tiles along the longer side"),
        ];
        for (option, value, range, unit) in ranges {
            check(option, value, range, unit)?;
        }
        check("grain", self.grain, (0., 4.), "px")
    }
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self::new(Modality::Confocal)
    }
}

/// Returns an error if an image has no pixel, or more than [`MAX_SIDE`] px on a side, or more than
/// [`MAX_PIXELS`] px.
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
    use strum::VariantArray;

    #[test]
    fn the_values_of_every_modality_are_within_their_ranges() {
        for &modality in Modality::VARIANTS {
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
            (RenderOptions { diameter: 0., ..o() }, "diameter is 0: it must be from 0.1 to 1.5 spacings"),
            (RenderOptions { brightness: -0.1, ..o() }, "brightness is -0.1: it must be from 0 to 1"),
            (RenderOptions { contrast: f64::NAN, ..o() }, "contrast is NaN: it must be from 0 to 1"),
            (RenderOptions { scatter: 3., ..o() }, "scatter is 3: it must be from 0 to 2"),
            (RenderOptions { dim: 1.5, ..o() }, "dim is 1.5: it must be from 0 to 1"),
            (RenderOptions { texture: -1., ..o() }, "texture is -1: it must be from 0 to 2"),
            (RenderOptions { drift: 2., ..o() }, "drift is 2: it must be from 0 to 1"),
            (RenderOptions { blur: f64::INFINITY, ..o() }, "blur is inf: it must be from 0 to 1 spacings"),
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
