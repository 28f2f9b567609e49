use super::clark_evans::clark_evans;
use super::{
    ClarkEvans, DensityRecovery, Deviation, ModalSpacing, Moments, NearestNeighbours, NeighbourEllipse,
    Orientation, Trend, Voronoi, VoronoiSummary, modal_spacing, moments, trend,
};
use crate::mosaic::Mosaic;
use serde::{Deserialize, Serialize};

/// Every statistic of a mosaic that is one number or a few, not a series: what a row of `summary.csv`
/// and `metrics.json` hold. Lengths are in the unit of the mosaic.
///
/// A new statistic is a field here and a line in `Summary::of`; records and files take it over.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Points per squared unit.
    pub density: f64,
    /// Hexagonal spacing of that density; `None` without points.
    pub spacing: Option<f64>,
    /// Divisor of the variances of nearest-neighbour distances.
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
    /// Density recovery profile with the default options; `None` for fewer than two points.
    pub density_recovery: Option<RecoverySummary>,
    /// Directions of neighbours.
    pub orientation: OrientationSummary,
    /// Ring of the power spectrum of the points; `None` where it has none.
    pub modal: Option<ModalSpacing>,
    /// Variation of density across the window.
    pub trend: Trend,
}

/// Scalars of a density recovery profile, see [`DensityRecovery`]. Lengths in the unit of the mosaic.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecoverySummary {
    /// Width of the annuli.
    pub bin_width: f64,
    /// Effective radius.
    pub effective_radius: Option<f64>,
    /// Packing factor.
    pub packing: Option<f64>,
    /// Reliability factor.
    pub reliability: f64,
}

impl From<&DensityRecovery> for RecoverySummary {
    fn from(profile: &DensityRecovery) -> Self {
        Self {
            bin_width: profile.bin_width,
            effective_radius: profile.effective_radius,
            packing: profile.packing,
            reliability: profile.reliability,
        }
    }
}

/// Scalars of an [`Orientation`]: angles in degrees, counter-clockwise from the x axis as the picture is
/// seen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrientationSummary {
    /// Interior points whose nearest neighbour has a direction.
    pub axes: usize,
    /// Length of the mean of exp(2iθ) of these directions.
    pub resultant: Option<f64>,
    /// Their mean axis, 0–180°.
    pub direction: Option<f64>,
    /// Chance of such a resultant where all directions are alike.
    pub p_value: Option<f64>,
    /// Ellipse of the vectors to the neighbours.
    pub ellipse: Option<NeighbourEllipse>,
    /// Orientation of the hexagons, 0–60°.
    pub hexagon_direction: Option<f64>,
}

impl From<&Orientation> for OrientationSummary {
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

/// The series that scalars are taken from, one value per point.
pub(super) struct Series<'a> {
    pub neighbours: &'a NearestNeighbours,
    /// Distance of every point to the border.
    pub borders: &'a [f64],
    /// Points at least as far from the border as from their nearest neighbour.
    pub interior: &'a [bool],
    pub cells: &'a Voronoi,
    pub orientation: &'a Orientation,
    pub recovery: Option<&'a DensityRecovery>,
}

impl Summary {
    /// Takes all scalars of a mosaic from its series.
    pub(super) fn of(mosaic: &Mosaic, deviation: Deviation, series: &Series) -> Self {
        let (points, window) = (mosaic.points(), mosaic.window());
        let distances = &series.neighbours.distances;
        let nearest_of = |kept: &mut dyn Iterator<Item = bool>| {
            let chosen: Vec<f64> = kept.zip(distances).filter_map(|(keep, &d)| keep.then_some(d)).collect();
            moments(&chosen, deviation)
        };
        Self {
            density: mosaic.density(),
            spacing: mosaic.hexagonal_spacing(),
            deviation,
            nearest: moments(distances, deviation),
            nearest_interior: nearest_of(&mut series.interior.iter().copied()),
            nearest_bound: nearest_of(&mut series.cells.cells.iter().map(|cell| cell.bound)),
            clark_evans: clark_evans(window, series.neighbours, series.borders),
            voronoi: series.cells.summary(),
            density_recovery: series.recovery.map(RecoverySummary::from),
            orientation: series.orientation.into(),
            modal: modal_spacing(points, window).ok().flatten(),
            trend: trend(points, window),
        }
    }
}
