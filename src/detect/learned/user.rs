use super::{Model, WeightsError};
use crate::detect::Modality;
use serde::{Serialize, Serializer};
use sha2::{Digest, Sha256};
use std::sync::Arc;

/// A user's own network; cheap to clone. Two models are equal if their files have the same bytes.
///
/// There are two kinds:
///
/// - Weights as `scripts/train-detector` writes them (safetensors).
/// - With the feature `onnx`, an ONNX model from 1×1×H×W to 1×1×H×W. The input is the image,
///   resampled and normalised, with bright cones positive; H and W are multiples of 32 px. The
///   output is the probability that a cone's centre lies in each pixel.
///
/// An ONNX model may have these metadata:
///
/// - `spacing`: px between cones in the input, default 8
/// - `output`: `probability` (the default) or `logit`
/// - `multiple`: unit in px of which H and W are multiples, default 32
/// - `threshold`: probability above which a maximum is a cone, default 0.5
/// - `suppression`: radius of suppression in spacings, default 0.5
/// - `modality`: modality of the images that the model is for, by default all
#[derive(Clone, Debug)]
pub struct UserModel {
    /// Name by which errors call the model.
    name: Arc<str>,
    /// Network as read from the file.
    model: Arc<Model>,
    /// SHA-256 hash of the file, in hexadecimal digits.
    sha256: Arc<str>,
}

impl UserModel {
    /// Reads the model in the bytes of a file; `name` stands for the model in errors.
    ///
    /// # Errors
    /// Fails if the bytes are neither kind of model, if they are damaged, or if the metadata of the
    /// model are out of range.
    pub fn new(name: &str, bytes: &[u8]) -> Result<Self, WeightsError> {
        let model = match bytes {
            // safetensors begins with 8 bytes of length and a JSON object of that length
            [_, _, _, _, _, _, _, _, b'{', ..] => Model::read(bytes)?,
            // ONNX is a protocol buffer whose first field is the version, a number
            [8, ..] => Model::onnx(bytes)?,
            _ => return Err(WeightsError::Kind),
        };
        let sha256 = Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect::<String>();
        Ok(Self { name: name.into(), model: Arc::new(model), sha256: sha256.into() })
    }

    /// Returns the name of the model, as it was passed to [`UserModel::new`].
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the modality that the model was made for; `None` if it is for all images.
    pub fn modality(&self) -> Option<Modality> {
        self.model.modality
    }

    /// Returns the model if it is for images of `modality`, otherwise `None`.
    pub(in crate::detect) fn for_modality(&self, modality: Modality) -> Option<&Model> {
        self.modality().is_none_or(|own| own == modality).then_some(&*self.model)
    }
}

impl PartialEq for UserModel {
    fn eq(&self, other: &Self) -> bool {
        self.sha256 == other.sha256
    }
}

/// Serialisation as the SHA-256 hash of the model's bytes: results that depend on the model depend
/// on nothing else of it, such as its name.
impl Serialize for UserModel {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.sha256)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    static CONFOCAL: &[u8] = include_bytes!("confocal.safetensors");
    static SPLIT: &[u8] = include_bytes!("split.safetensors");

    #[test]
    fn weights_serve_the_modality_they_were_trained_for() {
        let model = UserModel::new("own.safetensors", SPLIT).unwrap();
        assert_eq!(model.modality(), Some(Modality::Split));
        assert!(model.for_modality(Modality::Split).is_some());
        assert!(model.for_modality(Modality::Confocal).is_none());
    }

    #[test]
    fn models_are_what_their_bytes_are() {
        let model = UserModel::new("a", SPLIT).unwrap();
        assert_eq!(model, UserModel::new("b", SPLIT).unwrap());
        let other = UserModel::new("a", CONFOCAL).unwrap();
        assert_ne!(model, other);
        let json = |m: &UserModel| serde_json::to_string(m).unwrap();
        assert_eq!(json(&model).len(), 66);
        assert_ne!(json(&model), json(&other));
    }

    #[test]
    fn other_files_are_refused_with_the_reason() {
        let error = |bytes: &[u8]| UserModel::new("file", bytes).unwrap_err();
        assert_eq!(error(b""), WeightsError::Kind);
        assert_eq!(error(b"\x89PNG\r\n\x1a\n, an image"), WeightsError::Kind);
        assert!(matches!(error(&CONFOCAL[..2000]), WeightsError::Format(_) | WeightsError::Tensor { .. }));
        let changed = |from: &str, to: &str| {
            assert_eq!(from.len(), to.len());
            let start = CONFOCAL.windows(from.len()).position(|w| w == from.as_bytes()).unwrap();
            let mut bytes = CONFOCAL.to_vec();
            bytes[start..start + to.len()].copy_from_slice(to.as_bytes());
            error(&bytes).to_string()
        };
        assert!(changed(r#""suppression": "0."#, r#""suppression": "-."#).contains("suppression"));
        assert!(changed(r#""spacing": "8""#, r#""spacing": "0""#).contains("spacing"));
        assert!(changed(r#""modality": "confocal""#, r#""modality": "infrared""#).contains("modality"));
        assert!(changed(r#""unet""#, r#""nets""#).contains("nets"));
    }
}
