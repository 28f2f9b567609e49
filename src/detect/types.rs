use super::{Detector, SpacingMap};
use crate::geometry::Point;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// How the image was taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Modality {
    /// Confocal adaptive-optics ophthalmoscopy: a cone is a bright spot.
    Confocal,
    /// Split-detector adaptive-optics ophthalmoscopy: an inner segment is a dark–bright pair along x.
    Split,
    /// Histology: an inner segment is a disc, brighter or darker than what surrounds it.
    Histology,
}

impl Modality {
    /// Every modality.
    pub const ALL: [Self; 3] = [Self::Confocal, Self::Split, Self::Histology];

    /// As it is written in options and tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Confocal => "confocal",
            Self::Split => "split",
            Self::Histology => "histology",
        }
    }
}

impl fmt::Display for Modality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Modality {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|m| m.name() == text)
            .ok_or_else(|| format!("“{text}” is none of confocal, split, histology"))
    }
}

/// Which way round the contrast of a cone runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Polarity {
    /// Cones brighter than what surrounds them; in split detection, dark on the left and bright on the right.
    Positive,
    /// The same with the sign turned.
    Negative,
}

impl Polarity {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Positive, Self::Negative];

    /// As it is written in options and tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Positive => "positive",
            Self::Negative => "negative",
        }
    }
}

impl FromStr for Polarity {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|p| p.name() == text)
            .ok_or_else(|| format!("“{text}” is none of positive, negative"))
    }
}

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

    /// The centres in px, in the order of `cones`.
    pub fn centres(&self) -> Vec<Point> {
        self.cones.iter().map(|d| d.centre).collect()
    }
}
