use crate::report::tables::{Column, Part, Row};
use crate::report::{CoordinatesRecord, DetectionRecord, ImageRecord, MosaicRecord};
use crate::stats;

/// Record from which a row of a summary is made.
#[derive(Clone, Copy)]
pub enum Subject<'a> {
    /// An image whose cones this program found.
    Image(&'a ImageRecord),
    /// Coordinates of any origin, without an image.
    Coordinates(&'a CoordinatesRecord),
}

impl Row for Subject<'static> {
    type Of<'a> = Subject<'a>;
}

impl<'a> Subject<'a> {
    /// Returns the statistics of the mosaic.
    pub(super) const fn stats(&self) -> &'a stats::Summary {
        &self.mosaic().stats
    }

    /// Returns the path of the file, as set by the user.
    pub(super) fn file(&self) -> &'a str {
        match self {
            Self::Image(record) => &record.file,
            Self::Coordinates(record) => &record.file,
        }
    }

    /// Returns the name under which the results are stored.
    pub(super) fn name(&self) -> &'a str {
        match self {
            Self::Image(record) => &record.name,
            Self::Coordinates(record) => &record.name,
        }
    }

    /// Returns the warnings about the numbers.
    pub(super) fn warnings(&self) -> &'a [String] {
        match self {
            Self::Image(record) => &record.warnings,
            Self::Coordinates(record) => &record.warnings,
        }
    }

    /// Returns the record of the mosaic.
    pub const fn mosaic(&self) -> &'a MosaicRecord {
        match self {
            Self::Image(record) => &record.mosaic,
            Self::Coordinates(record) => &record.mosaic,
        }
    }

    /// Returns the record of an image; `None` for coordinates.
    pub(super) const fn image(&self) -> Option<&'a ImageRecord> {
        match self {
            Self::Image(record) => Some(record),
            Self::Coordinates(_) => None,
        }
    }

    /// Returns the record of the detection; `None` if this program did not find the cones.
    pub(super) fn detection(&self) -> Option<&'a DetectionRecord> {
        self.image().and_then(|record| record.detection.as_ref())
    }

    /// Returns the record of coordinates; `None` for an image.
    pub(super) const fn coordinates(&self) -> Option<&'a CoordinatesRecord> {
        match self {
            Self::Image(_) => None,
            Self::Coordinates(record) => Some(record),
        }
    }
}

/// Kind of summary, which depends on the command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SummaryKind {
    /// Summaries of `run`: one row per image.
    Images,
    /// Summaries of `measure`: one row per file of coordinates.
    Coordinates,
}

impl SummaryKind {
    /// Returns the part of all columns that a summary of this kind has.
    pub(super) const fn part(self) -> Part {
        match self {
            Self::Images => Part::Images,
            Self::Coordinates => Part::Coordinates,
        }
    }
}

/// Group of metrics that can be chosen together by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MetricGroup {
    /// The file, its scale, and other facts needed to read its numbers.
    About,
    /// Detection of the cones.
    Detection,
    /// Cones per area, and the spacing that belongs to it.
    Density,
    /// Distances to the nearest neighbour.
    Nearest,
    /// Voronoi cells and Delaunay neighbours.
    Voronoi,
    /// Comparison with independently placed points.
    Regularity,
    /// Distances between the mosaic and point samplers.
    Samplers,
    /// Density around the average cone.
    Recovery,
    /// Directions of neighbours and anisotropy.
    Orientation,
    /// Spacing from rings in power spectra.
    Fourier,
    /// Evenness of density across the window.
    Evenness,
    /// Values expected at the location of the image on the retina.
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

    /// Returns the name of the group, as it is written in options.
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

    /// Returns the heading of the group in the data dictionary.
    pub const fn title(self) -> &'static str {
        match self {
            Self::About => "About the file",
            Self::Detection => "How the cones were found",
            Self::Density => "Density and spacing",
            Self::Nearest => "Nearest neighbours",
            Self::Voronoi => "Voronoi cells and Delaunay neighbours",
            Self::Regularity => "Regularity compared with independent points",
            Self::Samplers => "Distance to point samplers",
            Self::Recovery => "Density recovery profile",
            Self::Orientation => "Orientation and anisotropy",
            Self::Fourier => "Spacing from power spectra",
            Self::Evenness => "Evenness of density",
            Self::Expected => "Values expected at this place on the retina",
        }
    }
}

/// Dimension of a value, which determines the units in which the summary has columns of the value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A length, in the unit of the coordinates, px, µm, degrees and minutes of visual angle.
    ///
    /// The coordinates of an image are in px, so that a summary of images has one column in px.
    Length,
    /// An area, in the squares of the units of a length, with mm² instead of µm².
    Area,
    /// A number of cones per area, in the inverse of the units of an area.
    Density,
    /// Text, or a number that has one unit only, which its column states.
    Plain,
}

/// Column of a summary, or several columns that differ only in their unit.
pub struct Metric {
    /// Group with which the metric is chosen.
    pub group: MetricGroup,
    /// Dimension of the value, which is computed in the unit of the coordinates.
    pub quantity: Quantity,
    /// Name (without the unit), definition and value.
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
    /// Returns whether a summary of this kind has the metric.
    pub fn is_of(&self, kind: SummaryKind) -> bool {
        self.column.words.part.is_none_or(|only| only == kind.part())
    }
}
