//! What is known of one mosaic, in the form in which it is written to files.

use super::VerdictRecord;
use crate::detect::{Detections, Detector, FourierEstimate};
use crate::geometry::{Polygon, Window};
use crate::image::{Modality, Polarity};
use crate::mosaic::{LengthUnit, Mosaic, RetinalPlace, hexagonal_spacing};
use crate::stats;
use serde::{Deserialize, Serialize};

/// Points measured in their window, and compared with samplers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MosaicRecord {
    /// Number of points in the window.
    pub n: usize,
    /// The unit of all lengths here that do not say otherwise.
    pub unit: LengthUnit,
    /// Micrometres per unit, if known.
    pub um_per_unit: Option<f64>,
    /// Micrometres per pixel of the image, where coordinates are in µm and the scale is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub um_per_image_px: Option<f64>,
    /// Micrometres per degree of visual angle, if a scale is known.
    pub um_per_degree: Option<f64>,
    /// Where on the retina it lies, if that is known.
    pub place: Option<RetinalPlace>,
    /// What a manifest says of it, in the order of the manifest's columns; empty without.
    pub labels: Vec<String>,
    /// Left, upper, right and lower edge of the window.
    pub window: [f64; 4],
    /// Area of the window, in squared units.
    pub window_area: f64,
    /// Its outline, where it is not the rectangle of these edges.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outline: Option<Polygon>,
    /// All statistics that are single numbers.
    #[serde(flatten)]
    pub stats: stats::Summary,
    /// Distance of pair correlation functions to each sampler, in the order of the samplers.
    pub l_infinity: Vec<SamplerDistance>,
    /// What simulations of each sampler say of it, if that was asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub verdicts: Vec<VerdictRecord>,
}

/// l-infinity distance of a mosaic's pair correlation function to the mean one of a sampler.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SamplerDistance {
    /// Name of the sampler.
    pub sampler: String,
    /// max |g₁ − g₂|.
    pub l_infinity: f64,
}

impl MosaicRecord {
    /// Records a mosaic, its scalars and its distances to samplers; place, labels and verdicts are left open.
    pub fn new(mosaic: &Mosaic, measures: &stats::Measures, l_infinity: Vec<SamplerDistance>) -> Self {
        let bounds = mosaic.window().bounds();
        let in_micrometres = mosaic.unit() == LengthUnit::Micrometre;
        Self {
            n: mosaic.len(),
            unit: mosaic.unit(),
            um_per_unit: mosaic.micrometres_per_unit(),
            um_per_image_px: mosaic.scale().filter(|_| in_micrometres).map(|s| s.micrometres_per_pixel()),
            um_per_degree: mosaic.scale().map(|s| s.micrometres_per_degree()),
            place: None,
            labels: Vec::new(),
            window: [bounds.x0(), bounds.y0(), bounds.x1(), bounds.y1()],
            window_area: mosaic.window().area(),
            outline: match mosaic.window() {
                Window::Polygon(polygon) => Some(polygon.clone()),
                Window::Rectangle(_) | Window::Torus(_) => None,
            },
            stats: measures.summary.clone(),
            l_infinity,
            verdicts: Vec::new(),
        }
    }

    /// Micrometres per pixel, if known.
    pub fn um_per_px(&self) -> Option<f64> {
        match self.unit {
            LengthUnit::Pixel => self.um_per_unit,
            LengthUnit::Micrometre => self.um_per_image_px,
            LengthUnit::Unit => None,
        }
    }

    /// Pixels per unit of the coordinates; `None` in the unit square, and for µm without a scale.
    pub fn px_per_unit(&self) -> Option<f64> {
        match self.unit {
            LengthUnit::Pixel => Some(1.),
            LengthUnit::Micrometre => self.um_per_image_px.map(|um| 1. / um),
            LengthUnit::Unit => None,
        }
    }

    /// Points per mm², if the scale is known.
    pub fn density_per_mm2(&self) -> Option<f64> {
        self.um_per_unit.map(|um| self.stats.density * 1e6 / (um * um))
    }

    /// Area of the window in mm², if the scale is known.
    pub fn window_area_mm2(&self) -> Option<f64> {
        self.um_per_unit.map(|um| self.window_area * um * um / 1e6)
    }

    /// l-infinity distance to the sampler of this name, if it was compared with.
    pub fn distance_to(&self, sampler: &str) -> Option<f64> {
        self.l_infinity.iter().find(|d| d.sampler == sampler).map(|d| d.l_infinity)
    }

    /// The sampler of least l-infinity distance.
    pub fn closest_sampler(&self) -> Option<&str> {
        let closest = self.l_infinity.iter().min_by(|a, b| a.l_infinity.total_cmp(&b.l_infinity))?;
        Some(&closest.sampler)
    }

