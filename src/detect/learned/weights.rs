//! Reader of weights in the safetensors format.

use super::convolution::Kernel;
use serde_json::{Map, Value};
use thiserror::Error;

/// Reasons why a file of weights cannot be used.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum WeightsError {
    /// File that is cut off or not in the safetensors format.
    #[error("not a safetensors file: {0}")]
    Format(&'static str),
    /// File that is neither a safetensors file nor an ONNX model.
    #[error("neither a safetensors file from scripts/train-detector nor an ONNX model: give one of these")]
    Kind,
    /// ONNX model in a build of the program that cannot run such models.
    #[error("this build cannot run ONNX models: build one that can (cargo install --path . --features onnx)")]
    NoOnnx,
    /// ONNX model that cannot be run, or whose output cannot be used.
    #[error("the ONNX model cannot be used: {0}")]
    Onnx(String),
    /// Value in the metadata that is not among those accepted.
    #[error("{key} in its metadata is “{value}”: expected {expected}")]
    Value {
        /// Key of the metadata.
        key: &'static str,
        /// Value that was found.
        value: String,
        /// Values that are accepted, in words.
        expected: &'static str,
    },
    /// Value in the metadata that is missing or cannot be understood.
    #[error("“{0}” is missing from its header or cannot be read")]
    Metadata(String),
    /// Network with an architecture that this program cannot run.
    #[error("unknown architecture “{0}”: expected unet")]
    Architecture(String),
    /// Tensor that is missing, is of another shape or type, or has a value that is not finite.
    #[error("tensor “{name}” is missing or is not F32 of shape {shape:?}")]
    Tensor {
        /// Name of the tensor.
        name: String,
        /// Shape that was expected.
        shape: Vec<usize>,
    },
}

impl WeightsError {
    /// Returns the error for a `value` under `key` in the metadata that is not one of those
    /// `expected`.
    pub(super) fn value(key: &'static str, value: &str, expected: &'static str) -> Self {
        Self::Value { key, value: value.to_owned(), expected }
    }
}

/// Largest number of channels that is accepted; a larger number is a sign of a damaged header.
const WIDEST: u64 = 1024;

/// A safetensors file: eight bytes of length, a JSON header of that length, then the bytes of the
/// tensors.
pub(super) struct Weights<'a> {
    /// Header: the metadata, and the type, shape and position of every tensor.
    header: Map<String, Value>,
    /// Bytes of all tensors.
    tensors: &'a [u8],
}

impl<'a> Weights<'a> {
    /// Splits a file into its header and its tensors.
    ///
    /// # Errors
    /// Fails if `bytes` does not begin with a safetensors header.
    pub(super) fn read(bytes: &'a [u8]) -> Result<Self, WeightsError> {
        let (length, rest) =
            bytes.split_first_chunk::<8>().ok_or(WeightsError::Format("shorter than 8 bytes"))?;
        let length = usize::try_from(u64::from_le_bytes(*length)).unwrap_or(usize::MAX);
        let (header, tensors) =
            rest.split_at_checked(length).ok_or(WeightsError::Format("the header is cut off"))?;
        let header = serde_json::from_slice(header)
            .map_err(|_| WeightsError::Format("the header is not a JSON object"))?;
        Ok(Self { header, tensors })
    }

    /// Returns the text under `key` in the header's metadata.
    pub(super) fn word(&self, key: &str) -> Result<&str, WeightsError> {
        let word = self.header.get("__metadata__").and_then(|m| m.get(key)).and_then(Value::as_str);
        word.ok_or_else(|| WeightsError::Metadata(key.to_owned()))
    }

    /// Returns the finite number under `key` in the header's metadata.
    pub(super) fn number(&self, key: &str) -> Result<f64, WeightsError> {
        let number = self.word(key)?.parse().ok().filter(|v: &f64| v.is_finite());
        number.ok_or_else(|| WeightsError::Metadata(key.to_owned()))
    }

    /// Returns the finite number under `key`, or `otherwise` if the metadata do not have that key.
    pub(super) fn number_or(&self, key: &'static str, otherwise: f64) -> Result<f64, WeightsError> {
        if self.word(key).is_err() { Ok(otherwise) } else { self.number(key) }
    }

