use super::draw::Draw;
use clap::Args;
use conemosaic::detect::{Modality, Polarity};
use conemosaic::render::{PointSpread, RenderOptions};
use rand::Rng;

/// Options for the appearance of cones and image. A cone spacing, as a unit, is the local spacing
/// of the cones.
#[derive(Args)]
#[command(next_help_heading = "Appearance (N, or a range A..B from which each image draws; s: cone spacing)")]
pub struct Appearance {
    /// Confocal: shape of the spot of a cone [default: gaussian]
    ///
    /// airy: diffraction pattern of a round pupil, with rings.
    #[arg(long, value_name = "PSF", value_parser = ["gaussian", "airy"])]
    psf: Option<String>,
    /// Size of a cone, in cone spacings (0.1–1.5) [default: confocal 0.55, others 0.8]
    ///
    /// Full width at half maximum of its spot in confocal images, diameter of its inner segment in
    /// the others.
    #[arg(long, value_name = "S")]
    diameter: Option<Draw>,
    /// Coefficient of variation of the sizes of cones (0–0.5) [default: confocal 0.06, split 0.08,
    /// histology 0.05]
    #[arg(long, value_name = "CV")]
    size_scatter: Option<Draw>,
    /// Grey value where there is no cone (0–1) [default: confocal 0.045, split 0.5, histology 0.3]
    #[arg(long, value_name = "GREY")]
    brightness: Option<Draw>,
    /// Contrast of the average cone, in grey values (0–1) [default: confocal 0.27, split 0.2,
    /// histology 0.35]
    ///
    /// The difference between the cone and the grey value where there is no cone. Options below
    /// that are “in contrasts” are multiples of it.
    #[arg(long, value_name = "GREY")]
    contrast: Option<Draw>,
    /// Coefficient of variation of the contrast of cones (0–2) [default: confocal 0.65, split 0.35,
    /// histology 0.15]
    ///
    /// The contrast has a log-normal distribution.
    #[arg(long, value_name = "CV")]
    scatter: Option<Draw>,
    /// Fraction of cones that are nearly invisible, class dim (0–1) [default: histology 0.01,
    /// others 0.03]
    #[arg(long, value_name = "F")]
    dim: Option<Draw>,
    /// Fraction of cones that are not drawn, class missing (0–1) [default: 0]
    #[arg(long, value_name = "F")]
    missing: Option<Draw>,
    /// Confocal: fraction of cones that show several small peaks (0–1) [default: 0]
    #[arg(long, value_name = "F")]
    multimodal: Option<Draw>,
    /// Number of rods per cone, placed between the cones (0–30) [default: 0]
    #[arg(long, value_name = "N")]
    rods: Option<Draw>,
    /// Contrast of a rod relative to that of a cone (0–2) [default: 0.4]
    #[arg(long, value_name = "F")]
    rod_contrast: Option<Draw>,
    /// Split, histology: direction from the dark to the bright side [default: split 0, histology
    /// 45]
    ///
    /// In degrees clockwise from the right (−360 to 360).
    #[arg(long, value_name = "DEG")]
    orientation: Option<Draw>,
    /// Split: brightness of the middle of a cone above its surround, in contrasts (−2 to 2)
    /// [default: 0]
    #[arg(long, value_name = "F")]
    lean: Option<Draw>,
    /// Split: ratio of the two diameters of a cone (0.5–2) [default: 1.12]
    ///
    /// The diameter across the direction of light and shade, divided by the diameter along it.
    #[arg(long, value_name = "RATIO")]
    elongation: Option<Draw>,
    /// Histology: difference between the bright and the dark side of a disc (0–2) [default: 0.12]
    ///
    /// Relative to the contrast of the disc; 0.4 and more look like Nomarski contrast.
    #[arg(long, value_name = "F")]
    shading: Option<Draw>,
    /// Histology: depth of the dark outline of a disc, in contrasts (0–3) [default: 0.45]
    #[arg(long, value_name = "F")]
    outline: Option<Draw>,
    /// Histology: standard deviation of the grain inside the discs, in contrasts (0–2) [default: 0]
    #[arg(long, value_name = "F")]
    granules: Option<Draw>,
    /// Histology: height of the section above the widest part of the inner segments (0–0.95)
    /// [default: 0]
    ///
    /// Inner segments are ellipsoids, and the unit is half their length. Above 0 they are cut at
    /// different heights, so that their discs differ in size.
    #[arg(long, value_name = "F")]
    section: Option<Draw>,
    /// Standard deviation of structure that is not a cone, in contrasts (0–2) [default: confocal
    /// 0.07, split 0.22, histology 0.12]
    #[arg(long, value_name = "F")]
    texture: Option<Draw>,
    /// Standard deviation of uneven illumination, relative to its mean (0–1) [default: confocal
    /// 0.12, split 0.14, histology 0.08]
    #[arg(long, value_name = "F")]
    drift: Option<Draw>,
    /// Number of blood vessels that enter the image and branch (0–50) [default: 0]
    #[arg(long, value_name = "N")]
    vessels: Option<Draw>,
    /// Width of a vessel, in cone spacings (0.5–50) [default: 3]
    #[arg(long, value_name = "S")]
    vessel_width: Option<Draw>,
    /// Fraction of the light that a vessel absorbs (0–1) [default: 0.6]
    #[arg(long, value_name = "F")]
    vessel_depth: Option<Draw>,
    /// Standard deviation of additional Gaussian blur, in cone spacings (0–1) [default: split 0.06,
    /// others 0.05]
    #[arg(long, value_name = "S")]
    blur: Option<Draw>,
    /// Standard deviation of the noise of a pixel at mid-grey (0–0.5) [default: confocal 0.01,
    /// others 0.02]
    #[arg(long, value_name = "GREY")]
    noise: Option<Draw>,
    /// Fraction of the variance of the noise that is photon noise (0–1) [default: 0.5]
    ///
    /// Photon noise has a Poisson distribution; the rest is Gaussian noise of the light detector.
    #[arg(long, value_name = "F")]
    photons: Option<Draw>,
    /// Range over which the noise of neighbouring pixels is correlated, in px (0–4) [default: 0.8]
    ///
    /// Standard deviation of a Gaussian; 0 is white noise.
    #[arg(long, value_name = "PX")]
    grain: Option<Draw>,
    /// Number of tiles along the longer side of a montage (0–64) [default: 0]
    ///
    /// The tiles overlap, and the montage has ragged black borders. 0 is a single frame.
    #[arg(long, value_name = "N")]
    montage: Option<Draw>,
}

