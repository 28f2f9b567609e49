use crate::batch::BatchError;
use crate::mosaic::Mosaic;
use serde::{Serialize, Serializer};
use std::fmt;
use std::path::Path;
use std::str::FromStr;

/// A positive length, either in the unit of the coordinates or in µm. As text, a length in µm ends
/// in `um` or `µm`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Length {
    /// The length, positive and finite.
    value: f64,
    /// `true` if `value` is in µm, `false` if it is in the unit of the coordinates.
    micrometres: bool,
}

impl FromStr for Length {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (body, micrometres) = match text.strip_suffix("um").or_else(|| text.strip_suffix("µm")) {
            Some(body) => (body, true),
            None => (text, false),
        };
        match body.trim().parse::<f64>() {
            Ok(value) if value.is_finite() && value > 0. => Ok(Self { value, micrometres }),
            _ => Err(format!(
                "“{text}” is not a length: expected a positive number such as 5 (in the unit of the \
                 coordinates) or 5um (in µm)"
            )),
        }
    }
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.value, if self.micrometres { "um" } else { "" })
    }
}

impl Serialize for Length {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl Length {
    /// Returns the length in the unit of the coordinates of `mosaic`.
    ///
    /// `file` and `option` (the name of the length) are for the error message only.
    ///
    /// # Errors
    /// Fails if the length is in µm and the scale of the mosaic is not known.
    pub(in crate::batch) fn of(
        &self,
        option: &'static str,
        mosaic: &Mosaic,
        file: &Path,
    ) -> Result<f64, BatchError> {
        match (self.micrometres, mosaic.micrometres_per_unit()) {
            (false, _) => Ok(self.value),
            (true, Some(um)) => Ok(self.value / um),
            (true, None) => Err(BatchError::NoScale { what: option, file: file.to_owned() }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_say_their_unit() {
        let um: Length = "37.5um".parse().unwrap();
        assert_eq!((um.value, um.micrometres, um.to_string()), (37.5, true, "37.5um".to_owned()));
        assert_eq!("20".parse::<Length>().unwrap().to_string(), "20");
        for bad in ["", "um", "0", "-3", "nan", "inf", "5mm"] {
            assert!(bad.parse::<Length>().is_err(), "{bad}");
        }
    }
}
