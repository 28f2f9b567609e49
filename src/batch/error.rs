use crate::compare::{CompareError, MatchError};
use crate::detect::DetectError;
use crate::geometry::{PolygonError, WindowError};
use crate::image::ImageError;
use crate::mosaic::io::{AmbiguousRow, ReadError, RoiTableError, ScaleTableError, WriteError};
use crate::mosaic::{LengthUnit, MosaicError};
use crate::report::ReportError;
use std::borrow::Cow;
use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// Why a batch, or one file of it, could not be worked on.
#[derive(Debug, Error)]
pub enum BatchError {
    /// A path that does not exist or cannot be listed.
    #[error("{path}: {source}: give an existing file or folder", path = path.display())]
    Unreadable {
        /// The path as given.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// Nothing to work on.
    #[error("no {what} in {paths}: expected {expected}")]
    Nothing {
        /// What was looked for.
        what: &'static str,
        /// Where.
        paths: String,
        /// How such files are recognised.
        expected: Cow<'static, str>,
    },
    /// Results cannot be written.
    #[error("cannot write to {path}: {source}: choose another folder for the results", path = path.display())]
    Output {
        /// The file or folder.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// The window of coordinates is not known.
    #[error(
        "{file}: no image of that name beside it to take the window from: give the window, or the images"
    )]
    NoImage {
        /// The coordinate file.
        file: PathBuf,
    },
    /// The window or crop does not fit.
    #[error("{file}: the {window} leaves nothing of the image of {width} × {height} px: choose a part of it")]
    Nowhere {
        /// The image.
        file: PathBuf,
        /// “crop” or “window”, and as given.
        window: String,
        /// Width of the image in px.
        width: usize,
        /// Height of the image in px.
        height: usize,
    },
    /// A crop leaves nothing of the window of coordinates.
    #[error("{file}: the crop {crop} leaves nothing of the window: choose a part of it")]
    NothingCropped {
        /// The coordinate file.
        file: PathBuf,
        /// As given.
        crop: String,
    },
    /// A crop in px or µm of coordinates in the unit square.
    #[error(
        "{file}: the crop {crop} names a unit, but the coordinates are in the unit square: give it without"
    )]
    CropUnit {
        /// The coordinate file.
        file: PathBuf,
        /// As given.
        crop: String,
    },
    /// Opposite edges of a window that has none.
    #[error(
        "{file}: a torus needs a rectangle, its window is a polygon: give a rectangle, or do without the torus"
    )]
    NoTorus {
        /// The coordinate file.
        file: PathBuf,
    },
    /// A length in micrometres where no scale is known.
    #[error("{file}: {what} is in µm, but the scale is not known: give a scale")]
    NoScale {
        /// The option.
        what: &'static str,
        /// The file.
        file: PathBuf,
    },
    /// A shrinkage without a scale to apply it to.
    #[error("{file}: shrinkage changes micrometres, but no scale is known: give a scale", file = file.display())]
    ShrinkageWithoutScale {
        /// The file.
        file: PathBuf,
    },
    /// An input lies where results take the place of what is there.
    #[error("{file} lies in {folder}, which results are written to: choose another folder for the results", folder = folder.display())]
    Overlap {
        /// The image.
        file: PathBuf,
        /// The folder of results.
        folder: PathBuf,
    },
    /// Coordinates of somebody else stand where detections would be written.
    #[error(
        "{path}: holds coordinates that a person has made or corrected: give up the corrections explicitly, or choose \
         another folder for the results",
        path = path.display()
    )]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// A folder that holds more than results stands where results would be written.
    #[error(
        "{path}: holds {file}, which is no result of this program: move it away, or choose another folder for the results",
        path = path.display()
    )]
    ForeignFolder {
        /// The folder.
        path: PathBuf,
        /// The first such file in it.
        file: String,
    },
    /// An image that fails now and whose earlier results stay.
    #[error("{source}; its earlier results stay in {folder}")]
    Outdated {
        /// Why it fails.
        source: Box<BatchError>,
        /// Where its earlier results are.
        folder: String,
    },
    /// Another command is writing into the folder.
    #[error("{path}: another run is writing into this folder: wait for its end, or choose another folder", path = path.display())]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// Cones that a person has corrected and that a run from the start would replace.
    #[error(
        "{path}: a person has corrected these cones, and a run from the start would replace them: go on with the earlier run, give \
         up the corrections explicitly, or choose another folder for the results",
        path = path.display()
    )]
    Corrected {
        /// The file of cones.
        path: PathBuf,
    },
    /// An image whose results would be called like the list of failures.
    #[error(
        "{file}: its results would be failures.csv, which lists the images that failed: rename the image"
    )]
    Reserved {
        /// The image.
        file: PathBuf,
    },
    /// Coordinates in another unit than pixels where pixels are needed.
    #[error("{file}: the coordinates are in {unit}, expected px", unit = unit.symbol())]
    NotPixels {
        /// The file.
        file: PathBuf,
        /// Its unit.
        unit: LengthUnit,
    },
    /// Reference marks without the image that they need.
    #[error("{file}: {problem}")]
    NoPicture {
        /// The file of marks.
        file: PathBuf,
        /// What is missing, and the remedy.
        problem: String,
    },
    /// Reference marks without anything to hold against them.
    #[error("{file}: {problem}")]
    Pairing {
        /// The file of marks.
        file: PathBuf,
        /// What is missing, and the remedy.
        problem: String,
    },
    /// See [`ImageError`].
    #[error(transparent)]
    Image(#[from] ImageError),
    /// See [`DetectError`].
    #[error("{file}: {source}", file = file.display())]
    Detect {
        /// The image.
        file: PathBuf,
        /// Why nothing can be found in it.
        source: DetectError,
    },
    /// See [`ReadError`].
    #[error(transparent)]
    Read(#[from] ReadError),
    /// See [`WriteError`].
    #[error(transparent)]
    Write(#[from] WriteError),
    /// See [`RoiTableError`].
    #[error(transparent)]
    RoiTable(#[from] RoiTableError),
    /// A window that is smaller than the regions that are to slide over it.
    #[error("{file}: no square of side {side} fits into the window: choose a smaller side", file = file.display())]
    NoRoi {
        /// The coordinate file.
        file: PathBuf,
        /// In the unit of the coordinates.
        side: f64,
    },
    /// See [`ScaleTableError`].
    #[error(transparent)]
    ScaleTable(#[from] ScaleTableError),
    /// See [`AmbiguousRow`].
    #[error(transparent)]
    Manifest(#[from] AmbiguousRow),
    /// Tables that cannot be held against each other.
    #[error("{0}")]
    Tables(String),
    /// Images that cannot be grouped as asked.
    #[error("{0}")]
    Group(String),
    /// See [`crate::mosaic::ScaleError`].
    #[error(transparent)]
    Scale(#[from] crate::mosaic::ScaleError),
    /// See [`MosaicError`].
    #[error("{file}: {source}", file = file.display())]
    Mosaic {
        /// The coordinate file.
        file: PathBuf,
        /// What is wrong with its points.
        source: MosaicError,
    },
    /// See [`WindowError`].
    #[error(transparent)]
    Window(#[from] WindowError),
    /// See [`PolygonError`].
    #[error(transparent)]
    Polygon(#[from] PolygonError),
    /// See [`CompareError`].
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// Functions of distance cannot be computed as asked.
    #[error(transparent)]
    Stats(#[from] crate::stats::StatsError),
    /// See [`MatchError`].
    #[error(transparent)]
    Match(#[from] MatchError),
    /// See [`ReportError`].
    #[error(transparent)]
    Report(#[from] ReportError),
    /// Records that cannot be put into JSON.
    #[error("cannot write JSON: {0}")]
    Json(#[from] serde_json::Error),
}