impl Appearance {
    /// Returns the options of one image: the values set by the user, and otherwise those of
    /// `defaults`.
    ///
    /// An option that is a range draws its value for this image from `rng`.
    pub fn options(&self, defaults: RenderOptions, polarity: Polarity, rng: &mut dyn Rng) -> RenderOptions {
        let mut o = RenderOptions { polarity, ..defaults };
        if let Some(psf) = &self.psf {
            o.psf = if psf == "airy" { PointSpread::Airy } else { PointSpread::Gaussian };
        }
        for (given, field) in [
            (self.diameter, &mut o.diameter),
            (self.size_scatter, &mut o.size_scatter),
            (self.brightness, &mut o.brightness),
            (self.contrast, &mut o.contrast),
            (self.scatter, &mut o.scatter),
            (self.dim, &mut o.dim),
            (self.missing, &mut o.missing),
            (self.multimodal, &mut o.multimodal),
            (self.rods, &mut o.rods),
            (self.rod_contrast, &mut o.rod_contrast),
            (self.orientation, &mut o.orientation),
            (self.lean, &mut o.lean),
            (self.elongation, &mut o.elongation),
            (self.shading, &mut o.shading),
            (self.outline, &mut o.outline),
            (self.granules, &mut o.granules),
            (self.section, &mut o.section),
            (self.texture, &mut o.texture),
            (self.drift, &mut o.drift),
            (self.vessel_width, &mut o.vessel_width),
            (self.vessel_depth, &mut o.vessel_depth),
            (self.blur, &mut o.blur),
            (self.noise, &mut o.noise),
            (self.photons, &mut o.photons),
            (self.grain, &mut o.grain),
        ] {
            if let Some(draw) = given {
                *field = draw.value(rng);
            }
        }
        for (given, field) in [(self.vessels, &mut o.vessels), (self.montage, &mut o.montage)] {
            if let Some(draw) = given {
                let value = draw.value(rng).round();
                // a negative number becomes one that the check of the range refuses
                *field = if value < 0. { usize::MAX } else { value as usize };
            }
        }
        o
    }

    /// Returns the first option set by the user that images of `modality` do not have.
    pub fn foreign(&self, modality: Modality) -> Option<&'static str> {
        let all = [
            ("--psf", self.psf.is_some(), &[Modality::Confocal][..]),
            ("--multimodal", self.multimodal.is_some(), &[Modality::Confocal]),
            ("--orientation", self.orientation.is_some(), &[Modality::Split, Modality::Histology]),
            ("--lean", self.lean.is_some(), &[Modality::Split]),
            ("--elongation", self.elongation.is_some(), &[Modality::Split]),
            ("--shading", self.shading.is_some(), &[Modality::Histology]),
            ("--outline", self.outline.is_some(), &[Modality::Histology]),
            ("--granules", self.granules.is_some(), &[Modality::Histology]),
            ("--section", self.section.is_some(), &[Modality::Histology]),
        ];
        all.into_iter().find(|(_, given, of)| *given && !of.contains(&modality)).map(|(name, ..)| name)
    }
}
