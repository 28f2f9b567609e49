use super::{DetectError, Modality, Polarity, SPACING_RANGE, UserModel, WIDEST_SPACING};
use crate::choice::UnknownChoice;
use serde::{Deserialize, Serialize};
use strum::{Display, EnumString, IntoStaticStr, VariantArray, VariantNames};

/// Family of filters that finds the cones.
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
    /// Automatic choice: the family that scored higher on hand-marked images of the modality.
    #[default]
    Auto,
    /// Hand-designed band-pass filters, one per modality.
    Classical,
    /// Small convolutional networks, one per modality.
    Learned,
}

impl Detector {
    /// Returns the name that options and tables use.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// Options of detection; by default everything is decided from the image.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct DetectOptions {
    /// Modality of the image; `None` to decide it from the image.
    pub modality: Option<Modality>,
    /// Sign of the cones' contrast; `None` to decide it from the image.
    pub polarity: Option<Polarity>,
    /// Family of filters that finds the cones.
    pub detector: Detector,
    /// Cone spacing in px (4–160), from which the density of the cones found may move it by at most
    /// 10 %; `None` to estimate it from the image.
    pub spacing: Option<f64>,
    /// Cone spacing in px (4–160) to start from, instead of the one that Yellott's ring in the
    /// spectrum shows; the density may move it as far as that one. Not used if `spacing` is set.
    pub spacing_from: Option<f64>,
    /// Direction of the derivative in split-detector images, in degrees counter-clockwise as seen
    /// from x; `None` to find it in the image. Other modalities have no such direction.
    pub split_angle: Option<f64>,
    /// User's own network, used instead of the built-in one on images of the modality that it was
    /// made for.
    pub model: Option<UserModel>,
}

impl DetectOptions {
    /// Checks that the options are in range and do not contradict each other.
    ///
    /// # Errors
    /// Fails if the spacing is outside 4–160 px or the angle is not a finite number. Fails also if
    /// `model` is set but would not be used, because the detector is classical or the modality is
    /// another than the model's.
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
        let range = SPACING_RANGE.0..=WIDEST_SPACING;
        if let Some(angle) = self.split_angle.filter(|a| !a.is_finite()) {
            return Err(DetectError::SplitAngle(angle));
        }
        match self.spacing.into_iter().chain(self.spacing_from).find(|s| !range.contains(s)) {
            Some(s) => Err(DetectError::Spacing(s)),
            None => Ok(()),
        }
    }

    /// Returns the spacing in px that the user set to be kept or to start from, if any.
    pub(super) fn spacing_start(&self) -> Option<f64> {
        self.spacing.or(self.spacing_from)
    }
}
