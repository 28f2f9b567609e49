//! Records of mosaics and images, in the form in which they are written to files.

use super::VerdictRecord;
use crate::detect::{Detections, Detector, FourierEstimate};
use crate::geometry::{Polygon, Window};
use crate::image::{Modality, Polarity};
use crate::mosaic::{LengthUnit, Mosaic, RetinalPlace, hexagonal_spacing};
use crate::stats;
use serde::{Deserialize, Serialize};

/// The measurements of a mosaic in its window, and its comparison with samplers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MosaicRecord {
    /// Number of points in the window.
    pub n: usize,
    /// Unit of all lengths in this record whose name ends in no unit.
    pub unit: LengthUnit,
    /// Micrometres per unit, if known.
    pub um_per_unit: Option<f64>,
    /// Micrometres per pixel of the image, if coordinates are in µm and the scale is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub um_per_image_px: Option<f64>,
    /// Micrometres per degree of visual angle, if a scale is known.
    pub um_per_degree: Option<f64>,
    /// Location on the retina, if known.
    pub place: Option<RetinalPlace>,
    /// Values that the manifest gives for the mosaic, in the order of the manifest's columns; empty
    /// without a manifest.
    pub labels: Vec<String>,
    /// Left, upper, right and lower edge of the window.
    pub window: [f64; 4],
    /// Area of the window, in squared units.
    pub window_area: f64,
    /// Outline of the window, if it is a polygon and not the rectangle of these edges.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outline: Option<Polygon>,
    /// All statistics that are single numbers.
    #[serde(flatten)]
    pub stats: stats::Summary,
    /// l-infinity distance of the pair correlation function to that of each sampler, in the order
    /// of the samplers.
    pub l_infinity: Vec<SamplerDistance>,
    /// Verdicts by simulations of each sampler; empty if no verdicts were asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub verdicts: Vec<VerdictRecord>,
}

/// Distance (l-infinity) between the pair correlation function of a mosaic and the mean one of a
/// sampler.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SamplerDistance {
    /// Name of the sampler.
    pub sampler: String,
    /// Largest difference of the two functions, max |g₁ − g₂|.
    pub l_infinity: f64,
}

impl MosaicRecord {
    /// Records a mosaic, its scalar statistics and its distances to samplers.
    ///
    /// Location, labels and verdicts are left empty.
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

    /// Returns the micrometres per pixel of the image, if known.
    pub fn um_per_px(&self) -> Option<f64> {
        match self.unit {
            LengthUnit::Pixel => self.um_per_unit,
            LengthUnit::Micrometre => self.um_per_image_px,
            LengthUnit::Unit => None,
        }
    }

    /// Returns the pixels per unit of the coordinates; `None` in the unit square, and for µm
    /// without a scale.
    pub fn px_per_unit(&self) -> Option<f64> {
        match self.unit {
            LengthUnit::Pixel => Some(1.),
            LengthUnit::Micrometre => self.um_per_image_px.map(|um| 1. / um),
            LengthUnit::Unit => None,
        }
    }

    /// Returns the number of points per mm², if the scale is known.
    pub fn density_per_mm2(&self) -> Option<f64> {
        self.um_per_unit.map(|um| self.stats.density * 1e6 / (um * um))
    }

    /// Returns the area of the window in mm², if the scale is known.
    pub fn window_area_mm2(&self) -> Option<f64> {
        self.um_per_unit.map(|um| self.window_area * um * um / 1e6)
    }

    /// Returns the l-infinity distance to the sampler of this name, if the mosaic was compared with
    /// it.
    pub fn distance_to(&self, sampler: &str) -> Option<f64> {
        self.l_infinity.iter().find(|d| d.sampler == sampler).map(|d| d.l_infinity)
    }

    /// Returns the name of the sampler with the smallest l-infinity distance, or `None` without
    /// distances.
    pub fn closest_sampler(&self) -> Option<&str> {
        let closest = self.l_infinity.iter().min_by(|a, b| a.l_infinity.total_cmp(&b.l_infinity))?;
        Some(&closest.sampler)
    }

    /// Returns the cones per mm² that are expected at the mosaic's location on the retina, if the
    /// location is known.
    ///
    /// See [`RetinalPlace::expected_cones_per_mm2`].
    pub fn expected_cones_per_mm2(&self) -> Option<f64> {
        self.place.and_then(|place| place.expected_cones_per_mm2())
    }

    /// Returns the hexagonal spacing at the expected density, in µm.
    pub fn expected_spacing_um(&self) -> Option<f64> {
        self.expected_cones_per_mm2().and_then(|density| hexagonal_spacing(1, 1e6 / density))
    }
}

