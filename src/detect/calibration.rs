//! What a filter's response says about the probability that a person would mark a cone there.

use super::{Detection, Modality};

/// 1 / (1 + exp(−(offset + slope · x))).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Logistic {
    pub offset: f64,
    pub slope: f64,
}

impl Logistic {
    pub(super) fn at(self, x: f64) -> f64 {
        1. / (1. + (-(self.offset + self.slope * x)).exp())
    }
}

/// The probability that a spacing is within 15 % of the true one, by the strength of the ring and by how far the density of the
/// detections has moved it: logistic regression on hand-marked split-detector images, as they are and with gamma .5 and 2, noise,
/// and at .7 and 1.5 times their size.
pub(super) fn spacing(ring_strength: f64, ring_spacing: f64, spacing: f64) -> f64 {
    let moved = (spacing / ring_spacing).ln().abs();
    Logistic { offset: -0.95, slope: 1. }.at(20. * ring_strength - 3.7 * moved)
}

/// The probability by the height of the classical filter's response, given the `cones` of the image, highest first, and how high
/// a cone had to be. Constants by scripts/fit-calibration from hand-marked images (histology: simulated ones); on subjects left
/// out, the expected calibration error is .0014 (confocal), .009 (split), .0012 (histology).
pub(super) fn classical(modality: Modality, cones: &[Detection], least: f64) -> impl Fn(f64) -> f64 + use<> {
    let median = cones.get(cones.len() / 2).map_or(1., |d| d.score).max(f64::MIN_POSITIVE);
    move |score| match modality {
        Modality::Confocal => Logistic { offset: 1.172, slope: 7.610 }.at(score / median),
        Modality::Split => Logistic { offset: 0.240, slope: 4.253 }.at(score - least),
        Modality::Histology => Logistic { offset: -1.509, slope: 10.455 }.at(score / median),
    }
}
