//! Learned filters: one small convolutional network per modality.
//!
//! They are trained by `scripts/train-detector`, and their weights are compiled into the program.
//! MODEL_CARD.md beside this file describes data, scores and limits.

mod convolution;
mod input;
mod maps;
mod network;
#[cfg(feature = "onnx")]
mod onnx;
mod user;
mod weights;

pub use user::UserModel;
pub use weights::WeightsError;

use super::calibration::Logistic;
use super::finder::{ConeFinder, Found, Sought};
use super::spacing::CLEAR;
use super::{Detection, Modality, Polarity, local_maxima, suppress};
use crate::geometry::Point;
use crate::image::Plane;
use std::ops::RangeInclusive;
use weights::Weights;

/// Range of the cone spacing, in px, for which a model can be made.
const SPACING: RangeInclusive<f64> = 2. ..=64.;
/// Range of a model's radius of suppression, in spacings.
const SUPPRESSION: RangeInclusive<f64> = 0.1..=2.;
/// Logit (a probability of 1.1 %) above which a maximum is a candidate for a cone, unless the model
/// has a lower threshold.
const CANDIDATE: f32 = -4.5;
/// Quantile of the logits of an image's stronger maxima from which a relative threshold is
/// computed: the upper quartile ([`Threshold::Relative`]).
const QUANTILE: f64 = 0.75;

/// A network with everything that turns its output into cones.
#[derive(Debug)]
pub(super) struct Model {
    /// Network that gives the logits.
    network: Network,
    /// Cone spacing, in px, to which images are resampled for the network.
    spacing: f64,
    /// Rule by which maxima are taken for cones.
    threshold: Threshold,
    /// Distance, in spacings, below which only the higher of two maxima stays.
    suppression: f64,
    /// Modality that the model is for; `None` if it is for all images.
    pub(super) modality: Option<Modality>,
    /// Logistic function from the logit of a maximum less the threshold to the probability of a
    /// cone.
    calibration: Logistic,
    /// `true` if the network was measured to find cones better than the classical filter.
    ///
    /// The measure is the mean Dice coefficient on subjects left out of training.
    pub(super) better: bool,
}

/// A network that gives the logit of a cone's centre for every pixel.
#[derive(Debug)]
enum Network {
    /// Network from a file of weights, run by the program itself.
    Own(Box<network::Network>),
    /// User's ONNX model, run by `rten`.
    #[cfg(feature = "onnx")]
    Onnx(Box<onnx::Onnx>),
}

/// Rule that gives the logit above which a maximum is a cone.
#[derive(Debug)]
enum Threshold {
    /// Threshold that does not depend on the other maxima: `logit`, plus `in_noise` for every unit
    /// by which the image's clarity is below [`CLEAR`].
    Absolute { logit: f64, in_noise: f64 },
    /// The upper quartile of the logits of the image's stronger maxima, less `below`.
    ///
    /// Stronger maxima are above `floor` and remain after suppression at `radius` spacings.
    Relative { below: f64, floor: f32, radius: f64 },
}

impl Model {
    /// Reads the network in a file of weights.
    ///
    /// # Errors
    /// Fails if the weights are damaged or their metadata are out of range.
    pub(super) fn read(file: &[u8]) -> Result<Self, WeightsError> {
        let weights = Weights::read(file)?;
        let threshold = match weights.word("rule")? {
            "absolute" => Threshold::Absolute {
                logit: weights.number("threshold")?,
                // files from before this rule have no such number
                in_noise: weights.number_or("threshold_in_noise", 0.)?,
            },
            "relative" => Threshold::Relative {
                below: weights.number("threshold")?,
                floor: weights.number("relative_floor")? as f32,
                radius: weights.number("relative_radius")?,
            },
            _ => return Err(WeightsError::Metadata("rule".to_owned())),
        };
        let number = |key, range, expected| in_range(key, weights.word(key)?, range, expected);
        let modality = weights.word("modality")?.parse();
        let dice = |key| weights.number(key).ok();
        Ok(Self {
            network: Network::Own(Box::new(network::Network::new(&weights)?)),
            spacing: number("spacing", SPACING, "2–64 px")?,
            threshold,
            suppression: number("suppression", SUPPRESSION, "0.1–2 spacings")?,
            modality: Some(modality.map_err(|_| WeightsError::Metadata("modality".to_owned()))?),
            calibration: Logistic {
                offset: weights.number("calibration_offset")?,
                slope: weights.number("calibration_slope")?,
            },
            better: dice("dice").zip(dice("classical_dice")).is_some_and(|(own, classical)| own > classical),
        })
    }

    #[cfg(not(feature = "onnx"))]
    fn onnx(_: &[u8]) -> Result<Self, WeightsError> {
        Err(WeightsError::NoOnnx)
    }

    /// Returns the logit above which a maximum is a candidate.
    fn candidate(&self) -> f32 {
        match self.threshold {
            Threshold::Absolute { logit, .. } => CANDIDATE.min(logit as f32),
            Threshold::Relative { .. } => CANDIDATE,
        }
    }

