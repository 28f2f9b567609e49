use super::{Quantity, SummaryKind};
use crate::report::{Cell, MosaicRecord};

/// A unit that a quantity is given in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    /// That of the coordinates; columns in it have no suffix.
    Coordinates,
    Pixels,
    Micrometres,
    Degrees,
    Arcminutes,
}

impl Unit {
    /// The units whose columns have a suffix, in the order of the columns.
    pub const SUFFIXED: [Self; 4] = [Self::Pixels, Self::Micrometres, Self::Degrees, Self::Arcminutes];

    /// Returns the units that a quantity has columns in. Those of an image are px, so that a column in the
    /// unit of its coordinates would say nothing new.
    pub fn all(quantity: Quantity, kind: SummaryKind) -> impl Iterator<Item = Self> {
        let plain = quantity == Quantity::Plain;
        let own = (plain || kind == SummaryKind::Coordinates).then_some(Self::Coordinates);
        let suffixed: &[Self] = if plain { &[] } else { &Self::SUFFIXED };
        own.into_iter().chain(suffixed.iter().copied())
    }

    /// Returns the end of a column's name.
    pub const fn suffix(self, quantity: Quantity) -> &'static str {
        match (quantity, self) {
            (Quantity::Plain, _) | (_, Self::Coordinates) => "",
            (Quantity::Length, Self::Pixels) => "_px",
            (Quantity::Length, Self::Micrometres) => "_um",
            (Quantity::Length, Self::Degrees) => "_deg",
            (Quantity::Length, Self::Arcminutes) => "_arcmin",
            (Quantity::Area, Self::Pixels) => "_px2",
            (Quantity::Area, Self::Micrometres) => "_mm2",
            (Quantity::Area, Self::Degrees) => "_deg2",
            (Quantity::Area, Self::Arcminutes) => "_arcmin2",
            (Quantity::Density, Self::Pixels) => "_per_px2",
            (Quantity::Density, Self::Micrometres) => "_per_mm2",
            (Quantity::Density, Self::Degrees) => "_per_deg2",
            (Quantity::Density, Self::Arcminutes) => "_per_arcmin2",
        }
    }

    /// Returns the unit in words; `plain` are those of a column whose unit is always the same.
    pub const fn words(self, quantity: Quantity, plain: &'static str) -> &'static str {
        match (quantity, self) {
            (Quantity::Plain, _) => plain,
            (Quantity::Length, Self::Coordinates) => "column “unit”",
            (Quantity::Length, Self::Pixels) => "px",
            (Quantity::Length, Self::Micrometres) => "µm",
            (Quantity::Length, Self::Degrees) => "degrees",
            (Quantity::Length, Self::Arcminutes) => "arcmin",
            (Quantity::Area, Self::Coordinates) => "column “unit”, squared",
            (Quantity::Area, Self::Pixels) => "px²",
            (Quantity::Area, Self::Micrometres) => "mm²",
            (Quantity::Area, Self::Degrees) => "degrees²",
            (Quantity::Area, Self::Arcminutes) => "arcmin²",
            (Quantity::Density, Self::Coordinates) => "1/“unit”²",
            (Quantity::Density, Self::Pixels) => "1/px²",
            (Quantity::Density, Self::Micrometres) => "1/mm²",
            (Quantity::Density, Self::Degrees) => "1/degree²",
            (Quantity::Density, Self::Arcminutes) => "1/arcmin²",
        }
    }

    /// Converts a value in the unit of the coordinates to this one; missing where the scale is not known.
    pub fn convert(self, value: Cell, quantity: Quantity, mosaic: &MosaicRecord) -> Cell {
        let (Cell::Number(number), false) = (&value, self == Self::Coordinates) else { return value };
        let um = mosaic.um_per_unit;
        // lengths of this unit per unit of the coordinates
        let length = match self {
            Self::Coordinates => Some(1.),
            Self::Pixels => mosaic.px_per_unit(),
            Self::Micrometres if quantity == Quantity::Length => um,
            Self::Micrometres => um.map(|um| um / 1e3),
            Self::Degrees => um.zip(mosaic.um_per_degree).map(|(um, degree)| um / degree),
            Self::Arcminutes => um.zip(mosaic.um_per_degree).map(|(um, degree)| 60. * um / degree),
        };
        let Some(length) = length else { return Cell::Missing };
        match quantity {
            Quantity::Plain => value,
            Quantity::Length => (number * length).into(),
            Quantity::Area => (number * (length * length)).into(),
            Quantity::Density => (number / (length * length)).into(),
        }
    }
}
