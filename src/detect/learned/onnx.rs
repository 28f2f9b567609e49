//! ONNX models of users, run by `rten`.

use super::{Model, Network, SPACING, SUPPRESSION, Threshold, WeightsError, in_range};
use crate::detect::Modality;
use crate::detect::calibration::Logistic;
use crate::image::{Plane, crop, mirror};
use rten::{Dimension, RunOptions, ThreadPool, Value};
use std::fmt;
use std::sync::Arc;

/// Default unit, in px: the sides of the input are padded to multiples of it, unless the metadata
/// give another unit.
///
/// Multiples of 32 px allow five halvings.
const MULTIPLE: &str = "32";
/// Smallest distance of a probability from 0 and from 1.
///
/// Closer probabilities are moved to this distance, because the logit of 0 or 1 is infinite.
const SURE: f32 = 1e-6;

/// An ONNX model, and the meaning of its output.
pub(super) struct Onnx {
    /// Model as `rten` has read it.
    model: rten::Model,
    /// Options of a run, with a pool of threads.
    options: RunOptions,
    /// `true` if the output is a probability, `false` if it is a logit.
    probability: bool,
    /// Unit, in px, of which the sides of the input must be multiples.
    multiple: usize,
}

impl fmt::Debug for Onnx {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Onnx").field("parameters", &self.model.total_params()).finish_non_exhaustive()
    }
}

impl Model {
    /// Reads the ONNX model in `bytes` and its metadata.
    ///
    /// # Errors
    /// Fails if the model cannot be run, if its input or output has another shape, or if its
    /// metadata are out of range.
    pub(super) fn onnx(bytes: &[u8]) -> Result<Self, WeightsError> {
        let model = rten::Model::load(bytes.to_vec()).map_err(|e| WeightsError::Onnx(e.to_string()))?;
        let word = |key| model.metadata().get(key);
        let number = |key, default, range, expected| {
            let given = word(key).unwrap_or(default);
            in_range(key, given, range, expected)
        };
        let spacing = number("spacing", "8", SPACING, "2–64 px")?;
        let suppression = number("suppression", "0.5", SUPPRESSION, "0.1–2 spacings")?;
        let threshold = number("threshold", "0.5", 1e-6..=1. - 1e-6, "a probability between 0 and 1")?;
        let multiple = number("multiple", MULTIPLE, 1. ..=256., "1–256 px")? as usize;
        let probability = match word("output") {
            None | Some("probability") => true,
            Some("logit") => false,
            Some(other) => return Err(WeightsError::value("output", other, "probability or logit")),
        };
        let modality = word("modality").map(|m| m.parse::<Modality>());
        let modality = modality.transpose().map_err(|_| WeightsError::Metadata("modality".to_owned()))?;
        let mut options = RunOptions::default();
        let threads = rayon::current_num_threads();
        options.thread_pool = Some(Arc::new(ThreadPool::with_num_threads(threads)));
        let network = Onnx { model, options, probability, multiple };
        network.check()?;
        let logit = (threshold / (1. - threshold)).ln();
        Ok(Self {
            network: Network::Onnx(Box::new(network)),
            spacing,
            threshold: Threshold::Absolute { logit, in_noise: 0. },
            suppression,
            modality,
            // the errors of the model are unknown, so the score is the model's own probability
            calibration: Logistic { offset: logit, slope: 1. },
            better: false,
        })
    }
}

