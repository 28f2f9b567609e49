use super::error::{Located, ReadError, ReadFault, listed};
use super::{Origin, archives, delimited, imagej, text, webplotdigitizer};
use crate::geometry::Point;
use crate::mosaic::LengthUnit;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Most that is read from one file.
const LARGEST_FILE: u64 = 1 << 30;

/// How to understand a coordinate file where it does not say so itself.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ReadOptions {
    /// What the file calls the centre of the top-left pixel. Default: what is known of its dialect (0.5 for
    /// WebPlotDigitizer projects and for sub-pixel ROIs of ImageJ before 1.52t), otherwise 0.
    pub origin: Option<Origin>,
    /// y points up: the height of the image, in the unit of the file (px: the number of rows). Default: y points
    /// down. Counts for text only; in projects and ROIs y always points down.
    pub flip_y: Option<f64>,
    /// Take only the dataset (WebPlotDigitizer) or ROI of this name. Default: all of them, one after another.
    pub dataset: Option<String>,
}

impl ReadOptions {
    /// # Errors
    /// If the height is not a positive number.
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

/// The kinds of coordinate file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dialect {
    /// Text in columns: CSV and its relatives, ImageJ results, WebPlotDigitizer's CSV of one dataset.
    Delimited,
    /// WebPlotDigitizer's CSV of all datasets.
    WebPlotDigitizerCsv,
    /// A WebPlotDigitizer project, JSON or `.tar`.
    WebPlotDigitizerProject,
    /// An ImageJ `.roi` or a `.zip` of them.
    ImageJRoi,
}

/// A named run of points of a file: a dataset of WebPlotDigitizer, a ROI of ImageJ.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Series {
    /// Its name; empty for plain columns.
    pub name: String,
    /// How many points it has.
    pub len: usize,
}

/// What a coordinate file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct CoordinateFile {
    /// The points, x right and y down. Pixels count from 0 at the centre of the top-left pixel; micrometres and
    /// unit squares stand as in the file.
    pub points: Vec<Point>,
    /// Column `score`, `confidence` or `probability`, one a point.
    pub scores: Option<Vec<f64>>,
    /// The unit, if the file says so.
    pub unit: Option<LengthUnit>,
    /// The kind of file.
    pub dialect: Dialect,
    /// The datasets that the points came from, in the order of the points.
    pub series: Vec<Series>,
}

/// Coordinates as they stand in a file.
pub(super) struct RawFile {
    pub dialect: Dialect,
    pub unit: Option<LengthUnit>,
    pub y_may_point_up: bool,
    pub datasets: Vec<Dataset>,
    /// Only files of one dataset have scores.
    pub scores: Option<Vec<f64>>,
}

/// A named run of points and the origin that its dialect counts from.
pub(super) struct Dataset {
    pub name: String,
    pub origin: Origin,
    pub points: Vec<Point>,
}

/// The coordinates in a file of any dialect, which is recognised by its content: text in columns, WebPlotDigitizer
/// project (JSON, `.tar`), ImageJ ROI (`.roi`, `.zip`).
///
/// # Errors
/// If the file cannot be read or understood: the error names file, line, what was expected and found, and a remedy.
pub fn read_coordinates(path: &Path, options: &ReadOptions) -> Result<CoordinateFile, ReadError> {
    let name = path.display().to_string();
    let bytes = read_file(path).map_err(|fault| Located::from(fault).in_file(&name))?;
    read_from(&name, &bytes, options)
}

/// The coordinates in the bytes of a file; `name` is what errors call it.
///
/// # Errors
/// As [`read_coordinates`].
pub fn read_from(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<CoordinateFile, ReadError> {
    let read = || {
        options.validate()?;
        raw(name, bytes)?.understand(options)
    };
    read().map_err(|located| located.in_file(name))
}

/// The bytes of a file that is not unreasonably large.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, ReadFault> {
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(ReadFault::Io)?;
    file.take(LARGEST_FILE + 1).read_to_end(&mut bytes).map_err(ReadFault::Io)?;
    if bytes.len() as u64 > LARGEST_FILE {
        return Err(ReadFault::TooLarge { limit_mib: LARGEST_FILE >> 20 });
    }
    Ok(bytes)
}

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

/// By its content, or if that is too short to tell by its name.
pub(super) fn is_tar(name: &str, bytes: &[u8]) -> bool {
    let named = || name.to_ascii_lowercase().ends_with(".tar");
    !bytes.is_empty() && (bytes.get(257..262) == Some(b"ustar") || named())
}

/// Files that are often given by mistake.
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
            // The centre of the bottom row is 0 when y points up; that of the top row when it points down.
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
