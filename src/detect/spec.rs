//! The table of modalities: everything that detection does differently for each of them.

use super::calibration::{Logistic, Reference};
use super::filter::{Filter, confocal, histology, split};
use super::learned::{Model, WeightsError};
use crate::image::Modality;
use std::sync::OnceLock;
use strum::VariantArray;

/// Number of modalities, and so of entries in [`SPECS`].
const COUNT: usize = Modality::VARIANTS.len();

/// Filter, network and constants of one modality.
pub(super) struct ModalitySpec {
    /// Modality that the entry belongs to.
    pub modality: Modality,
    /// Classical filter of the modality.
    pub filter: Filter,
    /// Network, compiled into the program, that finds cones in images of the modality.
    pub network: BuiltIn,
    /// `true` if the network searches first, `false` if it runs only after the classical filter has
    /// settled on a spacing.
    ///
    /// For confocal and split-detector images the classical filter gives a good first spacing, so
    /// the network runs second. On histology the classical filter also fires on rods and gaps, so
    /// there the built-in network runs first.
    pub starts_with_network: bool,
    /// Evidence by which the sign of the cones' contrast is decided.
    pub polarity: PolarityCue,
}

/// Evidence by which the polarity of an image, the sign of its cones' contrast, is decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PolarityCue {
    /// Dark side of the inner segments: the polarity is positive if cones are dark on the left.
    DarkSide,
    /// Skewness of the response of a filter for blobs: the polarity is positive if the skewness is.
    ///
    /// Bright cones make high maxima, and the ground between them makes only shallow minima.
    Blobs,
}

/// A network whose weights are compiled into the program.
pub(super) struct BuiltIn {
    /// Bytes of the file of weights, in the safetensors format.
    weights: &'static [u8],
    /// Network read from `weights`, or the error met there; empty before first use.
    model: OnceLock<Result<Model, WeightsError>>,
}

impl BuiltIn {
    const fn new(weights: &'static [u8]) -> Self {
        Self { weights, model: OnceLock::new() }
    }

    /// Returns the network; its weights are read on first use only.
    pub(super) fn model(&self) -> Result<&Model, WeightsError> {
        self.model.get_or_init(|| Model::read(self.weights)).as_ref().map_err(Clone::clone)
    }

    /// Returns the bytes of the file of weights.
    pub(super) const fn weights(&self) -> &'static [u8] {
        self.weights
    }
}

/// Table of all modalities, in the order of [`Modality::VARIANTS`].
///
/// The calibrations (`probability`) were fitted by `scripts/fit-calibration` to hand-marked images
/// (for histology, to simulated images). On subjects left out of the fit, the expected calibration
/// error is .0014 (confocal), .009 (split), .008 (histology).
pub(super) static SPECS: [ModalitySpec; COUNT] = [
    ModalitySpec {
        modality: Modality::Confocal,
        filter: Filter {
            response: confocal::response,
            probability: Logistic { offset: 1.179, slope: 7.582 },
            reference: Reference::Median,
        },
        network: BuiltIn::new(include_bytes!("learned/confocal.safetensors")),
        starts_with_network: false,
        polarity: PolarityCue::Blobs,
    },
    ModalitySpec {
        modality: Modality::Split,
        filter: Filter {
            response: split::response,
            probability: Logistic { offset: 0.259, slope: 4.227 },
            reference: Reference::Least,
        },
        network: BuiltIn::new(include_bytes!("learned/split.safetensors")),
        starts_with_network: false,
        polarity: PolarityCue::DarkSide,
    },
    ModalitySpec {
        modality: Modality::Histology,
        filter: Filter {
            response: histology::response,
            probability: Logistic { offset: -2.294, slope: 6.793 },
            reference: Reference::Median,
        },
        network: BuiltIn::new(include_bytes!("learned/histology.safetensors")),
        starts_with_network: true,
        polarity: PolarityCue::Blobs,
    },
];

/// Returns the entry of the table for `modality`.
pub(super) fn spec(modality: Modality) -> &'static ModalitySpec {
    // the table has one entry per variant, so the index is in range
    &SPECS[modality as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_modality_stands_in_its_place() {
        for &modality in Modality::VARIANTS {
            assert_eq!(spec(modality).modality, modality);
        }
    }

    #[test]
    fn the_networks_in_the_program_are_better_than_the_filters() {
        for spec in &SPECS {
            let model = spec.network.model().unwrap();
            assert_eq!(model.modality, Some(spec.modality));
            assert!(model.better);
        }
    }
}
