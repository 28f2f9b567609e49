use crate::choice::UnknownChoice;
use serde::{Deserialize, Serialize};
use strum::{Display, EnumString, IntoStaticStr, VariantArray, VariantNames};

/// The way in which an image was taken.
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
    /// Confocal adaptive-optics ophthalmoscopy: a cone is a bright spot.
    Confocal,
    /// Split-detector adaptive-optics ophthalmoscopy: an inner segment is a dark–bright pair along x.
    Split,
    /// Histology: an inner segment is a disc, brighter or darker than what surrounds it.
    Histology,
}

impl Modality {
    /// Returns the word for it in options and tables.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// The sign of a cone's contrast.
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
    /// Cones brighter than what surrounds them; in split detection, dark on the left and bright on the right.
    Positive,
    /// The same with the sign turned.
    Negative,
}

impl Polarity {
    /// Returns the word for it in options and tables.
    pub fn name(self) -> &'static str {
        self.into()
    }
}
