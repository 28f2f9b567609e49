use super::{Detector, SpacingMap};
use crate::geometry::{Point, Window};
use crate::image::{Modality, Plane, Polarity};
use crate::mosaic::{LengthUnit, Mosaic, MosaicError, Scale};
use serde::{Deserialize, Serialize};

/// One cone found in an image.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Detection {
    /// Its centre in px.
    pub centre: Point,
    /// Probability that it is a cone that a person would mark (0–1). Detection's inner stages put the height of a filter's
    /// response here, in the unit of that filter.
    pub score: f64,
}

/// What was found in one image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Detections {
    /// The cones, from the highest score to the lowest.
    pub cones: Vec<Detection>,
    /// Candidates that were not taken for cones, from the highest score to the lowest.
    pub rejected: Vec<Detection>,
    /// How the image was taken to be made.
    pub modality: Modality,
    /// Probability (0–1) that this is right; 1 if it was given.
    pub modality_confidence: f64,
    /// Which way round its contrast was taken to run.
    pub polarity: Polarity,
    /// Which filters found the cones: classical or learned.
    pub detector: Detector,
    /// Cone spacing estimated from Yellott's ring alone, in px.
    pub ring_spacing: f64,
    /// Probability (0–1) by the ring alone that this is within 15 % of the true one.
    pub ring_confidence: f64,
    /// By how much the ring of `spacing` stands out of detail finer than any cone: a natural logarithm, see
    /// [`RingProfile::clarity`](super::RingProfile::clarity).
    pub clarity: f64,
    /// Cone spacing after refinement by the density of the detections, in px: the geometric mean of `spacing_map`.
    pub spacing: f64,
    /// Probability (0–1) that this is within 15 % of the true one.
    pub spacing_confidence: f64,
    /// The spacing from place to place; constant where density is even.
    pub spacing_map: SpacingMap,
}

impl Detections {
    /// How many of `cones` are expected to be none: the sum of what their scores lack of 1.
    pub fn expected_false_alarms(&self) -> f64 {
        self.cones.iter().map(|d| 1. - d.score).sum()
    }

    /// How many cones are expected among the `rejected`: the sum of their scores. Cones that left no trace do not count.
    pub fn expected_misses(&self) -> f64 {
        self.rejected.iter().map(|d| d.score).sum()
    }

    /// Moves everything `left` px to the right and `top` px down.
    pub(super) fn move_by(&mut self, left: usize, top: usize) {
        for d in self.cones.iter_mut().chain(&mut self.rejected) {
            d.centre = Point::new(d.centre.x + left as f64, d.centre.y + top as f64);
        }
        self.spacing_map.move_by(left as f64, top as f64);
    }

    /// Makes a px `times` as many px.
    pub(super) fn enlarge(&mut self, times: f64) {
        let place = |x: f64| (x + 0.5) * times - 0.5;
        for d in self.cones.iter_mut().chain(&mut self.rejected) {
            d.centre = Point::new(place(d.centre.x), place(d.centre.y));
        }
        self.ring_spacing *= times;
        self.spacing *= times;
        self.spacing_map.enlarge(times);
    }

    /// Returns the cones as a mosaic in the window of the whole of `image`, in which they were found, in px. Without a
    /// `scale`, what is measured in it stays in px.
    ///
    /// # Errors
    /// If the image has no pixels, or a centre is not a finite number.
    pub fn mosaic(&self, image: &Plane, scale: Option<Scale>) -> Result<Mosaic, MosaicError> {
        // refined centres may lie up to half a pixel from their own, never beyond the window of the image
        let (mosaic, _) = Mosaic::new(self.centres(), Window::of(image)?, LengthUnit::Pixel, scale)?;
        Ok(mosaic)
    }

    /// The centres in px, in the order of `cones`.
    pub fn centres(&self) -> Vec<Point> {
        self.cones.iter().map(|d| d.centre).collect()
    }
}
