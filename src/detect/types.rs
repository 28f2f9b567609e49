use super::{Detector, SpacingMap};
use crate::geometry::{Point, Window};
use crate::image::{Modality, Plane, Polarity};
use crate::mosaic::{LengthUnit, Mosaic, MosaicError, Scale};
use serde::{Deserialize, Serialize};

/// One cone found in an image.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Detection {
    /// Centre of the cone in px.
    pub centre: Point,
    /// Probability (0–1) that a person would mark a cone here.
    ///
    /// The inner stages of detection, such as [`local_maxima`](super::local_maxima), store the
    /// height of the filter's response instead, in the unit of that filter.
    pub score: f64,
}

/// Cones found in one image, with the properties that were assumed of the image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Detections {
    /// Cones, from the highest score to the lowest.
    pub cones: Vec<Detection>,
    /// Candidates that were not taken for cones, from the highest score to the lowest.
    pub rejected: Vec<Detection>,
    /// Modality of the image, set by the user or decided from the image.
    pub modality: Modality,
    /// Probability (0–1) that the modality is right; 1 if the user set it.
    pub modality_confidence: f64,
    /// Sign of the cones' contrast, set by the user or decided from the image.
    pub polarity: Polarity,
    /// Direction of the derivative that a split-detector image shows, in degrees counter-clockwise
    /// as seen, from 0 (along x, to the right) to below 180; `None` for other modalities.
    ///
    /// With positive polarity, the image of a cone becomes brighter in this direction.
    pub split_angle: Option<f64>,
    /// Kind of filters that found the cones: classical or learned.
    pub detector: Detector,
    /// Cone spacing estimated from Yellott's ring alone, in px.
    pub ring_spacing: f64,
    /// Probability (0–1), judged by the ring alone, that `ring_spacing` is within 15 % of the true
    /// spacing.
    pub ring_confidence: f64,
    /// Clarity of the image: the natural logarithm of the ratio of the power around the ring of
    /// `spacing` to the power of detail finer than any cone.
    ///
    /// It is above 6 for a clear image, and 2 where noise is as strong as the cones. See
    /// [`RingProfile::clarity`](super::RingProfile::clarity).
    pub clarity: f64,
    /// Cone spacing after refinement by the density of the detections, in px.
    ///
    /// It is the geometric mean of `spacing_map`.
    pub spacing: f64,
    /// Probability (0–1) that `spacing` is within 15 % of the true spacing.
    pub spacing_confidence: f64,
    /// Cone spacing in px as a function of position; constant if the density is even.
    pub spacing_map: SpacingMap,
}

impl Detections {
    /// Returns the expected number of false alarms among `cones`: the sum of 1 − score.
    pub fn expected_false_alarms(&self) -> f64 {
        self.cones.iter().map(|d| 1. - d.score).sum()
    }

    /// Returns the expected number of cones among the `rejected` candidates: the sum of the
    /// candidates' scores.
    ///
    /// Cones that left no trace in the image do not count.
    pub fn expected_misses(&self) -> f64 {
        self.rejected.iter().map(|d| d.score).sum()
    }

    /// Shifts all positions by `left` px in x and by `top` px in y.
    pub(crate) fn move_by(&mut self, left: usize, top: usize) {
        for d in self.cones.iter_mut().chain(&mut self.rejected) {
            d.centre = Point::new(d.centre.x + left as f64, d.centre.y + top as f64);
        }
        self.spacing_map.move_by(left as f64, top as f64);
    }

    /// Converts all positions and spacings to px of the image from px of a coarser image, whose
    /// pixels are means over blocks of `times` × `times` px.
    ///
    /// The outer edges of pixels stay where they are: position x becomes (x + ½) · times − ½.
    pub(super) fn enlarge(&mut self, times: f64) {
        let place = |x: f64| (x + 0.5) * times - 0.5;
        for d in self.cones.iter_mut().chain(&mut self.rejected) {
            d.centre = Point::new(place(d.centre.x), place(d.centre.y));
        }
        self.ring_spacing *= times;
        self.spacing *= times;
        self.spacing_map.enlarge(times);
    }

    /// Returns the cones as a mosaic in px whose window is all of `image`, in which they were
    /// found.
    ///
    /// Without a `scale`, everything measured in the mosaic stays in px.
    ///
    /// # Errors
    /// Fails if the image has no pixels, or if the position of a cone is not a finite number.
    pub fn mosaic(&self, image: &Plane, scale: Option<Scale>) -> Result<Mosaic, MosaicError> {
        // a refined centre lies at most half a pixel from its pixel, so never beyond the image's
        // window
        let (mosaic, _) = Mosaic::new(self.centres(), Window::of(image)?, LengthUnit::Pixel, scale)?;
        Ok(mosaic)
    }

    /// Returns the centres of the cones in px, in the order of `cones`.
    pub fn centres(&self) -> Vec<Point> {
        self.cones.iter().map(|d| d.centre).collect()
    }
}
