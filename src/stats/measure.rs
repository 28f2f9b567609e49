use super::summary::Series;
use super::{
    DensityRecovery, DensityRecoveryOptions, Deviation, Histogram, Inhomogeneous, NearestNeighbours,
    Orientation, Pcf, PcfOptions, StatsError, Summary, Voronoi, density_recovery, inhomogeneous,
    nearest::interior_by, nearest_neighbours, orientation, pcf, voronoi,
};
use crate::mosaic::Mosaic;
use serde::{Deserialize, Serialize, Serializer};

/// Options for measuring a mosaic.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MeasureOptions {
    /// Divisor for the variance of nearest-neighbour distances: n − 1 (default), or n as in the
    /// tables of Lanaro et al. (2020). Statistics of Voronoi cells always use n − 1.
    pub deviation: Deviation,
    /// Options of the pair correlation function: kernel, distances and edge correction.
    pub pcf: PcfOptions,
}

/// All statistics of one mosaic: single numbers, values per point and curves.
///
/// Lengths are in the unit of the mosaic.
#[derive(Clone, Debug, Serialize)]
pub struct Measures {
    /// Every statistic that is a single number or a few numbers.
    pub summary: Summary,
    /// Nearest neighbour of every point: its index and its distance.
    pub neighbours: NearestNeighbours,
    /// Distance of every point to the border, in the unit of the coordinates; infinite on a torus.
    pub borders: Vec<f64>,
    /// Histogram of the nearest-neighbour distances of all points.
    pub histogram: Histogram,
    /// Voronoi cell of every point, in the order of the points.
    pub cells: Voronoi,
    /// Directions of nearest neighbours, anisotropy, and orientation of the hexagons.
    pub orientation: Orientation,
    /// Density recovery profile with the default options, or the reason why it cannot be computed.
    #[serde(serialize_with = "value_or_reason")]
    pub density_recovery: Result<DensityRecovery, StatsError>,
    /// Pair correlation and K functions that allow for a density that varies across the window.
    ///
    /// `None` if the trend of the density is not significant or the functions cannot be computed.
    pub inhomogeneous: Option<Inhomogeneous>,
    /// Pair correlation function, or the reason why it cannot be computed.
    #[serde(serialize_with = "value_or_reason")]
    pub pcf: Result<Pcf, StatsError>,
}

/// Serialises the value of a statistic, or `{"missing": reason}` if it could not be computed.
fn value_or_reason<T: Serialize, S: Serializer>(
    found: &Result<T, StatsError>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    match found {
        Ok(value) => value.serialize(serializer),
        Err(reason) => serializer.collect_map([("missing", reason.to_string())]),
    }
}

/// Measures all statistics of a mosaic, each with its own edge correction.
///
/// On two cores, this takes 2.5 ms for 300 points and 1.2 s for 100 000 points. Of these times,
/// orientation accounts for .02 ms and 14 ms, density recovery for .1 ms and 57 ms, and the modal
/// spacing for .6 ms and 145 ms.
pub fn measure(mosaic: &Mosaic, options: &MeasureOptions) -> Measures {
    let (points, window) = (mosaic.points(), mosaic.window());
    let neighbours = nearest_neighbours(points, window);
    let borders = window.border_distances(points);
    let interior: Vec<bool> = interior_by(&borders, &neighbours).collect();
    let cells = voronoi(points, window);
    let orientation = orientation(points, window, &neighbours, &interior, &cells);
    let density_recovery = density_recovery(points, window, &DensityRecoveryOptions::default());
    let series = Series {
        neighbours: &neighbours,
        borders: &borders,
        interior: &interior,
        cells: &cells,
        orientation: &orientation,
        recovery: density_recovery.as_ref().ok(),
    };
    let summary = Summary::of(mosaic, options.deviation, &series);
    let varies = summary.trend.significant;
    Measures {
        summary,
        histogram: Histogram::new(&neighbours.distances),
        inhomogeneous: varies.then(|| inhomogeneous(points, window, &options.pcf, None).ok()).flatten(),
        pcf: pcf(points, window, &options.pcf),
        neighbours,
        borders,
        cells,
        orientation,
        density_recovery,
    }
}
