use super::significant;
use serde::{Serialize, Serializer};

/// One value of a table. Serialised in full precision, as files hold it; empty if missing.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A count.
    Count(usize),
    /// A measured number, in the unit that its column is named after.
    Number(f64),
    /// Not known, or not defined for these points.
    Missing,
}

impl Cell {
    /// With the digits that mean something to a reader; a dash if missing.
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
