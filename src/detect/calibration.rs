//! Calibration of two probabilities: that a person would mark a cone where a filter responds, and
//! that the spacing is right.
//!
//! Both are logistic regressions, fitted by `scripts/fit-calibration`.

use super::Detection;

/// Logistic function 1 / (1 + exp(−(offset + slope · x))) of one variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Logistic {
    /// Logit at x = 0.
    pub offset: f64,
    /// Increase of the logit with x.
    pub slope: f64,
}

impl Logistic {
    /// Returns the value of the function at `x`, between 0 and 1.
    pub(super) fn at(self, x: f64) -> f64 {
        1. / (1. + (-(self.offset + self.slope * x)).exp())
    }
}

/// Returns the probability that a spacing is within 15 % of the true one.
///
/// - `sure` is the confidence of the ring: the probability (0–1) that its spacing is right.
/// - `moved` is the absolute logarithm of the factor by which the density of the detections changed
///   the ring's spacing.
/// - `clarity` (see [`RingProfile::clarity`](super::RingProfile::clarity)) lowers the probability
///   if it is below 1. The ring then has less than e times the power of detail finer than any cone,
///   and even white noise has such rings.
///
/// The coefficients are a logistic regression by `scripts/fit-calibration` on hand-marked and
/// simulated images, among them blurred and noisy ones and white noise.
pub(super) fn spacing(sure: f64, moved: f64, clarity: f64) -> f64 {
    // no image is beyond doubt, and a probability of 0 or 1 has no logit
    let sure = sure.clamp(0.001, 0.999);
    let sure = (sure / (1. - sure)).ln();
    let unclear = (1. - clarity).max(0.);
    Logistic { offset: 1.397, slope: 1. }.at(0.792 * sure - 9.374 * moved - 9.685 * unclear)
}

/// Height against which a classical filter's response is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reference {
    /// Median height of the image's cones; the response is divided by it.
    Median,
    /// Height that a cone in the image must exceed; it is subtracted from the response.
    Least,
}

impl Reference {
    /// Returns the function that measures a height against the reference.
    ///
    /// `cones` are the cones of the image, the highest first. `least` is the height that a cone had
    /// to exceed.
    pub(super) fn against(self, cones: &[Detection], least: f64) -> impl Fn(f64) -> f64 + use<> {
        let median = cones.get(cones.len() / 2).map_or(1., |d| d.score).max(f64::MIN_POSITIVE);
        move |height| match self {
            Self::Median => height / median,
            Self::Least => height - least,
        }
    }
}
