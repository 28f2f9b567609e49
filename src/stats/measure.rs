use super::{
    ClarkEvans, DensityRecovery, DensityRecoveryOptions, Deviation, Histogram, Inhomogeneous, ModalSpacing,
    Moments, NearestNeighbours, Orientation, Pcf, PcfOptions, StatsError, Trend, Voronoi, VoronoiSummary,
    clark_evans::clark_evans, density_recovery, inhomogeneous, modal_spacing, moments, nearest::interior_by,
    nearest_neighbours, orientation, pcf, trend, voronoi,
};
use crate::mosaic::Mosaic;
use serde::{Deserialize, Serialize};

/// How a mosaic is measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MeasureOptions {
    /// Divisor of variances: n − 1 (default), or n for the tables of Lanaro et al.
    pub deviation: Deviation,
    /// Kernel, grid and edge correction of the pair correlation function.
    pub pcf: PcfOptions,
}

/// The statistics of one mosaic. Lengths are in the mosaic's unit.
#[derive(Clone, Debug)]
pub struct Measures {
    /// Divisor of all variances here.
    pub deviation: Deviation,
    /// Nearest neighbour of every point.
    pub neighbours: NearestNeighbours,
    /// Distance of every point to the border, in the unit of the coordinates; infinite on a torus.
    pub borders: Vec<f64>,
    /// Distances to the nearest neighbours: all points.
    pub nearest: Moments,
    /// Points whose distance to the border is at least that to their nearest neighbour.
    pub nearest_interior: Moments,
    /// Points whose Voronoi cell is bound.
    pub nearest_bound: Moments,
    /// Mean nearest-neighbour distance over that of independent points.
    pub clark_evans: ClarkEvans,
    /// Histogram of the nearest-neighbour distances of all points.
    pub histogram: Histogram,
    /// The Voronoi cell of every point.
    pub cells: Voronoi,
    /// Voronoi cells strictly inside the window.
    pub voronoi: VoronoiSummary,
    /// Directions of nearest neighbours and anisotropy.
    pub orientation: Orientation,
    /// Density recovery profile with the default options, or why there is none.
    pub density_recovery: Result<DensityRecovery, StatsError>,
    /// Ring of the power spectrum: none where it has none, or why there is no spectrum.
    pub modal: Result<Option<ModalSpacing>, StatsError>,
    /// Whether density varies across the window.
    pub trend: Trend,
    /// Where the trend is significant: second-order functions that allow for it.
    pub inhomogeneous: Option<Inhomogeneous>,
    /// Pair correlation function, or why there is none.
    pub pcf: Result<Pcf, StatsError>,
}

/// All statistics of a mosaic, each with its own edge rule. 2.5 ms for 300 points, 1.2 s for 100 000 on two cores, of which orientation
/// takes .02 ms and 14 ms, density recovery .1 ms and 57 ms, the modal spacing .6 ms and 145 ms.
pub fn measure(mosaic: &Mosaic, options: &MeasureOptions) -> Measures {
    let (points, window) = (mosaic.points(), mosaic.window());
    let neighbours = nearest_neighbours(points, window);
    let nearest_of = |kept: &mut dyn Iterator<Item = bool>| {
        let distances: Vec<f64> =
            kept.zip(&neighbours.distances).filter_map(|(keep, &d)| keep.then_some(d)).collect();
        moments(&distances, options.deviation)
    };
    let borders = window.border_distances(points);
    let interior: Vec<bool> = interior_by(&borders, &neighbours).collect();
    let nearest_interior = nearest_of(&mut interior.iter().copied());
    let trend = trend(points, window);
    let cells = voronoi(points, window);
    let nearest_bound = nearest_of(&mut cells.cells.iter().map(|cell| cell.bound));
    Measures {
        deviation: options.deviation,
        nearest: moments(&neighbours.distances, options.deviation),
        nearest_interior,
        histogram: Histogram::new(&neighbours.distances),
        nearest_bound,
        clark_evans: clark_evans(window, &neighbours, &borders),
        voronoi: cells.summary(),
        orientation: orientation(points, window, &neighbours, &interior, &cells),
        density_recovery: density_recovery(points, window, &DensityRecoveryOptions::default()),
        modal: modal_spacing(points, window),
        cells,
        inhomogeneous: trend
            .significant
            .then(|| inhomogeneous(points, window, &options.pcf, None).ok())
            .flatten(),
        trend,
        pcf: pcf(points, window, &options.pcf),
        neighbours,
        borders,
    }
}