    /// Returns the convolution `name`, from the tensors `name.weight` and `name.bias`.
    pub(super) fn kernel(
        &self,
        name: &str,
        outputs: usize,
        inputs: usize,
        side: usize,
    ) -> Result<Kernel, WeightsError> {
        let weights = self.tensor(&format!("{name}.weight"), &[outputs, inputs, side, side])?;
        let bias = self.tensor(&format!("{name}.bias"), &[outputs])?;
        Ok(Kernel { outputs, inputs, side, weights, bias })
    }

    /// Returns the number of output channels of the convolution `name`.
    pub(super) fn outputs(&self, name: &str) -> Result<usize, WeightsError> {
        let name = format!("{name}.bias");
        let shape = self.header.get(&name).and_then(|entry| entry.get("shape"));
        let outputs =
            shape.and_then(|s| s.get(0)).and_then(Value::as_u64).filter(|n| (1..=WIDEST).contains(n));
        outputs.map(|n| n as usize).ok_or(WeightsError::Tensor { name, shape: vec![] })
    }

    /// Returns the values of the tensor `name`, row by row; its shape must be `shape`.
    pub(super) fn tensor(&self, name: &str, shape: &[usize]) -> Result<Vec<f32>, WeightsError> {
        let find = || {
            let entry = self.header.get(name)?;
            let numbers = |key: &str| -> Option<Vec<usize>> {
                entry.get(key)?.as_array()?.iter().map(|v| v.as_u64().map(|v| v as usize)).collect()
            };
            let (found, offsets) = (numbers("shape")?, numbers("data_offsets")?);
            let &[from, to] = &offsets[..] else { return None };
            let bytes = self.tensors.get(from..to)?;
            let values: Vec<f32> = match entry.get("dtype")?.as_str()? {
                "F32" if bytes.len().is_multiple_of(4) => {
                    bytes.as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect()
                }
                _ => return None,
            };
            let fits = found == shape && values.len() == shape.iter().product::<usize>();
            (fits && values.iter().all(|v| v.is_finite())).then_some(values)
        };
        find().ok_or_else(|| WeightsError::Tensor { name: name.to_owned(), shape: shape.to_vec() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(header: &str, tensors: &[u8]) -> Vec<u8> {
        let mut bytes = (header.len() as u64).to_le_bytes().to_vec();
        bytes.extend(header.as_bytes());
        bytes.extend(tensors);
        bytes
    }

    #[test]
    fn tensors_and_words_are_read() {
        let header = r#"{"__metadata__":{"rule":"absolute","threshold":"-0.5"},
            "a.weight":{"dtype":"F32","shape":[1,1,1,1],"data_offsets":[0,4]},
            "a.bias":{"dtype":"F32","shape":[1],"data_offsets":[4,8]}}"#;
        let tensors: Vec<u8> = [2.5f32, -1.].iter().flat_map(|v| v.to_le_bytes()).collect();
        let bytes = file(header, &tensors);
        let weights = Weights::read(&bytes).unwrap();
        assert_eq!((weights.word("rule"), weights.number("threshold")), (Ok("absolute"), Ok(-0.5)));
        let kernel = weights.kernel("a", 1, 1, 1).unwrap();
        assert_eq!((kernel.weights, kernel.bias), (vec![2.5], vec![-1.]));
        assert_eq!((weights.outputs("a"), weights.outputs("b").is_err()), (Ok(1), true));
        let halves = header.replace("F32", "F16");
        assert!(Weights::read(&file(&halves, &tensors)).unwrap().kernel("a", 1, 1, 1).is_err());
        assert!(weights.kernel("a", 2, 1, 1).is_err());
        assert!(weights.kernel("b", 1, 1, 1).is_err());
        assert!(weights.number("rule").is_err());
    }

    #[test]
    fn files_that_are_cut_off_are_refused() {
        let header = r#"{"a.bias":{"dtype":"F32","shape":[2],"data_offsets":[0,8]}}"#;
        let bytes = file(header, &[0; 4]);
        assert!(Weights::read(&bytes[..5]).is_err());
        assert!(Weights::read(&bytes[..20]).is_err());
        assert!(Weights::read(&[255; 40]).is_err());
        assert!(Weights::read(&bytes).unwrap().tensor("a.bias", &[2]).is_err());
    }
}
