use super::error::{Located, ReadError, ReadFault};
use super::read::{RawFile, foreign, is_tar, read_file};
use super::{ReadOptions, archives, delimited, imagej, text, webplotdigitizer};
use crate::geometry::{Ring, Window};
use crate::mosaic::LengthUnit;
use std::path::Path;

/// Window that a person drew by hand.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineFile {
    /// Area that the rings enclose. Pixels count from 0 at the centre of the top-left pixel.
    pub window: Window,
    /// Unit of the window, or `None` if the file does not name one.
    pub unit: Option<LengthUnit>,
}

/// Reads a window from a file that lists the corners of one or more rings.
///
/// The dialect is recognised by the content of the file:
///
/// - text in columns x and y; a blank line or another value in a column `ring` begins the next
///   ring;
/// - a WebPlotDigitizer project or CSV, where each dataset is a ring;
/// - polygonal, freehand, traced and rectangular ROIs of ImageJ, whose corners count from the
///   corner of the first pixel.
///
/// Rings inside rings are holes.
///
/// # Errors
/// Fails if the file cannot be read or understood, or its rings enclose no area or cross. The error
/// names the file, the line, what was expected and found, and a remedy.
pub fn read_outline(path: &Path, options: &ReadOptions) -> Result<OutlineFile, ReadError> {
    let name = path.display().to_string();
    let read = || -> Result<OutlineFile, Located> {
        let bytes = read_file(path)?;
        options.validate()?;
        let file = raw(&name, &bytes)?.understand(&ReadOptions { dataset: None, ..options.clone() })?;
        let mut points = file.points.into_iter();
        let rings = file.series.iter().map(|s| points.by_ref().take(s.len).collect::<Ring>()).collect();
        let window = Window::polygon(rings).map_err(ReadFault::Outline)?;
        Ok(OutlineFile { window, unit: file.unit })
    };
    read().map_err(|located| located.in_file(&name))
}

/// Recognises the dialect of a file of corners and reads the corners as the file states them.
fn raw(name: &str, bytes: &[u8]) -> Result<RawFile, Located> {
    match bytes {
        [b'I', b'o', b'u', b't', ..] => imagej::read_roi(name, bytes, imagej::Wanted::Outline),
        [b'P', b'K', 3, 4, ..] | [b'P', b'K', 5, 6, ..] => archives::read_set(bytes, imagej::Wanted::Outline),
        _ if is_tar(name, bytes) => archives::read_tar(bytes),
        _ => {
            if let Some(found) = foreign(bytes) {
                return Err(ReadFault::NotCoordinates { found: found.into() }.into());
            }
            let text = text::decode(bytes)?;
            if text.trim_start().starts_with(['{', '[']) {
                webplotdigitizer::read_json(&text)
            } else {
                delimited::read_rings(&text)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;

    fn outline(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<OutlineFile, ReadError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        read_outline(&path, options)
    }

    #[test]
    fn blank_lines_or_a_ring_column_part_the_rings() {
        let blank = b"x_px,y_px\n0,0\n10,0\n10,10\n0,10\n\n# the hole\n2,2\n2,4\n4,4\n4,2\n";
        let column = b"ring,x,y\nouter,0,0\nouter,10,0\nouter,10,10\nouter,0,10\nhole,2,2\nhole,2,4\nhole,4,4\nhole,4,2\n";
        let bare = b"0 0\n10 0\n10 10\n0 10\n \n2 2\n2 4\n4 4\n4 2\n";
        for text in [&blank[..], column, bare] {
            let window = outline("w.csv", text, &ReadOptions::default()).unwrap().window;
            assert_eq!((window.rings().len(), window.area()), (2, 96.));
            assert!(!window.contains(Point::new(3., 3.)));
        }
        assert_eq!(outline("w.csv", blank, &ReadOptions::default()).unwrap().unit, Some(LengthUnit::Pixel));
        let one = ReadOptions { origin: Some(crate::mosaic::io::Origin::One), ..ReadOptions::default() };
        assert_eq!(outline("w.csv", bare, &one).unwrap().window.bounds().x0(), -1.);
    }

    /// Returns the bytes of an ImageJ ROI of this kind with three corners.
    ///
    /// Corners count from the corner of the first pixel.
    fn roi(kind: u8) -> Vec<u8> {
        let mut bytes = vec![0; 64];
        bytes[..4].copy_from_slice(b"Iout");
        bytes[4..6].copy_from_slice(&227u16.to_be_bytes());
        bytes[6] = kind;
        // top, left, bottom, right; number of corners
        for (at, value) in [(8, 20u16), (10, 10), (12, 26), (14, 18), (16, 3)] {
            bytes[at..at + 2].copy_from_slice(&value.to_be_bytes());
        }
        for value in [0u16, 8, 0, 0, 6, 6] {
            bytes.extend(value.to_be_bytes());
        }
        bytes
    }

    #[test]
    fn polygonal_and_rectangular_rois_of_imagej_are_outlines() {
        let options = ReadOptions::default();
        let triangle = outline("w.roi", &roi(0), &options).unwrap();
        assert_eq!((triangle.window.area(), triangle.unit), (24., Some(LengthUnit::Pixel)));
        assert!(
            triangle.window.contains(Point::new(9.6, 19.6))
                && !triangle.window.contains(Point::new(9.4, 19.4))
        );
        let rectangle = outline("w.roi", &roi(1), &options).unwrap().window;
        assert_eq!(rectangle, Window::rectangle(9.5, 19.5, 17.5, 25.5).unwrap());
        let points = outline("w.roi", &roi(10), &options).unwrap_err().to_string();
        assert!(points.contains("found points") && points.contains("polygon"), "{points}");
    }

    #[test]
    fn outlines_without_area_name_the_file() {
        let error = outline("w.csv", b"x,y\n0,0\n1,1\n", &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.contains("w.csv") && error.contains("three corners"), "{error}");
        let error = outline("w.csv", b"x,y\n0,0\n1,b\n", &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.contains("line 3"), "{error}");
    }
}
