//! What a filter's response says about the probability that a person would mark a cone there, and what the spectrum and the count say
//! about that of the spacing.

use super::Detection;

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

/// The probability that a spacing is within 15 % of the true one: by how `sure` the ring is of its own (0–1), by how far, as a
/// logarithm, the density of the detections has `moved` it from there, and, if the ring stands out less than e times from detail
/// finer than any cone, by the `clarity` of the image (see [`RingProfile::clarity`](super::RingProfile::clarity)): white noise has rings too.
/// Logistic regression by scripts/fit-calibration on hand-marked and on simulated images, blurred and noisy ones and white noise
/// among them.
pub(super) fn spacing(sure: f64, moved: f64, clarity: f64) -> f64 {
    // an image is never beyond doubt
    let sure = sure.clamp(0.001, 0.999);
    let sure = (sure / (1. - sure)).ln();
    let unclear = (1. - clarity).max(0.);
    Logistic { offset: 1.397, slope: 1. }.at(0.792 * sure - 9.374 * moved - 9.685 * unclear)
}

/// What the height of a classical filter's response is measured against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reference {
    /// The median of the cones of the image: their ratio counts.
    Median,
    /// The least height of a cone in the image: their difference counts.
    Least,
}

impl Reference {
    /// Returns heights measured against it, given the `cones` of the image, highest first, and how high a cone had to be.
    pub(super) fn against(self, cones: &[Detection], least: f64) -> impl Fn(f64) -> f64 + use<> {
        let median = cones.get(cones.len() / 2).map_or(1., |d| d.score).max(f64::MIN_POSITIVE);
        move |height| match self {
            Self::Median => height / median,
            Self::Least => height - least,
        }
    }
}
