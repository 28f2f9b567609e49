use crate::batch::BatchError;
use crate::geometry::{Rectangle, Window};
use crate::mosaic::{LengthUnit, Scale};
use std::fmt;
use std::path::Path;
use std::str::FromStr;

/// The rectangle to which a window is cut, so that only the cones inside it count. It is either
/// centred in the window or has fixed edges. Lengths are in px, in µm or in the unit of the
/// coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crop {
    shape: Shape,
    /// The unit at the end of the crop's text. `None` if the text has no unit: lengths are then in
    /// the unit of the coordinates, which for an image is px.
    unit: Option<LengthUnit>,
}

/// Size and position of a crop, in its own unit.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    /// A rectangle of this size in the centre of the window.
    Centred { width: f64, height: f64 },
    /// A rectangle with these left, upper, right and lower edges.
    Edges([f64; 4]),
}

impl FromStr for Crop {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let bad = || {
            format!(
                "“{text}” is not a crop: expected WxH (centred) or X0,Y0,X1,Y1, with px or um at the end \
                 for the unit"
            )
        };
        let suffixes =
            [("um", LengthUnit::Micrometre), ("µm", LengthUnit::Micrometre), ("px", LengthUnit::Pixel)];
        let (body, unit) = suffixes
            .into_iter()
            .find_map(|(suffix, unit)| text.strip_suffix(suffix).map(|body| (body, Some(unit))))
            .unwrap_or((text, None));
        let numbers = |separator: char| -> Option<Vec<f64>> {
            body.split(separator)
                .map(|part| part.trim().parse().ok().filter(|v: &f64| v.is_finite()))
                .collect()
        };
        let shape = match (numbers('x').as_deref(), numbers(',').as_deref()) {
            (Some(&[width, height]), _) if width > 0. && height > 0. => Shape::Centred { width, height },
            (_, Some(&[x0, y0, x1, y1])) if x0 < x1 && y0 < y1 => Shape::Edges([x0, y0, x1, y1]),
            _ => return Err(bad()),
        };
        Ok(Self { shape, unit })
    }
}

impl fmt::Display for Crop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.shape {
            Shape::Centred { width, height } => write!(f, "{width}x{height}")?,
            Shape::Edges([x0, y0, x1, y1]) => write!(f, "{x0},{y0},{x1},{y1}")?,
        }
        f.write_str(self.unit.map_or("", LengthUnit::symbol))
    }
}

impl Crop {
    /// Returns whether the crop is in µm, so that images need a scale.
    pub fn in_micrometres(&self) -> bool {
        self.unit == Some(LengthUnit::Micrometre)
    }

    /// Returns the rectangle that the crop leaves of `bounds`, both in `unit`; `None` if nothing is
    /// left.
    ///
    /// A crop without fixed edges is centred in `bounds`. `file` and `option` (the name of the
    /// crop) are for the error message only.
    ///
    /// # Errors
    /// Fails if the crop is in another unit than `unit` and no scale is known to convert it.
    pub(in crate::batch) fn frame(
        &self,
        option: &'static str,
        file: &Path,
        bounds: &Rectangle,
        unit: LengthUnit,
        scale: Option<Scale>,
    ) -> Result<Option<Rectangle>, BatchError> {
        let given = self.unit.unwrap_or(unit);
        let factor = given.factor_to(unit, scale).ok_or_else(|| match unit {
            LengthUnit::Unit => BatchError::CropUnit { crop: self.to_string(), file: file.to_owned() },
            _ => BatchError::NoScale { what: option, file: file.to_owned() },
        })?;
        let [x0, y0, x1, y1] = match self.shape {
            Shape::Centred { width, height } => {
                let (dx, dy) =
                    ((bounds.width() - width * factor) / 2., (bounds.height() - height * factor) / 2.);
                [bounds.x0() + dx, bounds.y0() + dy, bounds.x1() - dx, bounds.y1() - dy]
            }
            Shape::Edges(edges) => edges.map(|v| v * factor),
        };
        let [x0, y0] = [x0.max(bounds.x0()), y0.max(bounds.y0())];
        Ok(Rectangle::new(x0, y0, x1.min(bounds.x1()), y1.min(bounds.y1())).ok())
    }

