use super::BatchError;
use crate::geometry::Window;
use crate::mosaic::Scale;
use std::fmt;
use std::path::Path;
use std::str::FromStr;

/// The part of an image whose cones count: a centred rectangle or given edges, in px or µm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crop {
    shape: Shape,
    micrometres: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    Centred { width: f64, height: f64 },
    Edges([f64; 4]),
}

impl FromStr for Crop {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let bad = || {
            format!(
                "“{text}” is no crop: expected WxH (centred) or X0,Y0,X1,Y1, in px, or in µm with um behind it"
            )
        };
        let (body, micrometres) = match text.strip_suffix("um") {
            Some(body) => (body, true),
            None => (text.strip_suffix("px").unwrap_or(text), false),
        };
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
        Ok(Self { shape, micrometres })
    }
}

impl fmt::Display for Crop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.shape {
            Shape::Centred { width, height } => write!(f, "{width}x{height}")?,
            Shape::Edges([x0, y0, x1, y1]) => write!(f, "{x0},{y0},{x1},{y1}")?,
        }
        f.write_str(if self.micrometres { "um" } else { "px" })
    }
}

impl Crop {
    /// Whether it is in µm, so that a scale is needed.
    pub const fn in_micrometres(&self) -> bool {
        self.micrometres
    }

    /// The window, in px, that the crop leaves of an image of `width` × `height` px. `option` is what it was given as.
    ///
    /// # Errors
    /// If it leaves nothing, or is in µm and there is no scale.
    pub fn window(
        &self,
        option: &'static str,
        file: &Path,
        width: usize,
        height: usize,
        scale: Option<Scale>,
    ) -> Result<Window, BatchError> {
        let px = match (self.micrometres, scale) {
            (false, _) => 1.,
            (true, Some(scale)) => 1. / scale.micrometres_per_pixel(),
            (true, None) => return Err(BatchError::NoScale { what: option, file: file.to_owned() }),
        };
        let (w, h) = (width as f64, height as f64);
        let [x0, y0, x1, y1] = match self.shape {
            Shape::Centred { width, height } => {
                let (dx, dy) = ((w - width * px) / 2., (h - height * px) / 2.);
                [dx - 0.5, dy - 0.5, w - dx - 0.5, h - dy - 0.5]
            }
            Shape::Edges(edges) => edges.map(|v| v * px),
        };
        Window::rectangle(x0.max(-0.5), y0.max(-0.5), x1.min(w - 0.5), y1.min(h - 0.5)).map_err(|_| {
            let file = file.to_owned();
            let window = format!("{} {self}", option.trim_start_matches('-'));
            BatchError::Nowhere { file, window, width, height }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(crop: &str, scale: Option<f64>) -> Result<[f64; 4], BatchError> {
        let scale = scale.map(|um| Scale::new(um, 288.).unwrap());
        let crop: Crop = crop.parse().unwrap();
        let b = crop.window("--crop", Path::new("a.png"), 100, 60, scale)?.bounds();
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
    fn micrometres_need_a_scale_and_something_must_be_left() {
        assert!(matches!(window("20x10um", None), Err(BatchError::NoScale { .. })));
        assert!(matches!(window("200,10,500,30", None), Err(BatchError::Nowhere { .. })));
        assert!(
            "40".parse::<Crop>().is_err() && "0x4".parse::<Crop>().is_err() && "axb".parse::<Crop>().is_err()
        );
    }
}
