use crate::report::{Cell, CoordinatesRecord, ImageRecord, MosaicRecord};

/// What a row of a summary is about.
#[derive(Clone, Copy)]
pub enum Subject<'a> {
    /// An image whose cones this program found.
    Image(&'a ImageRecord),
    /// Coordinates from anywhere.
    Coordinates(&'a CoordinatesRecord),
}

impl<'a> Subject<'a> {
    /// Its mosaic.
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

    pub(super) const fn coordinates(&self) -> Option<&'a CoordinatesRecord> {
        match self {
            Self::Image(_) => None,
            Self::Coordinates(record) => Some(record),
        }
    }
}

/// A summary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SummaryKind {
    /// Of `run`: a row an image.
    Images,
    /// Of `measure`: a row a file of coordinates.
    Coordinates,
}

/// What is chosen together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MetricGroup {
    /// Which file it is, and what is worth knowing before its numbers.
    About,
    /// How the cones were found.
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
    /// What is expected at that place of the retina.
    Expected,
}

impl MetricGroup {
    /// All, in the order of the columns.
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

    /// As it is written in options.
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

    /// A heading for it.
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

/// What is done about cones whose neighbours may lie beyond the border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeRule {
    /// The border does not matter.
    NotAffected,
    /// Nothing: all points count.
    All,
    /// Only points at least as far from the border as from their nearest neighbour.
    Interior,
    /// Only points whose Voronoi cell is finite and has every vertex strictly inside the window (Cooper et al. 2016).
    Bound,
    /// An own one, which the definition names.
    Own,
}

impl EdgeRule {
    /// In a word.
    pub const fn name(self) -> &'static str {
        match self {
            Self::NotAffected => "–",
            Self::All => "all",
            Self::Interior => "interior",
            Self::Bound => "bound",
            Self::Own => "see definition",
        }
    }
}

/// What a number measures, and so which units it comes in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A length: in the unit of the coordinates, µm, degrees and minutes of visual angle.
    Length,
    /// An area, likewise.
    Area,
    /// Cones per area, likewise.
    Density,
    /// A number of this unit, or none.
    Plain(&'static str),
}

/// A column of a summary, or several that differ in nothing but their unit.
pub struct Metric {
    /// Name of the column, less the unit.
    pub name: &'static str,
    /// What it is chosen with.
    pub group: MetricGroup,
    /// Which units it comes in.
    pub quantity: Quantity,
    /// What is done about the border.
    pub edge: EdgeRule,
    /// What it is; when it is not defined.
    pub definition: &'static str,
    /// Who defined it.
    pub source: &'static str,
    /// The only summary that has it; `None`: both.
    pub only: Option<SummaryKind>,
    pub(super) value: Value,
}

/// How a value is taken from a record: numbers in the unit of the coordinates.
#[derive(Clone, Copy)]
pub(super) enum Value {
    One(fn(&Subject) -> Cell),
    /// One column for every sampler compared with.
    PerSampler(fn(&Subject, &str) -> Cell),
}

impl Metric {
    /// Whether a summary has it.
    pub fn is_of(&self, kind: SummaryKind) -> bool {
        self.only.is_none_or(|only| only == kind)
    }
}
