use super::{Quantity, SummaryKind};
use crate::report::{Cell, MosaicRecord};

/// A unit that a quantity is given in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    /// That of the coordinates: px of an image.
    Coordinates,
    Micrometres,
    Degrees,
    Arcminutes,
}

impl Unit {
    pub const ALL: [Self; 4] = [Self::Coordinates, Self::Micrometres, Self::Degrees, Self::Arcminutes];

    /// What a column's name ends in.
    pub fn suffix(self, quantity: Quantity, kind: SummaryKind) -> &'static str {
        match (quantity, self, kind) {
            (Quantity::Plain(_), ..) | (_, Self::Coordinates, SummaryKind::Coordinates) => "",
            (Quantity::Length, Self::Coordinates, _) => "_px",
            (Quantity::Length, Self::Micrometres, _) => "_um",
            (Quantity::Length, Self::Degrees, _) => "_deg",
            (Quantity::Length, Self::Arcminutes, _) => "_arcmin",
            (Quantity::Area, Self::Coordinates, _) => "_px2",
            (Quantity::Area, Self::Micrometres, _) => "_mm2",
            (Quantity::Area, Self::Degrees, _) => "_deg2",
            (Quantity::Area, Self::Arcminutes, _) => "_arcmin2",
            (Quantity::Density, Self::Coordinates, _) => "_per_px2",
            (Quantity::Density, Self::Micrometres, _) => "_per_mm2",
            (Quantity::Density, Self::Degrees, _) => "_per_deg2",
            (Quantity::Density, Self::Arcminutes, _) => "_per_arcmin2",
        }
    }

    /// In words.
    pub fn words(self, quantity: Quantity, kind: SummaryKind) -> &'static str {
        let unit = matches!(kind, SummaryKind::Coordinates);
        match (quantity, self) {
            (Quantity::Plain(words), _) => words,
            (Quantity::Length, Self::Coordinates) => {
                if unit {
                    "column “unit”"
                } else {
                    "px"
                }
            }
            (Quantity::Length, Self::Micrometres) => "µm",
            (Quantity::Length, Self::Degrees) => "degrees",
            (Quantity::Length, Self::Arcminutes) => "arcmin",
            (Quantity::Area, Self::Coordinates) => {
                if unit {
                    "column “unit”, squared"
                } else {
                    "px²"
                }
            }
            (Quantity::Area, Self::Micrometres) => "mm²",
            (Quantity::Area, Self::Degrees) => "degrees²",
            (Quantity::Area, Self::Arcminutes) => "arcmin²",
            (Quantity::Density, Self::Coordinates) => {
                if unit {
                    "1/“unit”²"
                } else {
                    "1/px²"
                }
            }
            (Quantity::Density, Self::Micrometres) => "1/mm²",
            (Quantity::Density, Self::Degrees) => "1/degree²",
            (Quantity::Density, Self::Arcminutes) => "1/arcmin²",
        }
    }

    /// A value in the unit of the coordinates, in this one; missing where the scale is not known.
    pub fn convert(self, value: Cell, quantity: Quantity, mosaic: &MosaicRecord) -> Cell {
        let (Cell::Number(number), false) = (&value, self == Self::Coordinates) else { return value };
        let um = mosaic.um_per_unit;
        // how many of the unit's lengths a unit of the coordinates is long
        let length = match self {
            Self::Coordinates => Some(1.),
            Self::Micrometres if quantity == Quantity::Length => um,
            Self::Micrometres => um.map(|um| um / 1e3),
            Self::Degrees => um.zip(mosaic.um_per_degree).map(|(um, degree)| um / degree),
            Self::Arcminutes => um.zip(mosaic.um_per_degree).map(|(um, degree)| 60. * um / degree),
        };
        let Some(length) = length else { return Cell::Missing };
        match quantity {
            Quantity::Plain(_) => value,
            Quantity::Length => (number * length).into(),
            Quantity::Area => (number * (length * length)).into(),
            Quantity::Density => (number / (length * length)).into(),
        }
    }
}