    /// Returns the logit above which a maximum is a cone, in an image with the candidates `maxima`
    /// and the clarity `clarity`.
    fn threshold_for(&self, maxima: &[Detection], clarity: f64) -> f64 {
        match self.threshold {
            Threshold::Absolute { logit, in_noise } => logit + in_noise * (CLEAR - clarity).max(0.),
            Threshold::Relative { below, floor, radius } => {
                let strong = maxima.iter().copied().filter(|d| d.score > f64::from(floor)).collect();
                let scores: Vec<f64> =
                    suppress(strong, radius * self.spacing).iter().rev().map(|d| d.score).collect();
                quantile(&scores, QUANTILE) - below
            }
        }
    }
}

impl ConeFinder for Model {
    fn find(&self, image: &Plane, sought: Sought) -> Result<Found, WeightsError> {
        let step = sought.spacing / self.spacing;
        let seen = input::normalised(&input::resampled(image, step));
        let seen = if sought.polarity == Polarity::Negative { -seen } else { seen };
        // the number of new pixels is rounded, so the resampled image may extend beyond the image:
        // centres there are moved back to its edge
        let (right, lower) = (image.ncols() as f64 - 0.5, image.nrows() as f64 - 0.5);
        let logits = match &self.network {
            Network::Own(network) => network.logits(&seen),
            #[cfg(feature = "onnx")]
            Network::Onnx(network) => network.logits(&seen)?,
        };
        let maxima = local_maxima(&logits, self.candidate());
        let threshold = self.threshold_for(&maxima, sought.clarity);
        let (mut cones, mut rejected): (Vec<_>, Vec<_>) =
            suppress(maxima, self.suppression * self.spacing).into_iter().partition(|d| d.score > threshold);
        for cone in cones.iter_mut().chain(&mut rejected) {
            let Point { x, y } = cone.centre;
            cone.centre =
                Point::new(((x + 0.5) * step - 0.5).min(right), ((y + 0.5) * step - 0.5).min(lower));
            cone.score = self.calibration.at(cone.score - threshold);
        }
        Ok(Found { cones, rejected })
    }

    /// Returns .03 (3 %): networks tolerate more change of the spacing, since they are trained at
    /// spacings off by up to 15 %.
    fn settled(&self) -> f64 {
        0.03
    }
}

/// Returns the number in `text`, a value that a model's metadata contain under `key`.
///
/// # Errors
/// Fails if `text` is not a number in `range`. The message calls that range `expected`.
fn in_range(
    key: &'static str,
    text: &str,
    range: RangeInclusive<f64>,
    expected: &'static str,
) -> Result<f64, WeightsError> {
    let number = text.parse().ok().filter(|v| range.contains(v));
    number.ok_or_else(|| WeightsError::value(key, text, expected))
}

/// Returns the quantile of values in rising order, interpolated linearly, or infinity if there are
/// none.
fn quantile(rising: &[f64], part: f64) -> f64 {
    crate::numeric::linear_quantile(rising, part).unwrap_or(f64::INFINITY)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detect::spec::{SPECS, spec};

    /// The script that trains writes two things beside the weights: an image in which cones are
    /// 10 px apart, and its own network's output for that image.
    #[test]
    fn the_program_and_the_script_that_trained_it_see_the_same() {
        let examples: [&[u8]; 3] = [
            include_bytes!("confocal.example.safetensors"),
            include_bytes!("split.example.safetensors"),
            include_bytes!("histology.example.safetensors"),
        ];
        for (spec, example) in SPECS.iter().zip(examples) {
            let [weights, example] =
                [spec.network.weights(), example].map(|file| Weights::read(file).unwrap());
            let plane =
                |name, h, w| Plane::from_shape_vec((h, w), example.tensor(name, &[h, w]).unwrap()).unwrap();
            let image = plane("image", 44, 40);
            let seen = input::normalised(&input::resampled(&image, 10. / 8.));
            let logits = network::Network::new(&weights).unwrap().logits(&seen);
            let expected = plane("logits", 35, 32);
            let difference = logits.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0., f32::max);
            // wide Gaussians are approximated here, and exact there
            assert!(difference < 1e-3, "{difference}");
        }
    }

    #[test]
    fn quartiles_lie_between_values() {
        assert_eq!(quantile(&[1., 2., 3., 4., 5.], 0.75), 4.);
        assert_eq!(quantile(&[1., 2.], 0.75), 1.75);
        assert_eq!(quantile(&[3.], 0.75), 3.);
        assert_eq!(quantile(&[], 0.75), f64::INFINITY);
    }

    #[test]
    fn the_reverse_of_an_image_has_the_same_cones_in_the_reverse_polarity() {
        let image = Plane::from_shape_fn((96, 96), |(y, x)| (0.7 * x as f32).sin() * (0.75 * y as f32).cos());
        let model = spec(Modality::Confocal).network.model().unwrap();
        let sought = |polarity| Sought { polarity, spacing: 9., clarity: f64::INFINITY };
        let found = model.find(&image, sought(Polarity::Positive)).unwrap();
        assert!(found.cones.len() > 20);
        assert_eq!(model.find(&-&image, sought(Polarity::Negative)).unwrap(), found);
    }
}
