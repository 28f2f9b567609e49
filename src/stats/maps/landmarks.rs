use super::ellipse::{Ellipse, fitted_ellipse};
use super::region::{Contour, region};
use super::surface::Surface;
use super::{LocalFlag, LocalValues, MapOptions};
use crate::geometry::{Point, Window};

/// Landmarks of the density map: its peak, and the region of high density around it.
///
/// Lengths are in units of the coordinates, densities per squared unit.
#[derive(Clone, Debug, Default)]
pub struct Landmarks {
    /// Number of cones whose local window lies inside the window of the mosaic; the density map is
    /// made from the values of these cones only.
    pub whole: usize,
    /// Peak cone density (PCD): the largest density in a local window that lies inside the window
    /// of the mosaic. `None` if there is no such local window.
    pub peak: Option<f64>,
    /// Position of the cone with the peak cone density, or of the first of several equal ones;
    /// `None` if there is no peak.
    pub peak_at: Option<Point>,
    /// Area of the isodensity region, in which the density map is at least
    /// [`MapOptions::isodensity`] times the peak. `None` if the region has no area, for example
    /// without a density map.
    pub isodensity_area: Option<f64>,
    /// Cone density centroid (CDC): the density-weighted centroid of the isodensity region. `None`
    /// if the region has no area.
    ///
    /// Source: Reiniger et al. (2021), <https://doi.org/10.1016/j.cub.2021.07.005>.
    pub centroid: Option<Point>,
    /// Value of the density map at the cone density centroid; `None` if the map is not defined
    /// there.
    pub centroid_density: Option<f64>,
    /// Ellipse fitted to the longest outline of the isodensity region.
    ///
    /// `None` if the longest outline is not closed or no ellipse fits it.
    pub ellipse: Option<Ellipse>,
    /// `true` if the isodensity region extends to the edge of the map and is cut off there. The
    /// area is then too small, and the centroid lies too far inwards.
    pub cut: bool,
    /// Outlines of the isodensity region, longest first.
    pub contours: Vec<Contour>,
}

/// Finds the landmarks of the density map.
///
/// `density` contains the value of the map at each cone: the local density, or `None` for cones
/// whose local window extends beyond the window of the mosaic.
pub(super) fn landmarks(
    points: &[Point],
    window: &Window,
    surface: &Surface,
    local: &[LocalValues],
    density: &[Option<f64>],
    options: &MapOptions,
) -> Landmarks {
    let whole = local.iter().filter(|v| v.flag == LocalFlag::Whole).count();
    // The first of equal maxima is taken, so that the result does not depend on the number of
    // threads.
    let peak = density.iter().enumerate().filter_map(|(k, d)| Some((k, (*d)?))).fold(
        None,
        |best: Option<(usize, f64)>, (k, d)| match best {
            Some((_, greatest)) if d <= greatest => best,
            _ => Some((k, d)),
        },
    );
    let Some((index, peak)) = peak else { return Landmarks { whole, ..Landmarks::default() } };
    let bounds = window.bounds();
    let found = region(surface, density, options.isodensity * peak, Point::new(bounds.x0(), bounds.y0()));
    let map = [density.to_vec()];
    let centroid = found.centroid;
    Landmarks {
        whole,
        peak: Some(peak),
        peak_at: Some(points[index]),
        isodensity_area: centroid.map(|_| found.area),
        centroid,
        centroid_density: centroid.and_then(|at| surface.at(at, &map)[0]),
        ellipse: found.contours.first().and_then(fitted_ellipse),
        cut: found.cut,
        contours: found.contours,
    }
}
