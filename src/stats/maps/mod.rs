//! Maps of a mosaic: local values around each cone, and the landmarks and profiles read from them.
//!
//! Local values are taken in a square window around each cone and interpolated between cones. The
//! density map gives the peak cone density, the cone density centroid, the isodensity area and
//! profiles.
//!
//! **Edge rule.** Voronoi cells are computed once, from all cones. Only bound cells count, that is,
//! cells strictly inside the window of the mosaic (Cooper et al. 2016,
//! <https://doi.org/10.1167/iovs.16-19072>). A bound cell counts in a local window if it lies
//! entirely inside it.
//!
//! A local window near the border may extend beyond the window of the mosaic before it contains
//! enough cells. It continues to grow, but finds further cells only on the inner side. Its values
//! are marked with [`LocalFlag::Edge`], and neither landmarks nor meridians use them.

mod ellipse;
mod grid;
mod landmarks;
mod local;
mod options;
mod profile;
mod region;
mod surface;
#[cfg(test)]
mod tests;

pub use ellipse::Ellipse;
pub use grid::MapGrid;
pub use landmarks::Landmarks;
pub use local::{LocalFlag, LocalValues};
pub use options::{LocalWindow, MapOptions};
pub use profile::{Along, ProfileRow};
pub use region::Contour;

use super::{Measures, StatsError};
use crate::mosaic::Mosaic;
use surface::Surface;

/// Local values of every cone, and the landmarks and profiles that are derived from them.
///
/// Lengths are in units of the coordinates.
#[derive(Clone, Debug)]
pub struct Maps {
    /// Options with which the maps were made.
    pub options: MapOptions,
    /// Local values, one per cone, in the order of the points.
    pub local: Vec<LocalValues>,
    /// Peak, centroid and isodensity region of the density map.
    pub landmarks: Landmarks,
    /// Density and spacing by distance from the cone density centroid; empty if there is no
    /// centroid.
    pub profile: Vec<ProfileRow>,
    /// Interpolation of values between cones.
    surface: Surface,
}

impl Maps {
    /// Returns the map of one of the local values, sampled on a square grid.
    ///
    /// `mosaic` must be the mosaic from which the maps were made, `value` selects the local value,
    /// and `longer` is the number of grid cells along the longer side of the mosaic's window.
    ///
    /// Local windows that extend beyond the mosaic's window are included. [`MapGrid::whole`] is
    /// `false` for the grid cells whose values depend on them.
    pub fn grid(
        &self,
        mosaic: &Mosaic,
        value: impl Fn(&LocalValues) -> Option<f64>,
        longer: usize,
    ) -> MapGrid {
        grid::grid(&self.surface, &mosaic.window().bounds(), &self.local, value, longer)
    }
}

/// Computes the maps of a mosaic that has been measured.
///
/// The maps are linear between cones, so their peak is at the cone of largest local density. The
/// peak density is the maximum over as many local windows as there are cones. It therefore exceeds
/// the true density at that point by about the scatter of the density in a single local window.
///
/// # Errors
/// Fails if an option is out of its range.
pub fn maps(mosaic: &Mosaic, measures: &Measures, options: &MapOptions) -> Result<Maps, StatsError> {
    options.validate()?;
    let (points, window) = (mosaic.points(), mosaic.window());
    let (cells, neighbours) = (&measures.cells, &measures.neighbours);
    let local =
        local::local_values(points, window, cells, neighbours, options.window, measures.summary.deviation);
    let surface = Surface::new(points, window);
    let map = |value: fn(&LocalValues) -> Option<f64>| -> Vec<Option<f64>> {
        local.iter().map(|v| if v.flag == LocalFlag::Whole { value(v) } else { None }).collect()
    };
    // The values of these maps at cones whose local window is cut by the border are left out.
    let charts = [map(|v| v.density), map(|v| v.inter_cell), map(|v| v.nearest)];
    let landmarks = landmarks::landmarks(points, window, &surface, &local, &charts[0], options);
    let step = options.profile_step.or_else(|| mosaic.hexagonal_spacing().map(|s| 2. * s));
    let profile = match (landmarks.centroid, step) {
        (Some(centre), Some(step)) => {
            profile::profile((points, window), (cells, neighbours), &surface, &charts, centre, step)
        }
        _ => Vec::new(),
    };
    Ok(Maps { options: *options, local, landmarks, profile, surface })
}
