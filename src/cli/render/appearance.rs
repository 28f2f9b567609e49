use super::draw::Draw;
use clap::Args;
use conemosaic::detect::{Modality, Polarity};
use conemosaic::render::{PointSpread, RenderOptions};
use rand::Rng;

/// What the cones look like. The unit s is the local distance of the cones.
#[derive(Args)]
#[command(
    next_help_heading = "Appearance (A..B: drawn anew for every image; defaults depend on preset and modality)"
)]
pub struct Appearance {
    /// Shape of a confocal spot: gaussian or airy (diffraction by a round pupil, with rings)
    #[arg(long, value_name = "PSF", value_parser = ["gaussian", "airy"])]
    psf: Option<String>,
    /// Size of a cone in s (0.1–1.5): width of its spot at half maximum, or diameter of its inner segment [confocal .55, others .8]
    #[arg(long, value_name = "S")]
    diameter: Option<Draw>,
    /// Coefficient of variation of the sizes (0–0.5) [confocal .06, split .08, histology .05]
    #[arg(long, value_name = "CV")]
    size_scatter: Option<Draw>,
    /// Grey value where there is no cone (0–1) [confocal .045, split .5, histology .3]
    #[arg(long, value_name = "GREY")]
    brightness: Option<Draw>,
    /// How far the average cone rises above that (0–1) [confocal .27, split .2, histology .35]
    #[arg(long, value_name = "GREY")]
    contrast: Option<Draw>,
    /// Coefficient of variation of the cones' contrast, log-normal (0–2) [confocal .65, split .35, histology .15]
    #[arg(long, value_name = "CV")]
    scatter: Option<Draw>,
    /// Fraction of cones that are nearly invisible, class dim (0–1) [confocal and split .03, histology .01]
    #[arg(long, value_name = "F")]
    dim: Option<Draw>,
    /// Fraction of cones that are not drawn, class missing (0–1) [0]
    #[arg(long, value_name = "F")]
    missing: Option<Draw>,
    /// Confocal: fraction of cones that are several small peaks (0–1) [0]
    #[arg(long, value_name = "F")]
    multimodal: Option<Draw>,
    /// Rods per cone, in what room the cones leave (0–30) [0]
    #[arg(long, value_name = "N")]
    rods: Option<Draw>,
    /// Contrast of a rod relative to a cone (0–2) [.4]
    #[arg(long, value_name = "F")]
    rod_contrast: Option<Draw>,
    /// Towards the bright side, degrees clockwise from the right (−360–360) [split 0, histology 45]
    #[arg(long, value_name = "DEG")]
    orientation: Option<Draw>,
    /// Split: how much brighter than its surround the middle of a cone is, in contrasts (−2–2) [0]
    #[arg(long, value_name = "F")]
    lean: Option<Draw>,
    /// Split: length of a cone across the direction of light and shade over that along it (0.5–2) [1.12]
    #[arg(long, value_name = "RATIO")]
    elongation: Option<Draw>,
    /// Histology: light and dark side of a disc, relative to its height (0–2; Nomarski contrast: .4 and more) [.12]
    #[arg(long, value_name = "F")]
    shading: Option<Draw>,
    /// Histology: depth of the dark outline in contrasts (0–3) [.45]
    #[arg(long, value_name = "F")]
    outline: Option<Draw>,
    /// Histology: grain within the discs in contrasts (0–2) [0]
    #[arg(long, value_name = "F")]
    granules: Option<Draw>,
    /// Histology: height of the section above the widest place of the cells, in half axes (0–0.95) [0]
    #[arg(long, value_name = "F")]
    section: Option<Draw>,
    /// Structure that is not a cone, standard deviation in contrasts (0–2) [confocal .07, split .22, histology .12]
    #[arg(long, value_name = "F")]
    texture: Option<Draw>,
    /// Uneven illumination, standard deviation relative to its mean (0–1) [confocal .12, split .14, histology .08]
    #[arg(long, value_name = "F")]
    drift: Option<Draw>,
    /// Blood vessels that enter the image and branch (0–50) [0]
    #[arg(long, value_name = "N")]
    vessels: Option<Draw>,
    /// Width of a vessel in s (0.5–50) [3]
    #[arg(long, value_name = "S")]
    vessel_width: Option<Draw>,
    /// Part of the light that a vessel takes (0–1) [.6]
    #[arg(long, value_name = "F")]
    vessel_depth: Option<Draw>,
    /// Additional Gaussian blur, standard deviation in s (0–1) [confocal and histology .05, split .06]
    #[arg(long, value_name = "S")]
    blur: Option<Draw>,
    /// Noise of a pixel at mid-grey (0–0.5) [confocal .01, others .02]
    #[arg(long, value_name = "GREY")]
    noise: Option<Draw>,
    /// Part of the noise's variance that is photons', Poisson; the rest is the detector's, Gaussian (0–1) [.5]
    #[arg(long, value_name = "F")]
    photons: Option<Draw>,
    /// Correlation of the noise of neighbouring pixels, standard deviation in px (0–4; 0: white) [.8]
    #[arg(long, value_name = "PX")]
    grain: Option<Draw>,
    /// Tiles along the longer side of a montage with ragged black borders (0–64; 0: one frame) [0]
    #[arg(long, value_name = "N")]
    montage: Option<Draw>,
}

impl Appearance {
    /// The options of one image: what is given over what `defaults` say.
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
                // a negative number is out of range either way
                *field = if value < 0. { usize::MAX } else { value as usize };
            }
        }
        o
    }

    /// The first option given that pictures of this modality do not have.
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
