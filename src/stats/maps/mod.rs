//! Maps of a mosaic: what a square window around each cone holds, interpolated between cones, and what is read off them: peak
//! cone density, cone density centroid, isodensity area, profiles.
//!
//! **Edge rule.** The cells are those of the whole mosaic, of which only bound ones count (Cooper et al. 2016); a cell
//! counts in a window if all of it lies strictly inside. A window that reaches beyond the mosaic's own before it holds its
//! cells goes on growing within the mosaic, so that its cells lie to one side; it is flagged, and neither the maps' landmarks
//! nor the meridians use it.

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

/// Local values of every cone and what follows from them. Lengths are in units of the coordinates.
#[derive(Clone, Debug)]
pub struct Maps {
    /// How they were made.
    pub options: MapOptions,
    /// One a cone, in the order of the points.
    pub local: Vec<LocalValues>,
    /// Peak, centroid and isodensity region of the density map.
    pub landmarks: Landmarks,
    /// Density and spacing by distance from the cone density centroid; empty without one.
    pub profile: Vec<ProfileRow>,
    surface: Surface,
}

impl Maps {
    /// A map of any of the local values, as a grid of `longer` cells along the longer side of the window. Values of windows
    /// that reach beyond the mosaic's are there, and marked as not whole.
    pub fn grid(
        &self,
        mosaic: &Mosaic,
        value: impl Fn(&LocalValues) -> Option<f64>,
        longer: usize,
    ) -> MapGrid {
        grid::grid(&self.surface, &mosaic.window().bounds(), &self.local, value, longer)
    }
}

/// Maps of a mosaic that has been measured.
///
/// The maps are linear between cones, so that their peak is the cone of greatest local density: a maximum over as many
/// windows as cones, which lies above the density at the place it is found at by about the scatter of one window.
///
/// # Errors
/// If an option is out of its range.
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