    /// Cones per mm² that are expected at its place on the retina, if that is known; see
    /// [`RetinalPlace::expected_cones_per_mm2`].
    pub fn expected_cones_per_mm2(&self) -> Option<f64> {
        self.place.and_then(|place| place.expected_cones_per_mm2())
    }

    /// Hexagonal spacing of that density, in µm.
    pub fn expected_spacing_um(&self) -> Option<f64> {
        self.expected_cones_per_mm2().and_then(|density| hexagonal_spacing(1, 1e6 / density))
    }
}

/// What was found in one image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DetectionRecord {
    /// Filters that found the cones: classical or learned.
    pub detector: Detector,
    /// How the image was taken to be made.
    pub modality: Modality,
    /// Probability that this is right; 1 if it was given.
    pub modality_confidence: f64,
    /// Which way round its contrast was taken to run.
    pub polarity: Polarity,
    /// Cones found in the whole image.
    pub n: usize,
    /// Cone spacing by Yellott's ring, px.
    pub ring_spacing_px: f64,
    /// Probability, by the ring alone, that its spacing is within 15 % of the true one.
    pub ring_confidence: f64,
    /// By how much the ring stands out of detail finer than any cone, as a natural logarithm: above 6 on a clear image, 2 where noise is
    /// as strong as the cones.
    pub clarity: f64,
    /// Cone spacing after refinement by density, px.
    pub density_spacing_px: f64,
    /// Probability that the spacing is within 15 % of the true one.
    pub spacing_confidence: f64,
    /// Closest and widest local spacing, px.
    pub spacing_range_px: [f64; 2],
    /// How many of the cones are expected to be none, by their scores.
    pub expected_false_alarms: f64,
    /// How many cones are expected among the candidates that were rejected, by their scores.
    pub expected_misses: f64,
}

impl DetectionRecord {
    /// Records how cones were found, `n` of them in the whole image.
    pub fn new(found: &Detections, n: usize) -> Self {
        Self {
            detector: found.detector,
            modality: found.modality,
            modality_confidence: found.modality_confidence,
            polarity: found.polarity,
            n,
            ring_spacing_px: found.ring_spacing,
            ring_confidence: found.ring_confidence,
            clarity: found.clarity,
            density_spacing_px: found.spacing,
            spacing_confidence: found.spacing_confidence,
            spacing_range_px: found.spacing_map.range().into(),
            expected_false_alarms: found.expected_false_alarms(),
            expected_misses: found.expected_misses(),
        }
    }

    /// Errors expected per cone found.
    pub fn expected_error_rate(&self) -> f64 {
        (self.expected_false_alarms + self.expected_misses) / self.n.max(1) as f64
    }
}

/// The origin of the cones of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ConesFrom {
    /// This program found them.
    Detected,
    /// They were marked or found before, and given.
    Given,
    /// This program found them, and a person corrected them.
    Corrected,
}

impl ConesFrom {
    /// Returns the origin in a word.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Detected => "detected",
            Self::Given => "given",
            Self::Corrected => "corrected",
        }
    }
}

/// Indices of the records, those first that need the eye of a person most; equals stay in order.
pub fn by_need(records: &[ImageRecord]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..records.len()).collect();
    // where the modality or the spacing is wrong, so are the scores
    let need = |k: &usize| {
        records[*k].detection.as_ref().map_or(0., |found| {
            found.expected_error_rate() + 1. - found.spacing_confidence * found.modality_confidence
        })
    };
    order.sort_by(|a, b| need(b).total_cmp(&need(a)));
    order
}

/// One image of a run: a row of `summary.csv`, the content of `metrics.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImageRecord {
    /// Path as given.
    pub file: String,
    /// Name under which its results stand.
    pub name: String,
    /// SHA-256 of the file.
    pub sha256: String,
    /// SHA-256 of the version and of all options that results depend on.
    pub options_sha256: String,
    /// Width in px.
    pub width_px: usize,
    /// Height in px.
    pub height_px: usize,
    /// Where the cones are from.
    pub cones_from: ConesFrom,
    /// Given cones outside the window, which are left out.
    #[serde(default)]
    pub outside: usize,
    /// How this program found the cones; `None` if they were given or corrected.
    pub detection: Option<DetectionRecord>,
    /// Spacing by the spectrum of the image; `None` if no column of it is wanted.
    #[serde(default)]
    pub fourier: Option<FourierEstimate>,
    /// Their statistics.
    pub mosaic: MosaicRecord,
    /// What a reader of these numbers should know.
    pub warnings: Vec<String>,
}

/// Coordinates measured without an image: a row of `measure`'s `summary.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CoordinatesRecord {
    /// Path as given.
    pub file: String,
    /// Name under which its results stand.
    pub name: String,
    /// Points of the file that lie outside the window and were left out.
    pub outside: usize,
    /// Their statistics.
    pub mosaic: MosaicRecord,
    /// What a reader of these numbers should know.
    pub warnings: Vec<String>,
}
