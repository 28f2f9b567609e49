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

/// A reason why a batch, or one file of a batch, could not be processed.
#[derive(Debug, Error)]
pub enum BatchError {
    /// A path that does not exist or cannot be listed.
    #[error("{path}: cannot be read ({source}): give an existing file or folder", path = path.display())]
    Unreadable {
        /// Path as the user wrote it.
        path: PathBuf,
        /// Message of the operating system.
        source: io::Error,
    },
    /// Paths among which there is no file of the kind that is needed.
    #[error("no {what} in {paths}: expected {expected}")]
    Nothing {
        /// Kind of file that was looked for.
        what: &'static str,
        /// Paths that were searched.
        paths: String,
        /// Names of files that would have been found.
        expected: Cow<'static, str>,
    },
    /// A result that cannot be written.
    #[error("cannot write to {path} ({source}): choose another folder for the results", path = path.display())]
    Output {
        /// File or folder that was to be written.
        path: PathBuf,
        /// Message of the operating system.
        source: io::Error,
    },
    /// Coordinates whose image is missing, although their window was to be taken from the image.
    #[error(
        "{file}: the window is taken from the image of the same name, but there is none: give the folder \
         of the images, or the window itself: its size WxH, its edges X0,Y0,X1,Y1, the unit square or a \
         file of corners"
    )]
    NoImage {
        /// Path of the coordinate file.
        file: PathBuf,
    },
    /// A window or crop that leaves nothing of the image.
    #[error(
        "{file}: the {window} does not overlap the imaged part of the image ({width} × {height} px): give one \
         that does"
    )]
    Nowhere {
        /// Path of the image.
        file: PathBuf,
        /// The word “crop” or “window”, followed by the crop or window as the user wrote it.
        window: String,
        /// Width of the image in px.
        width: usize,
        /// Height of the image in px.
        height: usize,
    },
    /// A crop that leaves nothing of the window of a coordinate file.
    #[error("{file}: the crop {crop} does not overlap the window: give one that does")]
    NothingCropped {
        /// Path of the coordinate file.
        file: PathBuf,
        /// Crop as the user wrote it.
        crop: String,
    },
    /// A crop in px or µm for coordinates in the unit square.
    #[error(
        "{file}: the crop {crop} has a unit, but the coordinates are in the unit square: leave out px or um"
    )]
    CropUnit {
        /// Path of the coordinate file.
        file: PathBuf,
        /// Crop as the user wrote it.
        crop: String,
    },
    /// A torus that was asked for although the window is a polygon, which has no opposite edges to
    /// join.
    #[error(
        "{file}: a torus needs a rectangular window, but this one is a polygon: give a window WxH, or do \
         not ask for a torus"
    )]
    NoTorus {
        /// Path of the coordinate file.
        file: PathBuf,
    },
    /// A length in micrometres for a file whose scale is not known.
    #[error("{file}: {what} is in µm, but the scale is not known: give one")]
    NoScale {
        /// Name of the length in µm; if two things have different units, a phrase that names both.
        what: &'static str,
        /// Path of the file that has no scale.
        file: PathBuf,
    },
    /// A shrinkage of tissue for a file whose scale is not known. The shrinkage corrects the scale,
    /// so the file needs a scale.
    #[error(
        "{file}: a shrinkage was given, which corrects lengths in µm, but no scale is known: give one",
        file = file.display()
    )]
    ShrinkageWithoutScale {
        /// Path of the file that has no scale.
        file: PathBuf,
    },
    /// An input file that lies in the folder of results, where results could overwrite it.
    #[error(
        "{file} lies in {folder}, where results would overwrite it: choose another folder for the results",
        folder = folder.display()
    )]
    Overlap {
        /// Path of the input: an image or the table of regions.
        file: PathBuf,
        /// Path of the folder of results.
        folder: PathBuf,
    },
    /// A file of coordinates that a person made or corrected and that detections would overwrite.
    #[error(
        "{path}: holds coordinates that a person has made or corrected, and they would be replaced: allow \
         corrections to be replaced (a copy is kept), or choose another folder for the results",
        path = path.display()
    )]
    Foreign {
        /// Path of the file of coordinates.
        path: PathBuf,
    },
    /// A folder that results were to replace, but that contains a file that this program did not
    /// write.
    #[error(
        "{path}: holds {file}, which is not a result of this program: move it away, or choose another \
         folder for the results",
        path = path.display()
    )]
    ForeignFolder {
        /// Path of the folder.
        path: PathBuf,
        /// Name of the first foreign file in the folder.
        file: String,
    },
    /// An image that failed in this run, while its results from an earlier run stay in place.
    #[error("{source}; the results of an earlier run stay in {folder}")]
    Outdated {
        /// The reason why the image failed in this run.
        source: Box<BatchError>,
        /// Path of the image's earlier results, inside the result folder.
        folder: String,
    },
    /// A result folder into which another command is writing.
    #[error(
        "{path}: another command is writing into this folder: wait until it has finished, or choose \
         another folder",
        path = path.display()
    )]
    Busy {
        /// Path of the result folder.
        path: PathBuf,
    },
    /// A file of cones that a person has corrected and that a run from the start would replace.
    #[error(
        "{path}: a person has corrected these cones, and this run would replace them: continue the earlier \
         run, allow corrections to be replaced (a copy is kept), or choose another folder for the results",
        path = path.display()
    )]
    Corrected {
        /// Path of the file of cones.
        path: PathBuf,
    },
    /// An image whose results would have the name of the list of failures, `failures.csv`.
    #[error(
        "{file}: its results would be written to failures.csv, the list of images that failed: rename the image"
    )]
    Reserved {
        /// Path of the image.
        file: PathBuf,
    },
    /// Coordinates in another unit than pixels, although pixels are needed.
    #[error("{file}: the coordinates are in {unit}, expected px: convert them to px", unit = unit.symbol())]
    NotPixels {
        /// Path of the coordinate file.
        file: PathBuf,
        /// Unit of the coordinates in the file.
        unit: LengthUnit,
    },
    /// A file whose companion is missing, such as marks without an image or without detections.
    #[error("{file}: {problem}")]
    Pairing {
        /// Path of the file.
        file: PathBuf,
        /// Description of the missing file and of the remedy.
        problem: String,
    },
    /// An image that cannot be read or written.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// An image in which cones cannot be detected.
    #[error("{file}: {source}", file = file.display())]
    Detect {
        /// Path of the image.
        file: PathBuf,
        /// The reason why the detection failed.
        source: DetectError,
    },
    /// A coordinate file, outline or table that cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A file that cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A table of regions that has no boxes for a file, or in which several identifiers fit the
    /// name of the file.
    #[error(transparent)]
    RoiTable(#[from] RoiTableError),
    /// A window into which no region fits, although squares were to slide over it.
    #[error("{file}: no square of side {side} fits into the window: give a smaller side", file = file.display())]
    NoRoi {
        /// Path of the coordinate file.
        file: PathBuf,
        /// Side of the square regions, in the unit of the coordinates.
        side: f64,
    },
    /// A table of scales that has no scale for an image, or more than one.
    #[error(transparent)]
    ScaleTable(#[from] ScaleTableError),
    /// An image whose name fits several rows of the manifest.
    #[error(transparent)]
    Manifest(#[from] AmbiguousRow),
    /// Tables that cannot be compared with each other.
    #[error("{0}")]
    Tables(String),
    /// Images that cannot be grouped by the chosen rule.
    #[error("{0}")]
    Group(String),
    /// A scale that is not a positive number.
    #[error(transparent)]
    Scale(#[from] crate::mosaic::ScaleError),
    /// Points from which no mosaic can be made.
    #[error("{file}: {source}", file = file.display())]
    Mosaic {
        /// Path of the coordinate file.
        file: PathBuf,
        /// The reason why the points form no mosaic.
        source: MosaicError,
    },
    /// A window without area.
    #[error(transparent)]
    Window(#[from] WindowError),
    /// An outline that is no polygon.
    #[error(transparent)]
    Polygon(#[from] PolygonError),
    /// A comparison with samplers that is impossible or would be meaningless.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// Statistics that cannot be computed with the chosen options.
    #[error(transparent)]
    Stats(#[from] crate::stats::StatsError),
    /// Options of pairing marks with detections, or points to be paired, that are out of range.
    #[error(transparent)]
    Match(#[from] MatchError),
    /// A table or figure that cannot be made.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// A record that cannot be written as JSON.
    #[error("the results cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
}
