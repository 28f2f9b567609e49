use super::error::{Located, ReadError, ReadFault, listed};
use super::{Origin, archives, delimited, imagej, text, webplotdigitizer};
use crate::geometry::Point;
use crate::mosaic::LengthUnit;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Size in bytes (1 GiB) above which a file is refused as too large for coordinates.
const LARGEST_FILE: u64 = 1 << 30;

/// Options for reading a coordinate file, about what the file does not state itself.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ReadOptions {
    /// Coordinate that the file gives to the centre of the top-left pixel.
    ///
    /// The default depends on the dialect: 0.5 for WebPlotDigitizer projects, for sub-pixel ROIs of
    /// ImageJ before 1.52t and for outlines drawn in ImageJ, otherwise 0.
    pub origin: Option<Origin>,
    /// Height of the image, in the unit of the file (for px: the number of rows), if y points up.
    ///
    /// By default y points down. The option applies to text only; in projects and ROIs y always
    /// points down.
    pub flip_y: Option<f64>,
    /// Name of the only dataset (WebPlotDigitizer) or ROI (ImageJ) to take.
    ///
    /// By default all of them are taken, one after another.
    pub dataset: Option<String>,
}

impl ReadOptions {
    /// Checks that every option is within its range.
    ///
    /// # Errors
    /// Fails if the height is not a positive number.
    pub fn validate(&self) -> Result<(), ReadFault> {
        match self.flip_y {
            Some(height) if !(height.is_finite() && height > 0.) => Err(ReadFault::Option {
                option: "flip_y",
                found: height.to_string(),
                expected: "the height of the image, a positive number",
            }),
            _ => Ok(()),
        }
    }
}

/// Dialect of a coordinate file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dialect {
    /// Text in columns: CSV and the like, ImageJ results, WebPlotDigitizer's CSV of one dataset.
    Delimited,
    /// WebPlotDigitizer's CSV of all datasets.
    WebPlotDigitizerCsv,
    /// WebPlotDigitizer project as JSON or `.tar`.
    WebPlotDigitizerProject,
    /// ImageJ `.roi` file or a `.zip` of several.
    ImageJRoi,
}

/// Named run of points in a file: a dataset of WebPlotDigitizer or a ROI of ImageJ.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Series {
    /// Name of the dataset; empty for plain columns.
    pub name: String,
    /// Number of points in the dataset.
    pub len: usize,
}

/// Contents of a coordinate file.
#[derive(Clone, Debug, PartialEq)]
pub struct CoordinateFile {
    /// Points, with x to the right and y down.
    ///
    /// Pixels count from 0 at the centre of the top-left pixel; micrometres and coordinates in the
    /// unit square keep the origin of the file.
    pub points: Vec<Point>,
    /// Values of the column `score`, `confidence` or `probability`, one per point.
    pub scores: Option<Vec<f64>>,
    /// Unit of the points; `None` if the file does not name one.
    pub unit: Option<LengthUnit>,
    /// Dialect of the file.
    pub dialect: Dialect,
    /// Datasets that the points came from, in the order of the points.
    pub series: Vec<Series>,
}

/// Coordinates as the file states them, before origin and direction of y are taken into account.
pub(super) struct RawFile {
    /// Dialect of the file.
    pub dialect: Dialect,
    /// Unit of the coordinates; `None` if the file does not name one.
    pub unit: Option<LengthUnit>,
    /// `true` if the option [`ReadOptions::flip_y`] applies to this dialect.
    pub y_may_point_up: bool,
    /// Datasets in the order of the file.
    pub datasets: Vec<Dataset>,
    /// Scores, one per point; only files of one dataset have them.
    pub scores: Option<Vec<f64>>,
}

/// Named run of points, and the origin from which the dialect of its file counts.
pub(super) struct Dataset {
    /// Name of the dataset; empty if it has none.
    pub name: String,
    /// Coordinate that the dialect gives to the centre of the top-left pixel.
    pub origin: Origin,
    /// Points as the file states them.
    pub points: Vec<Point>,
}

/// Reads the coordinates in a file of any dialect.
///
/// The dialect is recognised by the content of the file: text in columns, a WebPlotDigitizer
/// project (JSON, `.tar`) or ImageJ ROIs (`.roi`, `.zip`).
///
/// # Errors
/// Fails if the file cannot be read or understood. The error names the file, the line, what was
/// expected and found, and a remedy.
pub fn read_coordinates(path: &Path, options: &ReadOptions) -> Result<CoordinateFile, ReadError> {
    let name = path.display().to_string();
    let bytes = read_file(path).map_err(|fault| Located::from(fault).in_file(&name))?;
    read_from(&name, &bytes, options)
}

