//! What is known of one mosaic, in the form in which it is written to files.

use super::{Cell, VerdictRecord, tables};
use crate::detect::{Detector, FourierEstimate};
use crate::geometry::Polygon;
use crate::image::{Modality, Polarity};
use crate::mosaic::{LengthUnit, RetinalPlace, hexagonal_spacing};
use crate::stats::{
    ClarkEvans, DensityRecovery, Deviation, ModalSpacing, Moments, NeighbourEllipse, Orientation, Trend,
    VoronoiSummary,
};
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
    /// Points per squared unit.
    pub density: f64,
    /// Hexagonal spacing of that density.
    pub spacing: Option<f64>,
    /// Divisor of the variances.
    pub deviation: Deviation,
    /// Nearest-neighbour distances of all points.
    pub nearest: Moments,
    /// The same of points whose distance to the border is at least that to their nearest neighbour.
    pub nearest_interior: Moments,
    /// The same of points whose Voronoi cell lies strictly inside the window.
    pub nearest_bound: Moments,
    /// Mean nearest-neighbour distance over that of independent points.
    pub clark_evans: ClarkEvans,
    /// Voronoi cells strictly inside the window.
    pub voronoi: VoronoiSummary,
    /// What the density recovery profile says; `None` for fewer than two points.
    pub density_recovery: Option<RecoveryRecord>,
    /// Directions of its neighbours.
    pub orientation: OrientationRecord,
    /// Ring of the power spectrum of its points; `None` where it has none.
    pub modal: Option<ModalSpacing>,
    /// Whether density varies across the window.
    pub trend: Trend,
    /// Distance of pair correlation functions to each sampler, in the order of the samplers.
    pub l_infinity: Vec<SamplerDistance>,
    /// What simulations of each sampler say of it, if that was asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub verdicts: Vec<VerdictRecord>,
}

/// What a density recovery profile says, see [`DensityRecovery`]. Lengths in the unit of the mosaic.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecoveryRecord {
    /// Width of the annuli.
    pub bin_width: f64,
    /// Effective radius.
    pub effective_radius: Option<f64>,
    /// Packing factor.
    pub packing: Option<f64>,
    /// Reliability factor.
    pub reliability: f64,
}

impl From<&DensityRecovery> for RecoveryRecord {
    fn from(profile: &DensityRecovery) -> Self {
        Self {
            bin_width: profile.bin_width,
            effective_radius: profile.effective_radius,
            packing: profile.packing,
            reliability: profile.reliability,
        }
    }
}

/// Directions of neighbours, see [`Orientation`]: angles in degrees, counter-clockwise from the x axis as the picture is seen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrientationRecord {
    /// Interior points whose nearest neighbour has a direction.
    pub axes: usize,
    /// Length of the mean of exp(2iθ) of these directions.
    pub resultant: Option<f64>,
    /// Their mean axis, 0–180°.
    pub direction: Option<f64>,
    /// Chance of such a resultant where all directions are alike.
    pub p_value: Option<f64>,
    /// Ellipse of the ways to the neighbours.
    pub ellipse: Option<NeighbourEllipse>,
    /// Orientation of the hexagons, 0–60°.
    pub hexagon_direction: Option<f64>,
}

impl From<&Orientation> for OrientationRecord {
    fn from(found: &Orientation) -> Self {
        Self {
            axes: found.nearest.n,
            resultant: found.nearest.resultant,
            direction: found.nearest.direction,
            p_value: found.nearest.p_value,
            ellipse: found.ellipse,
            hexagon_direction: found.hexagon_direction,
        }
    }
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
    /// Points per mm², if the scale is known.
    pub fn density_per_mm2(&self) -> Option<f64> {
        self.um_per_unit.map(|um| self.density * 1e6 / (um * um))
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
    /// Errors expected per cone found.
    pub fn expected_error_rate(&self) -> f64 {
        (self.expected_false_alarms + self.expected_misses) / self.n.max(1) as f64
    }
}

/// Indices of the records, those first that need the eye of a person most; equals stay in order.
pub fn by_need(records: &[ImageRecord]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..records.len()).collect();
    // where the modality or the spacing is wrong, so are the scores
    let need = |k: &usize| {
        let found = &records[*k].detection;
        found.expected_error_rate() + 1. - found.spacing_confidence * found.modality_confidence
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
    /// The cones.
    pub detection: DetectionRecord,
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
    /// Points of the file that lie outside the window and were left out.
    pub outside: usize,
    /// Their statistics.
    pub mosaic: MosaicRecord,
    /// What a reader of these numbers should know.
    pub warnings: Vec<String>,
}

impl CoordinatesRecord {
    /// A row of `regularity.csv`, in the form of Table 1 of Lanaro et al. (population deviation), and with the sample's: nearest-neighbour distances of all points.
    pub fn regularity_row(&self) -> Vec<Cell> {
        let nearest = self.mosaic.nearest;
        let [population, sample] = [Deviation::Population, Deviation::Sample]
            .map(|d| nearest.with_divisor(self.mosaic.deviation, d));
        vec![
            self.file.as_str().into(),
            self.mosaic.unit.symbol().into(),
            nearest.mean.into(),
            population.sd.into(),
            population.ri.into(),
            sample.sd.into(),
            sample.ri.into(),
            nearest.n.into(),
        ]
    }

    /// Columns of `l_infinity.csv`: the file, one column a sampler, then what helps to read them.
    pub fn distance_header(samplers: &[String]) -> Vec<String> {
        tables::L_INFINITY.header_of(samplers)
    }

    /// The row under [`Self::distance_header`].
    pub fn distance_row(&self, samplers: &[String]) -> Vec<Cell> {
        [self.file.as_str().into()]
            .into_iter()
            .chain(samplers.iter().map(|name| self.mosaic.distance_to(name).into()))
            .chain([
                self.mosaic.closest_sampler().into(),
                self.mosaic.n.into(),
                self.mosaic.nearest.ri.into(),
                self.mosaic.deviation.name().into(),
                self.warnings.join("; ").as_str().into(),
            ])
            .collect()
    }
}
