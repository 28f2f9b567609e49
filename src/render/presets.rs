use super::{GradientShape, MosaicOptions, PointSpread, RenderOptions};
use crate::image::Modality;

/// Named set of options that imitates one kind of retinal image.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// Name that users type.
    pub name: &'static str,
    /// Description of the image in one line.
    pub about: &'static str,
    /// Function that makes the options of the mosaic and those of the image.
    make: fn() -> (MosaicOptions, RenderOptions),
}

impl Preset {
    /// Returns the preset called `name`, or `None` if there is no such preset.
    pub fn named(name: &str) -> Option<&'static Self> {
        PRESETS.iter().find(|p| p.name == name)
    }

    /// Returns the options of the mosaic and the options of its image; both have the same size.
    pub fn options(&self) -> (MosaicOptions, RenderOptions) {
        let (mosaic, image) = (self.make)();
        (MosaicOptions { width: image.width, height: image.height, ..mosaic }, image)
    }
}

/// All presets, in the order in which they are listed.
pub const PRESETS: [Preset; 8] = [
    Preset {
        name: "fovea",
        about: "confocal, foveal centre: spacing 5 px, density falling to a third",
        make: fovea,
    },
    Preset {
        name: "parafovea",
        about: "confocal, spacing 9 px, with multimodal, dim and missing cones",
        make: parafovea,
    },
    Preset {
        name: "periphery",
        about: "confocal, spacing 20 px: wide multimodal cones among rods",
        make: periphery,
    },
    Preset { name: "split", about: "split detector, spacing 14 px, without rods", make: split },
    Preset {
        name: "split-periphery",
        about: "split detector, spacing 24 px: cones among rods",
        make: split_periphery,
    },
    Preset {
        name: "histology",
        about: "histology: bright discs of varying size with a thin outline",
        make: histology,
    },
    Preset {
        name: "nomarski",
        about: "histology in interference contrast: discs lit from one side, among rods",
        make: nomarski,
    },
    Preset {
        name: "electron",
        about: "electron microscopy: grainy cells with sharp, dark membranes",
        make: electron,
    },
];

/// Returns the default options of a modality, for a square image of `side` px.
fn of(modality: Modality, side: usize) -> RenderOptions {
    RenderOptions { width: side, height: side, ..RenderOptions::new(modality) }
}

fn fovea() -> (MosaicOptions, RenderOptions) {
    let mosaic =
        MosaicOptions { spacing: 5., gradient: 3., shape: GradientShape::Radial, ..MosaicOptions::default() };
    // In the fovea the point-spread function is wide compared with the distance between cones (0.55
    // spacings by default).
    let image = RenderOptions { diameter: 0.6, texture: 0.1, noise: 0.012, ..of(Modality::Confocal, 256) };
    (mosaic, image)
}

fn parafovea() -> (MosaicOptions, RenderOptions) {
    let image = RenderOptions {
        psf: PointSpread::Airy,
        diameter: 0.58,
        missing: 0.01,
        multimodal: 0.03,
        texture: 0.08,
        ..of(Modality::Confocal, 150)
    };
    (MosaicOptions::default(), image)
}

fn periphery() -> (MosaicOptions, RenderOptions) {
    let image = RenderOptions {
        diameter: 0.38,
        brightness: 0.08,
        contrast: 0.4,
        size_scatter: 0.12,
        missing: 0.02,
        multimodal: 0.3,
        rods: 9.,
        rod_contrast: 0.35,
        texture: 0.03,
        ..of(Modality::Confocal, 240)
    };
    (MosaicOptions { spacing: 20., jitter: 0.11, ..MosaicOptions::default() }, image)
}

fn split() -> (MosaicOptions, RenderOptions) {
    let image = RenderOptions {
        diameter: 1.05,
        contrast: 0.13,
        lean: 0.4,
        elongation: 1.,
        texture: 0.25,
        drift: 0.18,
        blur: 0.07,
        ..of(Modality::Split, 200)
    };
    (MosaicOptions { spacing: 14., jitter: 0.11, ..MosaicOptions::default() }, image)
}

fn split_periphery() -> (MosaicOptions, RenderOptions) {
    let image = RenderOptions {
        diameter: 0.6,
        elongation: 1.05,
        size_scatter: 0.1,
        rods: 9.,
        rod_contrast: 0.3,
        texture: 0.15,
        blur: 0.04,
        ..of(Modality::Split, 240)
    };
    (MosaicOptions { spacing: 24., jitter: 0.12, ..MosaicOptions::default() }, image)
}

fn histology() -> (MosaicOptions, RenderOptions) {
    let image = RenderOptions { size_scatter: 0.1, section: 0.2, ..of(Modality::Histology, 200) };
    (MosaicOptions { spacing: 12., ..MosaicOptions::default() }, image)
}

fn nomarski() -> (MosaicOptions, RenderOptions) {
    let image = RenderOptions {
        diameter: 0.7,
        size_scatter: 0.08,
        brightness: 0.4,
        contrast: 0.25,
        shading: 0.45,
        orientation: 225.,
        outline: 0.8,
        rods: 4.,
        rod_contrast: 0.5,
        blur: 0.07,
        noise: 0.03,
        ..of(Modality::Histology, 200)
    };
    (MosaicOptions { spacing: 16., jitter: 0.1, ..MosaicOptions::default() }, image)
}

fn electron() -> (MosaicOptions, RenderOptions) {
    let image = RenderOptions {
        diameter: 0.85,
        size_scatter: 0.1,
        brightness: 0.5,
        contrast: 0.2,
        shading: 0.,
        outline: 2.,
        granules: 0.5,
        texture: 0.25,
        blur: 0.02,
        noise: 0.06,
        grain: 0.4,
        ..of(Modality::Histology, 240)
    };
    (MosaicOptions { spacing: 20., jitter: 0.1, ..MosaicOptions::default() }, image)
}
