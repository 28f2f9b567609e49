//! What is known of one mosaic, in the form in which it is written to files.

use super::{Cell, VerdictRecord};
use crate::detect::{Detector, Modality, Polarity};
use crate::geometry::Polygon;
use crate::mosaic::LengthUnit;
use crate::stats::{ClarkEvans, Deviation, Moments, Trend, VoronoiSummary};
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
    /// Whether density varies across the window.
    pub trend: Trend,
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
    /// Points per mm², if the scale is known.
    pub fn density_per_mm2(&self) -> Option<f64> {
        self.um_per_unit.map(|um| self.density * 1e6 / (um * um))
    }

    /// Area of the window in mm², if the scale is known.
    pub fn window_area_mm2(&self) -> Option<f64> {
        self.um_per_unit.map(|um| self.window_area * um * um / 1e6)
    }

    /// The sampler of least l-infinity distance.
    pub fn closest_sampler(&self) -> Option<&str> {
        let closest = self.l_infinity.iter().min_by(|a, b| a.l_infinity.total_cmp(&b.l_infinity))?;
        Some(&closest.sampler)
    }

    fn in_um(&self, length: Option<f64>) -> Option<f64> {
        length.zip(self.um_per_unit).map(|(l, um)| l * um)
    }
}

/// What was found in one image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DetectionRecord {
    /// Filters that found the cones: classical or learned.
    pub detector: Detector,
    /// How the image was taken to be made.
    pub modality: Modality,
    /// Which way round its contrast was taken to run.
    pub polarity: Polarity,
    /// Cones found in the whole image.
    pub n: usize,
    /// Cone spacing by Yellott's ring, px.
    pub ring_spacing_px: f64,
    /// How well the ring stands out.
    pub ring_strength: f64,
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
    // where the spacing is wrong, so are the scores
    let need = |k: &usize| {
        let found = &records[*k].detection;
        found.expected_error_rate() + 1. - found.spacing_confidence
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
    /// Micrometres per degree, if a scale is known.
    pub um_per_degree: Option<f64>,
    /// The cones.
    pub detection: DetectionRecord,
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

type Column<T> = (&'static str, fn(&T) -> Cell);

const IMAGE_COLUMNS: &[Column<ImageRecord>] = &[
    ("file", |r| r.file.as_str().into()),
    ("width_px", |r| r.width_px.into()),
    ("height_px", |r| r.height_px.into()),
    ("um_per_px", |r| r.mosaic.um_per_unit.into()),
    ("modality", |r| r.detection.modality.name().into()),
    ("n", |r| r.mosaic.n.into()),
    ("density_per_px2", |r| r.mosaic.density.into()),
    ("density_per_mm2", |r| r.mosaic.density_per_mm2().into()),
    ("spacing_ring_px", |r| r.detection.ring_spacing_px.into()),
    ("spacing_density_px", |r| r.mosaic.spacing.into()),
    ("spacing_density_um", |r| r.mosaic.in_um(r.mosaic.spacing).into()),
    ("nn_mean_px", |r| r.mosaic.nearest.mean.into()),
    ("nn_sd_px", |r| r.mosaic.nearest.sd.into()),
    ("nn_mean_um", |r| r.mosaic.in_um(r.mosaic.nearest.mean).into()),
    ("nn_sd_um", |r| r.mosaic.in_um(r.mosaic.nearest.sd).into()),
];

const IMAGE_DETAILS: &[Column<ImageRecord>] = &[
    ("name", |r| r.name.as_str().into()),
    ("polarity", |r| r.detection.polarity.name().into()),
    ("detector", |r| r.detection.detector.name().into()),
    ("expected_false_alarms", |r| r.detection.expected_false_alarms.into()),
    ("expected_misses", |r| r.detection.expected_misses.into()),
    ("expected_error_rate", |r| r.detection.expected_error_rate().into()),
    ("spacing_confidence", |r| r.detection.spacing_confidence.into()),
    ("spacing_min_px", |r| r.detection.spacing_range_px[0].into()),
    ("spacing_max_px", |r| r.detection.spacing_range_px[1].into()),
    ("window_area_px2", |r| r.mosaic.window_area.into()),
    ("density_bound_per_px2", |r| r.mosaic.voronoi.density.into()),
    ("nn_bound_mean_px", |r| r.mosaic.nearest_bound.mean.into()),
    ("icd_bound_mean_px", |r| r.mosaic.voronoi.inter_cell.mean.into()),
    ("furthest_bound_mean_px", |r| r.mosaic.voronoi.furthest.mean.into()),
    ("icd_all_mean_px", |r| r.mosaic.voronoi.inter_cell_all.mean.into()),
    ("furthest_all_mean_px", |r| r.mosaic.voronoi.furthest_all.mean.into()),
    ("window_area_mm2", |r| r.mosaic.window_area_mm2().into()),
];

const COORDINATE_COLUMNS: &[Column<CoordinatesRecord>] = &[
    ("file", |r| r.file.as_str().into()),
    ("n", |r| r.mosaic.n.into()),
    ("nn_mean", |r| r.mosaic.nearest.mean.into()),
    ("nn_sd", |r| r.mosaic.nearest.sd.into()),
    ("ri", |r| r.mosaic.nearest.ri.into()),
    ("ri_interior", |r| r.mosaic.nearest_interior.ri.into()),
    ("density", |r| r.mosaic.density.into()),
    ("unit", |r| r.mosaic.unit.symbol().into()),
    ("um_per_unit", |r| r.mosaic.um_per_unit.into()),
    ("density_per_mm2", |r| r.mosaic.density_per_mm2().into()),
    ("spacing", |r| r.mosaic.spacing.into()),
    ("nn_mean_um", |r| r.mosaic.in_um(r.mosaic.nearest.mean).into()),
    ("nn_sd_um", |r| r.mosaic.in_um(r.mosaic.nearest.sd).into()),
    ("density_bound", |r| r.mosaic.voronoi.density.into()),
    ("nn_bound_mean", |r| r.mosaic.nearest_bound.mean.into()),
    ("icd_bound_mean", |r| r.mosaic.voronoi.inter_cell.mean.into()),
    ("furthest_bound_mean", |r| r.mosaic.voronoi.furthest.mean.into()),
    ("icd_all_mean", |r| r.mosaic.voronoi.inter_cell_all.mean.into()),
    ("furthest_all_mean", |r| r.mosaic.voronoi.furthest_all.mean.into()),
    ("outside_window", |r| r.outside.into()),
    ("window_area", |r| r.mosaic.window_area.into()),
    ("window_area_mm2", |r| r.mosaic.window_area_mm2().into()),
];

const REGULARITY_COLUMNS: &[Column<MosaicRecord>] =
    &[("ri", |r| r.nearest.ri.into()), ("ri_interior", |r| r.nearest_interior.ri.into())];

const ORDER_COLUMNS: &[Column<MosaicRecord>] = &[
    ("sd_kind", |r| r.deviation.name().into()),
    ("n_interior", |r| r.nearest_interior.n.into()),
    ("n_bound", |r| r.voronoi.bound.into()),
    ("six_sided_percent", |r| r.voronoi.six_sided_percent.into()),
    ("voronoi_area_cv", |r| r.voronoi.area_cv.into()),
    ("voronoi_area_ri", |r| r.voronoi.area.ri.into()),
    ("voronoi_sides_ri", |r| r.voronoi.sides.ri.into()),
    ("icd_bound_ri", |r| r.voronoi.inter_cell.ri.into()),
    ("furthest_bound_ri", |r| r.voronoi.furthest.ri.into()),
    ("psi6_mean", |r| r.voronoi.psi6_mean.into()),
    ("psi6_global", |r| r.voronoi.psi6_global.into()),
    ("clark_evans_naive", |r| r.clark_evans.naive.into()),
    ("clark_evans_donnelly", |r| r.clark_evans.donnelly.into()),
    ("clark_evans_cdf", |r| r.clark_evans.cdf.into()),
    ("density_bound_per_mm2", |r| {
        r.voronoi.density.zip(r.um_per_unit).map(|(d, um)| d * 1e6 / (um * um)).into()
    }),
    ("nn_bound_mean_um", |r| r.in_um(r.nearest_bound.mean).into()),
    ("icd_bound_mean_um", |r| r.in_um(r.voronoi.inter_cell.mean).into()),
    ("furthest_bound_mean_um", |r| r.in_um(r.voronoi.furthest.mean).into()),
    ("trend_p", |r| r.trend.p_value.into()),
    ("density_variation", |r| r.trend.variation.into()),
    ("density_variation_low", |r| r.trend.variation_interval.map(|i| i.0).into()),
    ("density_variation_high", |r| r.trend.variation_interval.map(|i| i.1).into()),
    ("density_ratio", |r| r.trend.density_ratio.into()),
];

fn sampler_columns(samplers: &[String]) -> impl Iterator<Item = String> {
    samplers.iter().map(|s| format!("l_infinity_{}", s.replace('-', "_")))
}

fn sampler_cells<'a>(record: &'a MosaicRecord, samplers: &'a [String]) -> impl Iterator<Item = Cell> + 'a {
    samplers
        .iter()
        .map(|name| record.l_infinity.iter().find(|d| d.sampler == *name).map(|d| d.l_infinity).into())
}

fn names<T>(columns: &[Column<T>]) -> impl Iterator<Item = String> {
    columns.iter().map(|(name, _)| (*name).to_owned())
}

fn cells<'a, T>(columns: &'static [Column<T>], record: &'a T) -> impl Iterator<Item = Cell> + 'a {
    columns.iter().map(move |(_, value)| value(record))
}

impl ImageRecord {
    /// Columns of `summary.csv` for runs that compare with these samplers.
    pub fn header(samplers: &[String]) -> Vec<String> {
        names(IMAGE_COLUMNS)
            .chain(names(REGULARITY_COLUMNS))
            .chain(sampler_columns(samplers))
            .chain(["closest_sampler", "warnings"].map(str::to_owned))
            .chain(names(IMAGE_DETAILS))
            .chain(names(ORDER_COLUMNS))
            .collect()
    }

    /// The row under [`Self::header`].
    pub fn row(&self, samplers: &[String]) -> Vec<Cell> {
        cells(IMAGE_COLUMNS, self)
            .chain(cells(REGULARITY_COLUMNS, &self.mosaic))
            .chain(sampler_cells(&self.mosaic, samplers))
            .chain([self.mosaic.closest_sampler().into(), self.warnings.join("; ").as_str().into()])
            .chain(cells(IMAGE_DETAILS, self))
            .chain(cells(ORDER_COLUMNS, &self.mosaic))
            .collect()
    }
}

impl CoordinatesRecord {
    /// Columns of the `summary.csv` of `measure`.
    pub fn header() -> Vec<String> {
        names(COORDINATE_COLUMNS).chain(names(ORDER_COLUMNS)).chain(["warnings".to_owned()]).collect()
    }

    /// The row under [`Self::header`].
    pub fn row(&self) -> Vec<Cell> {
        cells(COORDINATE_COLUMNS, self)
            .chain(cells(ORDER_COLUMNS, &self.mosaic))
            .chain([self.warnings.join("; ").as_str().into()])
            .collect()
    }

    /// Columns of `regularity.csv`, in the form of Table 1 of Lanaro et al. (population deviation), and with the sample's.
    pub fn regularity_header() -> Vec<String> {
        ["file", "unit", "nn_mean", "nn_sd_population", "ri_population", "nn_sd_sample", "ri_sample", "n"]
            .map(str::to_owned)
            .into()
    }

    /// The row under [`Self::regularity_header`]: nearest-neighbour distances of all points.
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
        ["file".to_owned()]
            .into_iter()
            .chain(samplers.iter().cloned())
            .chain(["closest_sampler", "n", "ri", "sd_kind", "warnings"].map(str::to_owned))
            .collect()
    }

    /// The row under [`Self::distance_header`].
    pub fn distance_row(&self, samplers: &[String]) -> Vec<Cell> {
        [self.file.as_str().into()]
            .into_iter()
            .chain(sampler_cells(&self.mosaic, samplers))
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
