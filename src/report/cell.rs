use super::significant;
use serde::{Serialize, Serializer};

/// The value of one cell of a table.
///
/// Files contain it in full precision; a missing value is an empty cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A piece of text.
    Text(String),
    /// A whole number, usually a count.
    Count(usize),
    /// A measured number, in the unit of its column.
    Number(f64),
    /// A value that is not known, or not defined for these points.
    Missing,
}

impl Cell {
    /// Returns the value for a reader: numbers with four significant digits, a dash if missing.
    pub fn readable(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Count(n) => n.to_string(),
            Self::Number(v) => significant(*v, 4),
            Self::Missing => "–".into(),
        }
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.into())
    }
}

impl From<usize> for Cell {
    fn from(n: usize) -> Self {
        Self::Count(n)
    }
}

impl From<f64> for Cell {
    fn from(v: f64) -> Self {
        if v.is_finite() { Self::Number(v) } else { Self::Missing }
    }
}

impl<T: Into<Self>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Missing, Into::into)
    }
}

impl Serialize for Cell {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Text(text) => serializer.serialize_str(text),
            Self::Count(n) => serializer.serialize_u64(*n as u64),
            Self::Number(v) => serializer.serialize_f64(*v),
            Self::Missing => serializer.serialize_none(),
        }
    }
}