/// Reads the coordinates in the bytes of a file, which errors call `name`.
///
/// # Errors
/// Fails if the bytes cannot be understood; see [`read_coordinates`].
pub fn read_from(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<CoordinateFile, ReadError> {
    let read = || {
        options.validate()?;
        raw(name, bytes)?.understand(options)
    };
    read().map_err(|located| located.in_file(name))
}

/// Returns the bytes of a file, unless it is unreasonably large for coordinates.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, ReadFault> {
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(ReadFault::Io)?;
    file.take(LARGEST_FILE + 1).read_to_end(&mut bytes).map_err(ReadFault::Io)?;
    if bytes.len() as u64 > LARGEST_FILE {
        return Err(ReadFault::TooLarge { limit_mib: LARGEST_FILE >> 20 });
    }
    Ok(bytes)
}

/// Recognises the dialect of a file of points and reads the points as the file states them.
fn raw(name: &str, bytes: &[u8]) -> Result<RawFile, Located> {
    match bytes {
        [b'I', b'o', b'u', b't', ..] => imagej::read_roi(name, bytes, imagej::Wanted::Points),
        [b'P', b'K', 3, 4, ..] | [b'P', b'K', 5, 6, ..] => archives::read_set(bytes, imagej::Wanted::Points),
        _ if is_tar(name, bytes) => archives::read_tar(bytes),
        _ => {
            if let Some(found) = foreign(bytes) {
                return Err(ReadFault::NotCoordinates { found: found.into() }.into());
            }
            let text = text::decode(bytes)?;
            if text.trim_start().starts_with(['{', '[']) {
                webplotdigitizer::read_json(&text)
            } else {
                delimited::read(&text)
            }
        }
    }
}

/// Returns whether a file that is not empty is a `.tar` archive.
///
/// The mark `ustar` at byte 257 is proof. Without it the extension `.tar` decides, as a file may be
/// too short to carry the mark.
pub(super) fn is_tar(name: &str, bytes: &[u8]) -> bool {
    let named = || name.to_ascii_lowercase().ends_with(".tar");
    !bytes.is_empty() && (bytes.get(257..262) == Some(b"ustar") || named())
}

/// Returns the kind of a file that was passed by mistake, recognised by its first bytes.
///
/// `None` if the file is of no kind that is recognised here.
pub(super) fn foreign(bytes: &[u8]) -> Option<&'static str> {
    [
        (&b"\x89PNG"[..], "a PNG image"),
        (b"II*\0", "a TIFF image"),
        (b"MM\0*", "a TIFF image"),
        (b"\xff\xd8\xff", "a JPEG image"),
        (b"\x1f\x8b", "a gzip archive"),
        (b"\xd0\xcf\x11\xe0", "an old Office document"),
        (b"%PDF", "a PDF"),
        (b"MATLAB", "a MATLAB workspace"),
        (b"\x89HDF", "an HDF5 file or MATLAB workspace"),
    ]
    .into_iter()
    .find(|(magic, _)| bytes.starts_with(magic))
    .map(|(_, name)| name)
}

impl RawFile {
    /// Applies the options: chooses the dataset, moves the origin and turns y downwards.
    pub(super) fn understand(mut self, options: &ReadOptions) -> Result<CoordinateFile, Located> {
        if let Some(wanted) = &options.dataset {
            if !self.datasets.iter().any(|d| &d.name == wanted) {
                let found = listed(self.datasets.iter().map(|d| d.name.as_str()));
                return Err(
                    ReadFault::NoSuchDataset { wanted: super::error::shortened(wanted), found }.into()
                );
            }
            self.datasets.retain(|d| &d.name == wanted);
        }
        let in_pixels = matches!(self.unit, None | Some(LengthUnit::Pixel));
        if let (false, Some(origin @ (Origin::Half | Origin::One)), Some(unit)) =
            (in_pixels, options.origin, self.unit)
        {
            return Err(ReadFault::OriginWithoutPixels { origin, unit: unit.symbol() }.into());
        }
        let height = options.flip_y.filter(|_| self.y_may_point_up);
        let convert = |p: Point, origin: Origin| {
            if !in_pixels {
                return Point::new(p.x, height.map_or(p.y, |h| h - p.y));
            }
            let p = origin.to_zero_based(p);
            // The coordinate 0 is the centre of the bottom row if y points up, and that of the top
            // row if y points down; the two are h − 1 pixels apart.
            Point::new(p.x, height.map_or(p.y, |h| h - 1. - p.y))
        };
        let mut points = Vec::with_capacity(self.datasets.iter().map(|d| d.points.len()).sum());
        let mut series = Vec::with_capacity(self.datasets.len());
        for dataset in self.datasets {
            let origin = options.origin.unwrap_or(dataset.origin);
            series.push(Series { name: dataset.name, len: dataset.points.len() });
            points.extend(dataset.points.into_iter().map(|p| convert(p, origin)));
        }
        let Self { dialect, unit, scores, .. } = self;
        Ok(CoordinateFile { points, scores, unit, dialect, series })
    }
}