impl Onnx {
    /// Checks that the model takes one plane of any size and returns one plane of the same size.
    ///
    /// # Errors
    /// Fails if the shapes are others, or if the model fails on a test image of waves.
    fn check(&self) -> Result<(), WeightsError> {
        let (inputs, outputs) = (self.model.input_ids().len(), self.model.output_ids().len());
        if (inputs, outputs) != (1, 1) {
            let found = format!("it has {inputs} inputs and {outputs} outputs, expected one of each");
            return Err(WeightsError::Onnx(found));
        }
        if let Some(shape) = self.model.input_shape(0) {
            // `one` accepts a dimension of 1 or of any length, `free` only a dimension of any
            // length
            let one = |d: &Dimension| !matches!(d, Dimension::Fixed(n) if *n != 1);
            let free = |d: &Dimension| matches!(d, Dimension::Symbolic(_));
            if !matches!(&shape[..], [n, c, h, w] if one(n) && one(c) && free(h) && free(w)) {
                let found = format!("its input is {shape:?}, expected 1×1×H×W for any H and W");
                return Err(WeightsError::Onnx(found));
            }
        }
        let waves = |(y, x): (usize, usize)| 2. * (0.7 * x as f32).sin() * (0.8 * y as f32).cos();
        let side = 64usize.next_multiple_of(self.multiple);
        self.run(&Plane::from_shape_fn((side, 2 * side), waves)).map(|_| ())
    }

    /// Returns the logit at every pixel of `seen`.
    ///
    /// Beyond its right and lower border, the plane continues as its mirror image until its sides
    /// are multiples of `self.multiple` px.
    ///
    /// # Errors
    /// Fails if the model fails, or if its output is not a plane of logits or probabilities.
    pub(super) fn logits(&self, seen: &Plane) -> Result<Plane, WeightsError> {
        let (height, width) = seen.dim();
        let padded = Plane::from_shape_fn(
            (height.next_multiple_of(self.multiple), width.next_multiple_of(self.multiple)),
            |(y, x)| seen[[mirror(y as isize, height), mirror(x as isize, width)]],
        );
        Ok(crop(&self.run(&padded)?, 0, 0, height, width))
    }

