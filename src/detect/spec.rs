//! The table of modalities: everything that detection does differently from one to the next.

use super::calibration::{Logistic, Reference};
use super::filter::{Filter, confocal, histology, split};
use super::learned::{Model, WeightsError};
use crate::image::Modality;
use std::sync::OnceLock;
use strum::VariantArray;

const COUNT: usize = Modality::VARIANTS.len();

/// A modality's parts in detection.
pub(super) struct ModalitySpec {
    /// The modality that this is about.
    pub modality: Modality,
    /// Its classical filter.
    pub filter: Filter,
    /// Its network.
    pub network: BuiltIn,
    /// Whether the network runs from the start, and not only at the spacing that the filter has settled on. The filters of confocal
    /// and of split-detector images count cones well enough for that; that of histology fires on rods and gaps, too.
    pub starts_with_network: bool,
    /// Sign of the contrast: what decides about it.
    pub polarity: PolarityCue,
}

/// The evidence by which the polarity of an image is decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PolarityCue {
    /// The side on which inner segments are dark.
    DarkSide,
    /// Skewness of the response to blobs: cones make high maxima, what lies between them shallow minima.
    Blobs,
}

/// A network whose weights are compiled into the program.
pub(super) struct BuiltIn {
    weights: &'static [u8],
    model: OnceLock<Result<Model, WeightsError>>,
}

impl BuiltIn {
    const fn new(weights: &'static [u8]) -> Self {
        Self { weights, model: OnceLock::new() }
    }

    /// Returns the network, read once.
    ///
    /// # Errors
    /// If the weights cannot be read.
    pub(super) fn model(&self) -> Result<&Model, WeightsError> {
        self.model.get_or_init(|| Model::read(self.weights)).as_ref().map_err(Clone::clone)
    }

    /// The file of its weights.
    pub(super) const fn weights(&self) -> &'static [u8] {
        self.weights
    }
}

/// The modalities, in the order of [`Modality::VARIANTS`].
///
/// Constants of probabilities by scripts/fit-calibration from hand-marked images (histology: simulated ones); on subjects left
/// out, the expected calibration error is .0014 (confocal), .009 (split), .008 (histology).
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

/// Returns the parts of a modality.
pub(super) fn spec(modality: Modality) -> &'static ModalitySpec {
    // as many entries as variants: the index is in range
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
