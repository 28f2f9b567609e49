use super::Crop;
use crate::batch::BatchError;
use crate::geometry::{Point, Window};
use crate::image::{Plane, crop, furniture_share, imaged_area};
use crate::mosaic::io::{OutlineFile, ReadOptions, read_outline};
use crate::mosaic::{LengthUnit, Scale};
use crate::report::significant;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// The area of an image whose cones count.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum ImageWindow {
    /// Only cones in the imaged part count, which is the image without black margins. See
    /// [`imaged_area`].
    #[default]
    Auto,
    /// All cones in the image count, also in black margins.
    Image,
    /// Only cones in a rectangle count. The rectangle is centred in the image or has fixed edges.
    Rectangle(Crop),
    /// Only cones in the polygons in this file count; see [`read_outline`].
    File(PathBuf),
}

impl FromStr for ImageWindow {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "auto" => Ok(Self::Auto),
            "image" => Ok(Self::Image),
            _ => match text.parse() {
                Ok(rectangle) => Ok(Self::Rectangle(rectangle)),
                Err(_) if Path::new(text).is_file() => Ok(Self::File(text.into())),
                Err(_) => Err(format!(
                    "“{text}” is neither a window nor an existing file: expected auto, image, WxH \
                     (centred), X0,Y0,X1,Y1 (in px, or in µm with um at the end) or a file of corners"
                )),
            },
        }
    }
}

impl fmt::Display for ImageWindow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Image => f.write_str("image"),
            Self::Rectangle(rectangle) => rectangle.fmt(f),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

/// Source of the windows of all images of a run. If the window comes from a file of corners, that
/// file is read only once.
pub(in crate::batch) struct ImageWindows<'a> {
    /// The window that the user asked for.
    asked: &'a ImageWindow,
    /// The rectangle to which every window is cut; `None` if windows are not cut.
    crop: Option<&'a Crop>,
    /// The content of the file of corners; `None` if the window comes from elsewhere.
    outline: Option<OutlineFile>,
}

impl<'a> ImageWindows<'a> {
    /// Prepares the windows that `asked` and `crop` describe, and reads the file of corners if
    /// there is one.
    ///
    /// # Errors
    /// Fails if the window comes from a file of corners that cannot be read.
    pub(in crate::batch) fn new(asked: &'a ImageWindow, crop: Option<&'a Crop>) -> Result<Self, BatchError> {
        let outline = match asked {
            ImageWindow::File(path) => Some(read_outline(path, &ReadOptions::default())?),
            ImageWindow::Auto | ImageWindow::Image | ImageWindow::Rectangle(_) => None,
        };
        Ok(Self { asked, crop, outline })
    }

    /// Returns the window of an image, in px: the part of the area asked for that lies in the image
    /// and in the crop.
    ///
    /// # Errors
    /// Fails if nothing is left of the image, or a length is in µm and no scale is known.
    pub(in crate::batch) fn of(
        &self,
        file: &Path,
        image: &Plane,
        scale: Option<Scale>,
    ) -> Result<Window, BatchError> {
        let (height, width) = image.dim();
        let whole = Window::of_image(width, height)?;
        let left = |window: Option<Window>, asked: String| {
            window.ok_or(BatchError::Nowhere { file: file.to_owned(), window: asked, width, height })
        };
        let window = match (self.asked, &self.outline) {
            (ImageWindow::Rectangle(rectangle), _) => {
                rectangle.window("the window", file, width, height, scale)?
            }
            (ImageWindow::Auto, _) => imaged_area(image)?,
            (_, Some(outline)) => {
                let inside = pixels_of(outline, file, scale)?.within(&whole.bounds());
                left(inside, format!("window {}", self.asked))?
            }
            (ImageWindow::Image | ImageWindow::File(_), None) => whole,
        };
        let Some(crop) = self.crop else { return Ok(window) };
        let frame = crop.window("the crop", file, width, height, scale)?;
        left(window.within(&frame.bounds()), format!("crop {crop} of the window {}", self.asked))
    }
}

/// The part of an image that its window leaves to the detector: whole pixels, outward.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::batch) struct Cut {
    /// First column of the part, in px of the image.
    pub left: usize,
    /// First row of the part, in px of the image.
    pub top: usize,
    /// Pixels of the part; those outside polygons that the user drew are black.
    pub part: Plane,
}