    /// Returns the logits of a plane whose sides are already multiples of `self.multiple` px.
    fn run(&self, seen: &Plane) -> Result<Plane, WeightsError> {
        let (h, w) = seen.dim();
        let refused = |e: &dyn fmt::Display| WeightsError::Onnx(e.to_string());
        let input =
            Value::from_shape([1, 1, h, w], seen.iter().copied().collect()).map_err(|e| refused(&e))?;
        let output = self.model.run_one(input.into(), Some(self.options.clone())).map_err(|e| refused(&e))?;
        let (shape, values) = output.into_shape_vec::<f32, 4>().map_err(|e| refused(&e))?;
        if shape != [1, 1, h, w] {
            let found =
                format!("its output is {shape:?} for an input of [1, 1, {h}, {w}], expected the same");
            return Err(WeightsError::Onnx(found));
        }
        let mut out = Plane::from_shape_vec((h, w), values).map_err(|e| refused(&e))?;
        if let Some(value) = out.iter().find(|v| !v.is_finite()) {
            return Err(WeightsError::Onnx(format!(
                "its output contains {value}, expected finite numbers only"
            )));
        }
        if self.probability {
            if let Some(value) = out.iter().find(|v| !(0. ..=1.).contains(*v)) {
                let remedy = "if the model returns logits, set output=logit in its metadata \
                     (onnx.helper.set_model_props)";
                return Err(WeightsError::Onnx(format!(
                    "its output contains {value}, which is not a probability: {remedy}"
                )));
            }
            out.mapv_inplace(|p| {
                let p = p.clamp(SURE, 1. - SURE);
                (p / (1. - p)).ln()
            });
        }
        Ok(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detect::UserModel;

    /// Returns a field of a protocol buffer with bytes as its value: a text, or another message.
    fn field(number: u8, bytes: impl AsRef<[u8]>) -> Vec<u8> {
        let bytes = bytes.as_ref();
        assert!(bytes.len() < 1 << 14);
        let length = [(bytes.len() & 127) as u8 | 128, (bytes.len() >> 7) as u8];
        [&[number << 3 | 2][..], &length, bytes].concat()
    }

    /// Returns a field of a protocol buffer with a small integer as its value.
    fn integer(number: u8, value: u8) -> Vec<u8> {
        vec![number << 3, value]
    }

    /// Returns the description of a value of 1 × 1 × `sides`.
    fn plane(name: &str, sides: [Vec<u8>; 2]) -> Vec<u8> {
        let one = field(1, integer(1, 1));
        let [h, w] = sides.map(|side| field(1, side));
        let kind = [integer(1, 1), field(2, [one.clone(), one, h, w].concat())].concat();
        [field(1, name), field(2, field(1, kind))].concat()
    }

    /// Returns a model of one operator, whose input and output are 1 × 1 × `sides`.
    fn model(operator: &str, sides: [Vec<u8>; 2], metadata: &[(&str, &str)]) -> Vec<u8> {
        let node = [field(1, "seen"), field(2, "heat"), field(4, operator)].concat();
        let (input, output) = (plane("seen", sides.clone()), plane("heat", sides));
        let graph = [field(1, node), field(2, "g"), field(11, input), field(12, output)].concat();
        let words = metadata.iter().flat_map(|(k, v)| field(14, [field(1, k), field(2, v)].concat()));
        [integer(1, 8), field(7, graph), field(8, integer(2, 13)), words.collect()].concat()
    }

    fn open() -> [Vec<u8>; 2] {
        ["h", "w"].map(|name| field(2, name))
    }

    fn textured() -> Plane {
        Plane::from_shape_fn((45, 70), |(y, x)| (0.8 * x as f32).sin() * (0.7 * y as f32).cos())
    }

    fn difference(model: &Model) -> f32 {
        let seen = textured();
        let Network::Onnx(network) = &model.network else { panic!("another network") };
        let logits = network.logits(&seen).unwrap();
        assert_eq!(logits.dim(), seen.dim());
        (logits - seen).iter().map(|v| v.abs()).fold(0., f32::max)
    }

    #[test]
    fn logits_and_probabilities_mean_the_same() {
        let logit = model("Identity", open(), &[("output", "logit")]);
        assert_eq!(difference(&Model::onnx(&logit).unwrap()), 0.);
        let probability = model("Sigmoid", open(), &[]);
        assert!(difference(&Model::onnx(&probability).unwrap()) < 1e-5);
    }

    #[test]
    fn metadata_replace_the_defaults() {
        let words = [
            ("spacing", "10"),
            ("threshold", "0.2"),
            ("suppression", "0.7"),
            ("modality", "histology"),
            ("multiple", "8"),
        ];
        let model = Model::onnx(&model("Sigmoid", open(), &words)).unwrap();
        assert_eq!((model.spacing, model.suppression), (10., 0.7));
        assert_eq!(model.modality, Some(Modality::Histology));
        assert!(matches!(&model.network, Network::Onnx(network) if network.multiple == 8));
        assert!(
            matches!(model.threshold, Threshold::Absolute { logit, .. } if (logit - (0.25f64).ln()).abs() < 1e-9)
        );
    }

    #[test]
    fn what_is_no_heat_map_is_refused_with_the_reason() {
        let refused = |bytes: &[u8]| UserModel::new("own.onnx", bytes).unwrap_err().to_string();
        assert!(refused(&model("Identity", open(), &[])).contains("output=logit"));
        assert!(
            refused(&model("Sigmoid", [integer(1, 64), integer(1, 64)], &[])).contains("for any H and W")
        );
        assert!(refused(&model("Transpose", open(), &[])).contains("expected the same"));
        assert!(refused(&model("NoSuchThing", open(), &[])).contains("NoSuchThing"));
        for (key, value) in [
            ("spacing", "x"),
            ("threshold", "1"),
            ("suppression", "-1"),
            ("output", "heat"),
            ("multiple", "0"),
        ] {
            assert!(refused(&model("Sigmoid", open(), &[(key, value)])).contains(key));
        }
        let whole = model("Sigmoid", open(), &[]);
        (0..whole.len()).for_each(|end| drop(UserModel::new("cut off", &whole[..end])));
    }
}
