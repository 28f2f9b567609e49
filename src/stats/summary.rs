use super::clark_evans::clark_evans;
use super::{
    ClarkEvans, DensityRecovery, Deviation, ModalSpacing, Moments, NearestNeighbours, NeighbourEllipse,
    Orientation, Trend, Voronoi, VoronoiSummary, modal_spacing, moments, trend,
};
use crate::mosaic::Mosaic;
use serde::{Deserialize, Serialize};

/// Statistics of a mosaic that are single numbers, not series.
///
/// The numbers fill one row of `summary.csv` and one record of `metrics.json`. Lengths are in the
/// unit of the mosaic.
///
/// A new statistic needs one field here and one line in `Summary::of`; records and files then
/// contain it without further changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Density in points per squared unit of the mosaic.
    pub density: f64,
    /// Hexagonal spacing: the spacing of the triangular lattice that has the density of the mosaic.
    /// `None` without points.
    pub spacing: Option<f64>,
    /// Divisor for the variances of nearest-neighbour distances: n − 1 or n.
    pub deviation: Deviation,
    /// Moments of the nearest-neighbour distances of all points.
    pub nearest: Moments,
    /// Moments of the nearest-neighbour distances of interior points.
    ///
    /// An interior point is at least as far from the border as from its nearest neighbour.
    pub nearest_interior: Moments,
    /// Moments of the nearest-neighbour distances of points whose Voronoi cell lies strictly inside
    /// the window.
    pub nearest_bound: Moments,
    /// Clark–Evans index: the mean nearest-neighbour distance divided by the mean that is expected
    /// for independent points of the same density.
    pub clark_evans: ClarkEvans,
    /// Statistics of the Voronoi cells that lie strictly inside the window.
    pub voronoi: VoronoiSummary,
    /// Effective radius and packing factor from the density recovery profile with the default
    /// options; `None` for fewer than two points.
    pub density_recovery: Option<RecoverySummary>,
    /// Directions of nearest neighbours, anisotropy, and orientation of the hexagons.
    pub orientation: OrientationSummary,
    /// First ring of the power spectrum of the points, and the spacing that belongs to it.
    ///
    /// `None` if the spectrum has no ring or cannot be computed, as in a polygon.
    pub modal: Option<ModalSpacing>,
    /// Variation of the density across the window, and its significance.
    pub trend: Trend,
}

/// Single numbers that summarise a density recovery profile; [`DensityRecovery`] defines them.
///
/// Lengths are in the unit of the mosaic.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecoverySummary {
    /// Width of the annuli, in the unit of the mosaic.
    pub bin_width: f64,
    /// Effective radius: the radius of an empty disk that lacks as many points as the profile does
    /// near distance 0. `None` if no annulus exceeds the mean density.
    pub effective_radius: Option<f64>,
    /// Packing factor, 0 for independent points and 1 for the triangular lattice; `None` if there
    /// is no effective radius.
    pub packing: Option<f64>,
    /// Rodieck's reliability factor k = D·w·√(πA), with D the mean density, w the width of the
    /// annuli and A the area of the window.
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

/// Single numbers that summarise an [`Orientation`].
///
/// Angles are in degrees, counter-clockwise from the x axis as seen in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrientationSummary {
    /// Number of interior points for which the direction to the nearest neighbour is defined.
    ///
    /// An interior point is at least as far from the border as from its nearest neighbour.
    pub axes: usize,
    /// Length of the mean of exp(2iθ), with θ the direction from an interior point to its nearest
    /// neighbour: 0 for evenly spread directions, 1 for parallel ones. `None` without directions.
    pub resultant: Option<f64>,
    /// Mean axis from interior points to their nearest neighbours, 0–180°. `None` if `resultant` is
    /// 0 or `None`.
    pub direction: Option<f64>,
    /// Probability, if no direction is preferred, of a mean of exp(2iθ) at least as long as
    /// `resultant`.
    pub p_value: Option<f64>,
    /// Ellipse with the second moments of the vectors from cells to their neighbours.
    pub ellipse: Option<NeighbourEllipse>,
    /// Common orientation of the hexagons that the neighbours form around the cells, 0–60°.
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

/// Values per point and curves from which a [`Summary`] is computed.
pub(super) struct Series<'a> {
    /// Nearest neighbour of every point.
    pub neighbours: &'a NearestNeighbours,
    /// Distance of every point to the border.
    pub borders: &'a [f64],
    /// `true` for every point that is at least as far from the border as from its nearest
    /// neighbour.
    pub interior: &'a [bool],
    /// Voronoi cell of every point.
    pub cells: &'a Voronoi,
    /// Directions and anisotropy of the pattern.
    pub orientation: &'a Orientation,
    /// Density recovery profile; `None` if it could not be computed.
    pub recovery: Option<&'a DensityRecovery>,
}

impl Summary {
    /// Computes the summary of a mosaic from its `series`.
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
