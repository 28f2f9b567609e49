use super::{Quantity, SummaryKind};
use crate::report::{Cell, MosaicRecord};

/// Unit in which a summary has a column of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    /// Unit of the coordinates; columns in this unit have no suffix.
    Coordinates,
    /// Pixels of the image.
    Pixels,
    /// Micrometres on the retina; areas and densities are in mm².
    Micrometres,
    /// Degrees of visual angle.
    Degrees,
    /// Minutes of visual angle.
    Arcminutes,
}

impl Unit {
    /// The units whose columns have a suffix, in the order of the columns.
    pub const SUFFIXED: [Self; 4] = [Self::Pixels, Self::Micrometres, Self::Degrees, Self::Arcminutes];

    /// Returns the units in which a quantity has columns.
    ///
    /// The coordinates of an image are always in px, so that a column in the unit of the
    /// coordinates would repeat the column in px; it is left out.
    pub fn all(quantity: Quantity, kind: SummaryKind) -> impl Iterator<Item = Self> {
        let plain = quantity == Quantity::Plain;
        let own = (plain || kind == SummaryKind::Coordinates).then_some(Self::Coordinates);
        let suffixed: &[Self] = if plain { &[] } else { &Self::SUFFIXED };
        own.into_iter().chain(suffixed.iter().copied())
    }

    /// Returns the end of the name of a column in this unit.
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

    /// Returns the unit in words; `plain` are the words of a column that has one unit only.
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

    /// Converts a value from the unit of the coordinates to this unit.
    ///
    /// The result is missing if the scale that this takes is not known.
    pub fn convert(self, value: Cell, quantity: Quantity, mosaic: &MosaicRecord) -> Cell {
        let (Cell::Number(number), false) = (&value, self == Self::Coordinates) else { return value };
        let um = mosaic.um_per_unit;
        // The factor is that of a length and is squared below. For areas and densities, which are
        // in mm², it converts to mm.
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
