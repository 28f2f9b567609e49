use super::{DetectError, Modality, Polarity, SPACING_RANGE, UserModel, WIDEST_SPACING};
use crate::choice::UnknownChoice;
use serde::{Deserialize, Serialize};
use strum::{Display, EnumString, IntoStaticStr, VariantArray, VariantNames};

/// Which family of filters finds the cones.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    Display,
    EnumString,
    IntoStaticStr,
    VariantArray,
    VariantNames,
)]
#[serde(rename_all = "snake_case")]
#[strum(
    serialize_all = "kebab-case",
    parse_err_ty = UnknownChoice,
    parse_err_fn = UnknownChoice::among::<Detector>
)]
pub enum Detector {
    /// The one that measured best on hand-marked images of the modality.
    #[default]
    Auto,
    /// Hand-designed band-pass filters (one a modality).
    Classical,
    /// Small convolutional networks, one a modality.
    Learned,
}

impl Detector {
    /// Returns the word for it in options and tables.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// What a user may fix about detection; by default everything is decided from the image.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct DetectOptions {
    /// How the image was taken; `None`: decided from the image.
    pub modality: Option<Modality>,
    /// Which way round the contrast runs; `None`: decided from the image.
    pub polarity: Option<Polarity>,
    /// Which filters find the cones.
    pub detector: Detector,
    /// Cone spacing in px (4–160) to start from instead of Yellott's ring; `None`: the ring.
    pub spacing: Option<f64>,
    /// A network of the user's own, in place of the program's for the modality it was made for.
    pub model: Option<UserModel>,
}

impl DetectOptions {
    /// # Errors
    /// If the spacing is out of its range, or a model is given that these options do not use.
    pub fn validate(&self) -> Result<(), DetectError> {
        if self.model.is_some() && self.detector == Detector::Classical {
            return Err(DetectError::Unused);
        }
        if let (Some(model), Some(given)) = (&self.model, self.modality)
            && let Some(own) = model.modality()
            && own != given
        {
            return Err(DetectError::OtherModality { name: model.name().to_owned(), own, given });
        }
        match self.spacing {
            Some(s) if !(SPACING_RANGE.0..=WIDEST_SPACING).contains(&s) => Err(DetectError::Spacing(s)),
            _ => Ok(()),
        }
    }
}
