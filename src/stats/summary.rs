use super::clark_evans::clark_evans;
use super::{
    ClarkEvans, DensityRecovery, Deviation, ModalSpacing, Moments, NearestNeighbours, NeighbourEllipse,
    Orientation, Trend, Voronoi, VoronoiSummary, modal_spacing, moments, trend,
};
use crate::mosaic::Mosaic;
use serde::{Deserialize, Serialize};

/// Statistics of a mosaic that are single numbers, not series.
///
/// They fill one row of `summary.csv` and one record of `metrics.json`. Lengths are in the unit of
/// the mosaic.
///
/// A new statistic needs one field here and one line in `Summary::of`; records and files then
/// contain it without further changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Density in points per squared unit of the mosaic.
    pub density: f64,
    /// Hexagonal spacing at that density; `None` without points.
    pub spacing: Option<f64>,
    /// Divisor of the variances of nearest-neighbour distances.
    pub deviation: Deviation,
    /// Nearest-neighbour distances of all points.
    pub nearest: Moments,
    /// Nearest-neighbour distances of interior points: those at least as far from the border as
    /// from their nearest neighbour.
    pub nearest_interior: Moments,
    /// Nearest-neighbour distances of points whose Voronoi cell lies strictly inside the window.
    pub nearest_bound: Moments,
    /// Mean nearest-neighbour distance divided by that of independent points.
    pub clark_evans: ClarkEvans,
    /// Statistics of the Voronoi cells that lie strictly inside the window.
    pub voronoi: VoronoiSummary,
    /// Density recovery profile with the default options; `None` for fewer than two points.
    pub density_recovery: Option<RecoverySummary>,
    /// Directions of the nearest neighbours, and anisotropy.
    pub orientation: OrientationSummary,
    /// Ring of the points' power spectrum; `None` if the spectrum has none.
    pub modal: Option<ModalSpacing>,
    /// Variation of density across the window.
    pub trend: Trend,
}

/// Scalars of a density recovery profile, defined in [`DensityRecovery`].
///
/// Lengths are in the unit of the mosaic.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecoverySummary {
    /// Width of the annuli, in the unit of the mosaic.
    pub bin_width: f64,
    /// Effective radius; `None` if no annulus exceeds the mean density.
    pub effective_radius: Option<f64>,
    /// Packing factor, 0 for independent points and 1 for the triangular lattice; `None` without an
    /// effective radius.
    pub packing: Option<f64>,
    /// Rodieck's reliability factor k.
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

/// Scalars of an [`Orientation`].
///
/// Angles are in degrees, counter-clockwise from the x axis as seen in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrientationSummary {
    /// Number of interior points whose nearest neighbour has a direction.
    pub axes: usize,
    /// Length of the mean of exp(2iθ) over these directions θ.
    pub resultant: Option<f64>,
    /// Mean axis of these directions, 0–180°.
    pub direction: Option<f64>,
    /// Probability of a resultant at least this long if no direction is preferred.
    pub p_value: Option<f64>,
    /// Ellipse of the vectors from cells to their neighbours.
    pub ellipse: Option<NeighbourEllipse>,
    /// Common orientation of the hexagons, 0–60°.
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

/// Series from which the scalars are computed, one value per point.
pub(super) struct Series<'a> {
    /// Nearest neighbour of every point.
    pub neighbours: &'a NearestNeighbours,
    /// Distance of every point to the border.
    pub borders: &'a [f64],
    /// Flags of the points that are at least as far from the border as from their nearest
    /// neighbour.
    pub interior: &'a [bool],
    /// Voronoi cell of every point.
    pub cells: &'a Voronoi,
    /// Directions and anisotropy of the pattern.
    pub orientation: &'a Orientation,
    /// Density recovery profile, if there is one.
    pub recovery: Option<&'a DensityRecovery>,
}

impl Summary {
    /// Computes all scalars of a mosaic from its series.
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
