use crate::report::tables::{Column, Part, Row};
use crate::report::{CoordinatesRecord, DetectionRecord, ImageRecord, MosaicRecord};
use crate::stats;

/// The record that a row of a summary is made from.
#[derive(Clone, Copy)]
pub enum Subject<'a> {
    /// An image whose cones this program found.
    Image(&'a ImageRecord),
    /// Coordinates from anywhere.
    Coordinates(&'a CoordinatesRecord),
}

impl Row for Subject<'static> {
    type Of<'a> = Subject<'a>;
}

impl<'a> Subject<'a> {
    /// Returns the statistics of its mosaic.
    pub(super) const fn stats(&self) -> &'a stats::Summary {
        &self.mosaic().stats
    }

    pub(super) fn file(&self) -> &'a str {
        match self {
            Self::Image(record) => &record.file,
            Self::Coordinates(record) => &record.file,
        }
    }

    pub(super) fn name(&self) -> &'a str {
        match self {
            Self::Image(record) => &record.name,
            Self::Coordinates(record) => &record.name,
        }
    }

    pub(super) fn warnings(&self) -> &'a [String] {
        match self {
            Self::Image(record) => &record.warnings,
            Self::Coordinates(record) => &record.warnings,
        }
    }

    /// Returns its mosaic.
    pub const fn mosaic(&self) -> &'a MosaicRecord {
        match self {
            Self::Image(record) => &record.mosaic,
            Self::Coordinates(record) => &record.mosaic,
        }
    }

    pub(super) const fn image(&self) -> Option<&'a ImageRecord> {
        match self {
            Self::Image(record) => Some(record),
            Self::Coordinates(_) => None,
        }
    }

    /// Returns how the cones of an image were found, if this program found them.
    pub(super) fn detection(&self) -> Option<&'a DetectionRecord> {
        self.image().and_then(|record| record.detection.as_ref())
    }

    pub(super) const fn coordinates(&self) -> Option<&'a CoordinatesRecord> {
        match self {
            Self::Image(_) => None,
            Self::Coordinates(record) => Some(record),
        }
    }
}

/// Kinds of summaries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SummaryKind {
    /// Summaries of `run`: one row per image.
    Images,
    /// Summaries of `measure`: one row per file of coordinates.
    Coordinates,
}

impl SummaryKind {
    /// Returns the part of all columns that it has.
    pub(super) const fn part(self) -> Part {
        match self {
            Self::Images => Part::Images,
            Self::Coordinates => Part::Coordinates,
        }
    }
}

/// Metrics that are chosen together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MetricGroup {
    /// The file, and what is worth knowing before its numbers.
    About,
    /// Detection of the cones.
    Detection,
    /// Cones per area, and the spacing that belongs to it.
    Density,
    /// Distances to the nearest neighbour.
    Nearest,
    /// Voronoi cells and Delaunay neighbours.
    Voronoi,
    /// Comparison with independent points.
    Regularity,
    /// Distances to point samplers.
    Samplers,
    /// Density around the average cone.
    Recovery,
    /// Directions of neighbours.
    Orientation,
    /// Rings of spectra.
    Fourier,
    /// Evenness of density.
    Evenness,
    /// Values expected at that place of the retina.
    Expected,
}

impl MetricGroup {
    /// The groups, in the order of the columns.
    pub const ALL: [Self; 12] = [
        Self::About,
        Self::Density,
        Self::Nearest,
        Self::Samplers,
        Self::Detection,
        Self::Voronoi,
        Self::Regularity,
        Self::Recovery,
        Self::Orientation,
        Self::Fourier,
        Self::Evenness,
        Self::Expected,
    ];

    /// Returns the name, as it is written in options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::About => "about",
            Self::Detection => "detection",
            Self::Density => "density",
            Self::Nearest => "nearest",
            Self::Voronoi => "voronoi",
            Self::Regularity => "regularity",
            Self::Samplers => "samplers",
            Self::Recovery => "recovery",
            Self::Orientation => "orientation",
            Self::Fourier => "fourier",
            Self::Evenness => "evenness",
            Self::Expected => "expected",
        }
    }

    /// Returns a heading.
    pub const fn title(self) -> &'static str {
        match self {
            Self::About => "About the file",
            Self::Detection => "How the cones were found",
            Self::Density => "Density and spacing",
            Self::Nearest => "Nearest neighbours",
            Self::Voronoi => "Voronoi cells and Delaunay neighbours",
            Self::Regularity => "Regularity against independent points",
            Self::Samplers => "Distance to point samplers",
            Self::Recovery => "Density recovery profile",
            Self::Orientation => "Orientation and anisotropy",
            Self::Fourier => "Spacing by spectra",
            Self::Evenness => "Evenness of density",
            Self::Expected => "Expected at that place of the retina",
        }
    }
}

/// Dimension of a value, which decides the units that it is given in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A length: in the unit of the coordinates, px, µm, degrees and minutes of visual angle.
    Length,
    /// An area, likewise.
    Area,
    /// Cones per area, likewise.
    Density,
    /// Text, or a number of the one unit that its column names.
    Plain,
}

/// A column of a summary, or several that differ in nothing but their unit.
pub struct Metric {
    /// The group that it is chosen with.
    pub group: MetricGroup,
    /// Dimension; values are in the unit of the coordinates.
    pub quantity: Quantity,
    /// Name (less the unit), definition and value.
    pub column: Column<Subject<'static>>,
}

/// Puts a column into a group.
pub(super) const fn metric(
    group: MetricGroup,
    quantity: Quantity,
    column: Column<Subject<'static>>,
) -> Metric {
    Metric { group, quantity, column }
}

impl Metric {
    /// Returns whether a summary of this kind has it.
    pub fn is_of(&self, kind: SummaryKind) -> bool {
        self.column.words.part.is_none_or(|only| only == kind.part())
    }
}