/// The outcome of detecting the cones of one image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DetectionRecord {
    /// Kind of filters that found the cones: classical or learned.
    pub detector: Detector,
    /// Modality that was assumed for the image.
    pub modality: Modality,
    /// Probability that the modality is right; 1 if the user set it.
    pub modality_confidence: f64,
    /// Polarity that was assumed for the contrast of the cones.
    pub polarity: Polarity,
    /// Direction of the derivative in a split-detector image, degrees counter-clockwise from x.
    #[serde(default)]
    pub split_angle: Option<f64>,
    /// Number of cones found in the entire image.
    pub n: usize,
    /// Cone spacing from Yellott's ring in the spectrum of the image, px.
    pub ring_spacing_px: f64,
    /// Probability, judged from the ring alone, that its spacing is within 15 % of the true one.
    pub ring_confidence: f64,
    /// Prominence of the ring over detail finer than any cone, as a natural logarithm: above 6 on a
    /// clear image, 2 where noise is as strong as the cones.
    pub clarity: f64,
    /// Cone spacing after refinement by density, px.
    pub density_spacing_px: f64,
    /// Probability that the refined spacing is within 15 % of the true one.
    pub spacing_confidence: f64,
    /// Smallest and largest local spacing, px.
    pub spacing_range_px: [f64; 2],
    /// Expected number of false alarms among the cones, by their scores.
    pub expected_false_alarms: f64,
    /// Expected number of cones among the rejected candidates, by their scores.
    pub expected_misses: f64,
}

impl DetectionRecord {
    /// Records how the cones were detected; `n` is the number of cones in the entire image.
    pub fn new(found: &Detections, n: usize) -> Self {
        Self {
            detector: found.detector,
            modality: found.modality,
            modality_confidence: found.modality_confidence,
            polarity: found.polarity,
            split_angle: found.split_angle,
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

    /// Returns the share (0–1) of errors, false alarms and misses, that is expected among the cones
    /// found and missed.
    pub fn expected_error_rate(&self) -> f64 {
        // at most one false alarm per cone found, so the share cannot exceed 1
        let all = self.n as f64 + self.expected_misses;
        if all > 0. { (self.expected_false_alarms + self.expected_misses) / all } else { 0. }
    }
}

/// The origin of the cones of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ConesFrom {
    /// Cones that this program found.
    Detected,
    /// Cones from a file of the user, marked by hand or found by a program.
    Given,
    /// Cones that this program found and a person corrected.
    Corrected,
}

impl ConesFrom {
    /// Returns the name of the origin that is written to files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Detected => "detected",
            Self::Given => "given",
            Self::Corrected => "corrected",
        }
    }
}

/// Need of an image that was decided otherwise than those beside it, which exceeds that of any
/// other image: two shares.
const ODD: f64 = 10.;

/// Returns the indices of the records, sorted by how much a person should look at them, most first.
///
/// The measure is the expected share of errors, plus the doubt about modality and spacing. Records
/// with equal measures keep their order.
pub fn by_need(records: &[ImageRecord]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..records.len()).collect();
    // A wrong modality or spacing makes the scores wrong as well, so doubt about either counts as
    // need.
    let need = |k: &usize| {
        records[*k].detection.as_ref().map_or(0., |found| {
            let odd = if records[*k].odd_one_out { ODD } else { 0. };
            odd + found.expected_error_rate() + 1. - found.spacing_confidence * found.modality_confidence
        })
    };
    order.sort_by(|a, b| need(b).total_cmp(&need(a)));
    order
}

/// One image of a run: a row of `summary.csv` and the content of `metrics.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImageRecord {
    /// Path of the image, as set by the user.
    pub file: String,
    /// Name under which the results of the image are filed.
    pub name: String,
    /// SHA-256 hash of the file.
    pub sha256: String,
    /// SHA-256 hash of the program's version and of all options that the results depend on.
    pub options_sha256: String,
    /// Width of the image, px.
    pub width_px: usize,
    /// Height of the image, px.
    pub height_px: usize,
    /// Origin of the cones' coordinates.
    pub cones_from: ConesFrom,
    /// Number of cones from a file that lie outside the window and are left out.
    #[serde(default)]
    pub outside: usize,
    /// Record of the detection, or `None` if the cones come from a file or were corrected.
    pub detection: Option<DetectionRecord>,
    /// Spacing from the spectrum of the image; `None` if no column that needs it is wanted.
    #[serde(default)]
    pub fourier: Option<FourierEstimate>,
    /// Record of the mosaic with its statistics.
    pub mosaic: MosaicRecord,
    /// Warnings that a reader of these numbers needs.
    pub warnings: Vec<String>,
    /// `true` if the modality was decided otherwise than that of the images beside it.
    #[serde(skip)]
    pub odd_one_out: bool,
}

/// Coordinates measured without an image: a row of `measure`'s `summary.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CoordinatesRecord {
    /// Path of the file, as set by the user.
    pub file: String,
    /// Name under which the results of the file are filed.
    pub name: String,
    /// Number of points of the file outside the window, which are left out.
    pub outside: usize,
    /// Record of the mosaic with its statistics.
    pub mosaic: MosaicRecord,
    /// Warnings that a reader of these numbers needs.
    pub warnings: Vec<String>,
}