impl ImageWindows<'_> {
    /// Returns a warning if the window is the imaged area and something other than black was left
    /// out of it.
    pub(in crate::batch) fn warning(&self, image: &Plane) -> Option<String> {
        let share = match self.asked {
            ImageWindow::Auto | ImageWindow::Image => furniture_share(image),
            _ => 0.,
        };
        (share > 0.).then(|| {
            format!(
                "{} % of the image, although not black, look like a margin, a label or a bar, and no cones were \
                 looked for there: look at the overlay and, if this is retina, cut it out of the image",
                significant(100. * share, 2)
            )
        })
    }

    /// Returns the part of an image that the detector may see, or `None` if that is all of it.
    ///
    /// `window` is that of [`of`](Self::of). Only a window or crop that the user gave cuts: the
    /// imaged area is found by the detector itself.
    pub(in crate::batch) fn cut(&self, image: &Plane, window: &Window) -> Option<Cut> {
        let given = matches!(self.asked, ImageWindow::Rectangle(_) | ImageWindow::File(_));
        if !given && self.crop.is_none() {
            return None;
        }
        let bounds = window.bounds();
        let (height, width) = image.dim();
        let first = |edge: f64| (edge + 0.5).floor().max(0.) as usize;
        let last = |edge: f64, side: usize| ((edge + 0.5).ceil().max(0.) as usize).min(side);
        let (left, top) = (first(bounds.x0()), first(bounds.y0()));
        let (right, bottom) = (last(bounds.x1(), width), last(bounds.y1(), height));
        let size = (bottom.checked_sub(top)?, right.checked_sub(left)?);
        let mut part = crop(image, top, left, size.0, size.1);
        if matches!(self.asked, ImageWindow::File(_)) && !matches!(window, Window::Rectangle(_)) {
            for ((y, x), v) in part.indexed_iter_mut() {
                if !window.contains(Point::new((x + left) as f64, (y + top) as f64)) {
                    *v = 0.;
                }
            }
        }
        (part.dim() != image.dim() || part != *image).then_some(Cut { left, top, part })
    }
}

/// Converts the window that was read from a file of corners to px.
fn pixels_of(outline: &OutlineFile, file: &Path, scale: Option<Scale>) -> Result<Window, BatchError> {
    let missing = || BatchError::NoScale { what: "the file of the window", file: file.to_owned() };
    match outline.unit {
        None | Some(LengthUnit::Pixel) => Ok(outline.window.clone()),
        Some(unit @ LengthUnit::Unit) => Err(BatchError::NotPixels { file: file.to_owned(), unit }),
        Some(unit @ LengthUnit::Micrometre) => {
            let factor = unit.factor_to(LengthUnit::Pixel, scale).ok_or_else(missing)?;
            Ok(outline.window.scaled(factor)?)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(asked: &str, crop: Option<&str>, image: &Plane) -> Result<Window, BatchError> {
        let (asked, crop) = (asked.parse().unwrap(), crop.map(|c| c.parse::<Crop>().unwrap()));
        ImageWindows::new(&asked, crop.as_ref())?.of(Path::new("a.png"), image, None)
    }

    #[test]
    fn a_crop_is_cut_from_the_window() {
        let image = Plane::from_shape_fn((60, 100), |(y, x)| f32::from(u8::from(x >= 40 || y >= 30)));
        let whole = Window::of_image(100, 60).unwrap();
        assert_eq!(window("image", None, &image).unwrap(), whole);
        assert_eq!(
            window("40x20", None, &image).unwrap(),
            Window::rectangle(29.5, 19.5, 69.5, 39.5).unwrap()
        );
        let imaged = window("auto", None, &image).unwrap();
        // 41 × 31 px are left out, not 40 × 30: the pixels along the two black edges are left out
        // too
        assert_eq!(imaged.area(), 6000. - 41. * 31.);
        let cropped = window("auto", Some("-0.5,-0.5,60.5,59.5"), &image).unwrap();
        assert_eq!(cropped.area(), 61. * 60. - 41. * 31.);
        let black = window("auto", Some("0,0,30,20"), &image).unwrap_err();
        assert!(matches!(black, BatchError::Nowhere { .. }), "{black:?}");
    }

    #[test]
    fn the_detector_sees_whole_pixels_of_a_given_window_only() {
        let image = Plane::from_shape_fn((60, 100), |(y, x)| (1 + y * 100 + x) as f32);
        let cut = |asked: &str, crop: Option<&str>| {
            let (asked, crop) = (asked.parse().unwrap(), crop.map(|c| c.parse::<Crop>().unwrap()));
            let windows = ImageWindows::new(&asked, crop.as_ref()).unwrap();
            let window = windows.of(Path::new("a.png"), &image, None).unwrap();
            windows.cut(&image, &window)
        };
        assert_eq!(cut("auto", None), None);
        assert_eq!(cut("image", None), None);
        for (asked, crop) in [("10,20,39.5,49.5", None), ("image", Some("9.5,19.5,39.5,49.5"))] {
            let cut = cut(asked, crop).unwrap();
            assert_eq!((cut.left, cut.top, cut.part.dim()), (10, 20, (30, 30)));
            assert_eq!(cut.part[[0, 0]], image[[20, 10]]);
        }
    }

    #[test]
    fn what_is_no_window_says_what_one_is() {
        let error = "nowhere.csv".parse::<ImageWindow>().unwrap_err();
        assert!(error.contains("nor an existing file") && error.contains("auto"), "{error}");
        for text in ["auto", "image", "40x20px", "1,2,3,4um"] {
            assert_eq!(text.parse::<ImageWindow>().unwrap().to_string(), text);
        }
    }
}
