use crate::batch::input::{image_beside, image_in, image_name};
use crate::batch::{BatchError, CoordinatesOptions, ScaleSource};
use crate::geometry::Window;
use crate::image::{self, imaged_area};
use crate::mosaic::io::{OutlineFile, read_outline};
use crate::mosaic::{LengthUnit, Scale};
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// The area in which the points of a coordinate file could have been seen.
#[derive(Clone, Debug, PartialEq)]
pub enum Region {
    /// The window is the unit square, `[0, 1] × [0, 1]`.
    Unit,
    /// The window is the area of an image of width W and height H: `[−.5, W−.5] × [−.5, H−.5]` for
    /// coordinates in px, `[0, W] × [0, H]` in any other unit.
    Size(f64, f64),
    /// The window is the rectangle with these left, upper, right and lower edges, in the unit of
    /// the coordinates.
    Edges([f64; 4]),
    /// The window is the imaged part (without black margins) of the image that belongs to the
    /// coordinate file; see [`imaged_area`].
    Auto,
    /// The window is the entire image that belongs to the coordinate file.
    Image,
    /// The window consists of the polygons in this file, in the unit of the coordinates unless the
    /// file names another; see [`read_outline`].
    File(PathBuf),
}

impl FromStr for Region {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = |separator: char| -> Option<Vec<f64>> {
            text.split(separator)
                .map(|part| part.trim().parse().ok().filter(|v: &f64| v.is_finite()))
                .collect()
        };
        match (text, numbers('x').as_deref(), numbers(',').as_deref()) {
            ("unit", ..) => Ok(Self::Unit),
            ("auto", ..) => Ok(Self::Auto),
            ("image", ..) => Ok(Self::Image),
            (_, Some(&[w, h]), _) if w > 0. && h > 0. => Ok(Self::Size(w, h)),
            (_, _, Some(&[x0, y0, x1, y1])) if x0 < x1 && y0 < y1 => Ok(Self::Edges([x0, y0, x1, y1])),
            _ if Path::new(text).is_file() => Ok(Self::File(text.into())),
            _ => Err(format!(
                "“{text}” is neither a window nor an existing file: expected auto, image, unit, WxH, \
                 X0,Y0,X1,Y1 or a file of corners"
            )),
        }
    }
}

impl fmt::Display for Region {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unit => f.write_str("unit"),
            Self::Size(w, h) => write!(f, "{w}x{h}"),
            Self::Edges([x0, y0, x1, y1]) => write!(f, "{x0},{y0},{x1},{y1}"),
            Self::Auto => f.write_str("auto"),
            Self::Image => f.write_str("image"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

/// Source of the windows of all coordinate files of a batch. If the window comes from a file of
/// corners, that file is read only once.
pub(in crate::batch) struct Regions<'a> {
    /// The window that the user asked for.
    asked: &'a Region,
    /// The folder of the images, or the only image. `None` if each image lies beside its coordinate
    /// file.
    images: Option<&'a Path>,
    /// The content of the file of corners; `None` if the window comes from elsewhere.
    outline: Option<OutlineFile>,
}

impl<'a> Regions<'a> {
    /// Prepares the windows that `options` ask for, and reads the file of corners if there is one.
    ///
    /// # Errors
    /// Fails if the window comes from a file of corners that cannot be read.
    pub(in crate::batch) fn new(options: &'a CoordinatesOptions) -> Result<Self, BatchError> {
        let outline = match &options.region {
            Region::File(path) => Some(read_outline(path, &options.read)?),
            _ => None,
        };
        Ok(Self { asked: &options.region, images: options.images.as_deref(), outline })
    }

    /// Returns the image that belongs to a coordinate file; `None` if there is none.
    fn image_of(&self, file: &Path) -> Option<PathBuf> {
        match self.images {
            Some(image) if image.is_file() => Some(image.to_owned()),
            Some(folder) => image_in(folder, &image_name(file)),
            None => image_beside(file),
        }
    }

    /// Returns the window of a coordinate file and the scale of its image. The window is in `unit`,
    /// the unit of the coordinates. The scale is `None` if it is not known.
    ///
    /// # Errors
    /// Fails if the window is to be taken from an image and none is found, or if the window is in
    /// another unit than the coordinates and no scale is known to convert it.
    pub(in crate::batch) fn of(
        &self,
        file: &Path,
        unit: LengthUnit,
        scales: &ScaleSource,
    ) -> Result<(Window, Option<Scale>), BatchError> {
        // the window, its unit, and its width, from which the scale may be computed (the width of
        // the image in px if the window is taken from an image)
        let (window, given, width) = match (self.asked, &self.outline) {
            (Region::Auto | Region::Image, _) => {
                let beside =
                    self.image_of(file).ok_or_else(|| BatchError::NoImage { file: file.to_owned() })?;
                let plane = image::read(&beside)?;
                let (height, width) = plane.dim();
                let window = match self.asked {
                    Region::Auto => imaged_area(&plane)?,
                    _ => Window::of_image(width, height)?,
                };
                (window, LengthUnit::Pixel, width as f64)
            }
            (Region::Edges([x0, y0, x1, y1]), _) => (Window::rectangle(*x0, *y0, *x1, *y1)?, unit, x1 - x0),
            (Region::Size(w, h), _) if unit == LengthUnit::Pixel => {
                (Window::rectangle(-0.5, -0.5, w - 0.5, h - 0.5)?, unit, *w)
            }
            (Region::Size(w, h), _) => (Window::rectangle(0., 0., *w, *h)?, unit, *w),
            (_, Some(outline)) => {
                let window = outline.window.clone();
                let width = window.bounds().width();
                (window, outline.unit.unwrap_or(unit), width)
            }
            (Region::Unit | Region::File(_), None) => (Window::unit_square(), unit, 1.),
        };
        let scale = match unit {
            LengthUnit::Unit => None,
            LengthUnit::Micrometre if scales.is_unknown() => None,
            LengthUnit::Pixel | LengthUnit::Micrometre => {
                scales.scale_of(file, width.round().max(1.) as usize)?
            }
        };
        let missing = || BatchError::NoScale {
            what: match unit {
                LengthUnit::Micrometre => "the file of coordinates, unlike its window,",
                LengthUnit::Pixel | LengthUnit::Unit => "the window, unlike the coordinates,",
            },
            file: file.to_owned(),
        };
        let window = match (given, unit) {
            // the tissue shrank: `load` in measure.rs expands the coordinates by the same factor
            (LengthUnit::Micrometre, LengthUnit::Micrometre) if scales.expansion() != 1. => {
                window.scaled(scales.expansion())?
            }
            (LengthUnit::Pixel, LengthUnit::Micrometre) | (LengthUnit::Micrometre, LengthUnit::Pixel) => {
                window.scaled(given.factor_to(unit, scale).ok_or_else(missing)?)?
            }
            _ => window,
        };
        Ok((window, scale))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_read_as_documented() {
        assert_eq!("150x100".parse(), Ok(Region::Size(150., 100.)));
        assert_eq!("unit".parse(), Ok(Region::Unit));
        assert_eq!("0,0,1.5,2".parse(), Ok(Region::Edges([0., 0., 1.5, 2.])));
        for bad in ["", "0x5", "1,1,1,2", "nan,0,1,1", "150", "1,2,3"] {
            assert!(bad.parse::<Region>().is_err(), "{bad}");
        }
    }
}
