use super::clark_evans::clark_evans;
use super::{
    ClarkEvans, DensityRecovery, Deviation, ModalSpacing, Moments, NearestNeighbours, NeighbourEllipse,
    Orientation, Trend, Voronoi, VoronoiSummary, modal_spacing, moments, trend,
};
use crate::mosaic::Mosaic;
use serde::{Deserialize, Serialize};

/// Statistics of a mosaic that are single numbers, not series.
///
/// All of them are written to `metrics.json`; `summary.csv` has a column for each that is declared
/// with `metric(…)` in `report/metrics`. Lengths are in the unit of the mosaic.
///
/// To add a statistic, add a field here and a line in `Summary::of`; it is then part of
/// `metrics.json`. A column of `summary.csv` also needs a `metric(…)` in `report/metrics`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Density: number of points divided by the area of the window, per squared unit of the mosaic.
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
    /// Effective radius, packing factor and reliability from the density recovery profile with the
    /// default options; `None` for fewer than two points.
    pub density_recovery: Option<RecoverySummary>,
    /// Directions of nearest neighbours, anisotropy, and orientation of the hexagons.
    pub orientation: OrientationSummary,
    /// First ring of the power spectrum of the points, and the spacing of the triangular lattice
    /// that has the same ring.
    ///
    /// `None` for fewer than 20 points, in a polygon, or if the spectrum has no ring.
    pub modal: Option<ModalSpacing>,
    /// Variation of the density across the window, and its significance.
    pub trend: Trend,
}

/// Single numbers that summarise a density recovery profile, which is the density around the
/// average point as a function of distance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecoverySummary {
    /// Width of the annuli in which the profile is computed, in the unit of the mosaic.
    pub bin_width: f64,
    /// Effective radius: the radius of an empty disk that lacks as many points as the dip of the
    /// profile near distance 0, in the unit of the mosaic.
    ///
    /// Points are counted as missing, compared with the mean density, up to the first annulus that
    /// exceeds it. `None` if no annulus does.
    pub effective_radius: Option<f64>,
    /// Packing factor, 0 for independent points and 1 for the triangular lattice; `None` if there
    /// is no effective radius.
    pub packing: Option<f64>,
    /// Rodieck's reliability factor k = D·w·√(πA), with D the mean density, w the width of the
    /// annuli and A the area of the window.
    ///
    /// For independent points, the first annuli around all points together contain k² other points
    /// on average.
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
/// Angles are in degrees, counter-clockwise from the positive x axis as seen in the picture. This
/// sense is opposite to that of [`Ellipse::degrees`](super::Ellipse::degrees), which is used in
/// maps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrientationSummary {
    /// Number of interior points for which the direction to the nearest neighbour is defined.
    ///
    /// An interior point is at least as far from the border as from its nearest neighbour.
    pub axes: usize,
    /// Length of the mean of exp(2iθ), with θ the direction from an interior point to its nearest
    /// neighbour: 0 for evenly spread directions, 1 for parallel ones. `None` if `axes` is 0.
    pub resultant: Option<f64>,
    /// Mean axis from interior points to their nearest neighbours, 0–180°. `None` if `resultant` is
    /// 0 or `None`.
    pub direction: Option<f64>,
    /// Probability, if no direction is preferred, of a mean of exp(2iθ) at least as long as
    /// `resultant`, by Rayleigh's test.
    ///
    /// Points linked through nearest neighbours count as one group. `None` for fewer than 10
    /// groups. In a regular mosaic, the p-value is too often small
    /// ([`super::NearestAxes::p_value`]).
    pub p_value: Option<f64>,
    /// Ellipse that describes the vectors from cells to their neighbours; it is elongated in the
    /// direction in which the mosaic is stretched.
    ///
    /// `None` if no Voronoi cell lies strictly inside the window.
    pub ellipse: Option<NeighbourEllipse>,
    /// Orientation of the mean ψ6 over the Voronoi cells strictly inside the window, 0–60°: the
    /// common orientation of the hexagons that neighbours form.
    ///
    /// In a triangular lattice it is the direction of a neighbour. `None` if the mean of ψ6 is 0 or
    /// there is no such cell.
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

/// Values per point and curves of one mosaic, from which its [`Summary`] is computed.
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
    /// Directions of nearest neighbours, anisotropy, and orientation of the hexagons.
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