    /// Returns the window, in px, that the crop leaves of an image of `width` × `height` px.
    ///
    /// `file` and `option` (the name of the crop) are for the error message only.
    ///
    /// # Errors
    /// Fails if the crop leaves nothing of the image, or is in µm and no scale is known.
    pub(super) fn window(
        &self,
        option: &'static str,
        file: &Path,
        width: usize,
        height: usize,
        scale: Option<Scale>,
    ) -> Result<Window, BatchError> {
        let bounds = Window::of_image(width, height)?.bounds();
        let frame = self.frame(option, file, &bounds, LengthUnit::Pixel, scale)?;
        frame.map(Window::Rectangle).ok_or_else(|| BatchError::Nowhere {
            file: file.to_owned(),
            window: format!("{} {self}", option.trim_start_matches("the ")),
            width,
            height,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(crop: &str, scale: Option<f64>) -> Result<[f64; 4], BatchError> {
        let scale = scale.map(|um| Scale::new(um, 288.).unwrap());
        let crop: Crop = crop.parse().unwrap();
        let b = crop.window("crop", Path::new("a.png"), 100, 60, scale)?.bounds();
        Ok([b.x0(), b.y0(), b.x1(), b.y1()])
    }

    #[test]
    fn a_size_is_cut_from_the_centre() {
        assert_eq!(window("40x20", None).unwrap(), [29.5, 19.5, 69.5, 39.5]);
        assert_eq!(window("20x10um", Some(0.5)).unwrap(), [29.5, 19.5, 69.5, 39.5]);
    }

    #[test]
    fn edges_are_held_within_the_image() {
        assert_eq!(window("10,10,500,30", None).unwrap(), [10., 10., 99.5, 30.]);
    }

    #[test]
    fn it_is_centred_in_the_window_of_coordinates_in_their_unit() {
        let frame = |crop: &str, unit, scale: Option<f64>| {
            let scale = scale.map(|um| Scale::new(um, 288.).unwrap());
            let bounds = Rectangle::new(10., 20., 110., 60.).unwrap();
            let crop: Crop = crop.parse().unwrap();
            crop.frame("the crop", Path::new("a.csv"), &bounds, unit, scale)
        };
        let (px, um) = (LengthUnit::Pixel, LengthUnit::Micrometre);
        let middle = Some(Rectangle::new(50., 35., 70., 45.).unwrap());
        for (crop, unit, scale) in [
            ("20x10", px, None),
            ("20x10", um, None),
            ("20x10um", um, None),
            ("10x5um", px, Some(0.5)),
            ("40x20px", um, Some(0.5)),
        ] {
            assert_eq!(frame(crop, unit, scale).unwrap(), middle, "{crop}");
        }
        assert_eq!(frame("20x10", LengthUnit::Unit, None).unwrap(), middle);
        assert_eq!(frame("0,0,5,5", px, None).unwrap(), None);
        assert!(matches!(frame("20x10px", um, None), Err(BatchError::NoScale { .. })));
        assert!(matches!(frame("20x10px", LengthUnit::Unit, None), Err(BatchError::CropUnit { .. })));
    }

    #[test]
    fn micrometres_need_a_scale_and_something_must_be_left() {
        assert!(matches!(window("20x10um", None), Err(BatchError::NoScale { .. })));
        assert!(matches!(window("200,10,500,30", None), Err(BatchError::Nowhere { .. })));
        assert!(
            "40".parse::<Crop>().is_err() && "0x4".parse::<Crop>().is_err() && "axb".parse::<Crop>().is_err()
        );
    }
}
