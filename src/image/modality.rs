use crate::choice::UnknownChoice;
use serde::{Deserialize, Serialize};
use strum::{Display, EnumString, IntoStaticStr, VariantArray, VariantNames};

/// Modality of an image: the technique by which it was taken.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
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
    parse_err_fn = UnknownChoice::among::<Modality>
)]
pub enum Modality {
    /// Confocal adaptive-optics ophthalmoscopy, in which a cone is a bright spot.
    Confocal,
    /// Split-detector adaptive-optics ophthalmoscopy, in which an inner segment is a dark–bright
    /// pair along x.
    Split,
    /// Histology, in which an inner segment is a disc, brighter or darker than its surroundings.
    Histology,
}

impl Modality {
    /// Returns the name that options and tables use.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// Sign of a cone's contrast.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
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
    parse_err_fn = UnknownChoice::among::<Polarity>
)]
pub enum Polarity {
    /// Contrast of cones that are brighter than their surroundings; in split detection, of cones
    /// that are dark on the left and bright on the right.
    Positive,
    /// Contrast of cones that are darker than their surroundings; in split detection, of cones that
    /// are bright on the left and dark on the right.
    Negative,
}

impl Polarity {
    /// Returns the name that options and tables use.
    pub fn name(self) -> &'static str {
        self.into()
    }
}
