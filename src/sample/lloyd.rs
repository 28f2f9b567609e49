//! Lloyd's relaxation: random points become more regular as they move to the centroids of their
//! cells.

use super::relaxed_region::{Region, Relaxes};
use super::{Configure, Density, Frame, SampleError, Sampler, Settable, Setting, Watch};
use crate::geometry::power::PowerSites;
use crate::geometry::{Point, Window};
use rand::Rng;

/// Random points, each moved to the centroid of its Voronoi cell, for a number of steps.
///
/// With many steps the result is a centroidal Voronoi tessellation. Distances between neighbours
/// become equal within a few steps. Variations of density across the window, which come from the
/// random start, vanish only after about 3n steps.
///
/// Sources: Lloyd (1982), <https://doi.org/10.1109/TIT.1982.1056489>; Du, Faber and Gunzburger
/// (1999), <https://doi.org/10.1137/S0036144599352836>.
#[derive(Clone, Debug, PartialEq)]
pub struct Lloyd {
    /// Number of times that all points are moved to the centroids of their Voronoi cells.
    pub steps: usize,
    /// Relative density that weights the centroids, or `None` for an even density.
    ///
    /// The density of the points becomes proportional to the square root of this density, as in
    /// centroidal tessellations in the plane.
    pub density: Option<Density>,
}

impl Lloyd {
    /// Default setting: 20 steps, even density.
    pub const DEFAULT: Self = Self { steps: 20, density: None };
}

impl Default for Lloyd {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Sampler for Lloyd {
    fn name(&self) -> &'static str {
        "lloyd"
    }

    fn about(&self) -> &'static str {
        "uniform points moved to the centroids of their Voronoi cells; exactly n (Lloyd 1982)"
    }

    fn exact(&self) -> bool {
        true
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        self.fill_watched(n, frame, rng, &mut |_, _| ())
    }

    fn fill_watched(
        &self,
        n: usize,
        frame: &Frame,
        rng: &mut dyn Rng,
        progress: &mut Watch<'_>,
    ) -> Result<Vec<Point>, SampleError> {
        self.relax_in(n, &Region::new(frame, self.density.as_ref()), rng, progress)
    }

    fn sample_watched(
        &self,
        n: usize,
        window: &Window,
        rng: &mut dyn Rng,
        progress: &mut Watch<'_>,
    ) -> Result<Vec<Point>, SampleError> {
        self.relax_window(n, window, rng, progress)
    }

    fn settable(&self) -> Option<&dyn Configure> {
        Some(self)
    }

    fn with_density(&self, density: &Density) -> Option<Box<dyn Sampler>> {
        Some(Box::new(Self { density: Some(density.clone()), ..self.clone() }))
    }
}

impl Settable for Lloyd {
    const SETTINGS: &'static [Setting<Self>] = &[Setting {
        name: "steps",
        unit: "",
        range: (0., 1_000_000.),
        whole: true,
        unset: "",
        meaning: "number of moves of all points to the centroids of their Voronoi cells; 0 leaves them uniform",
        get: |s| Some(s.steps as f64),
        set: |s, v| s.steps = v as usize,
    }];
}

impl Relaxes for Lloyd {
    fn density(&self) -> Option<&Density> {
        self.density.as_ref()
    }

    fn relax_in(
        &self,
        n: usize,
        region: &Region,
        rng: &mut dyn Rng,
        progress: &mut Watch<'_>,
    ) -> Result<Vec<Point>, SampleError> {
        let mut points = region.scatter(self.name(), n, rng)?;
        let weights = vec![0.; n];
        let mut before = None;
        for step in 0..self.steps {
            progress(step, self.steps);
            let mut sites = PowerSites::new(&region.domain, region.density.as_ref(), &points);
            let diagram = sites.diagram(&weights, before.as_ref());
            points = diagram.cells().iter().map(|cell| cell.centroid).collect();
            before = Some(diagram);
        }
        progress(self.steps, self.steps);
        Ok(region.place(&points))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::{Deviation, moments, nearest_neighbours, voronoi};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn pattern(steps: usize, seed: u64) -> Vec<Point> {
        let lloyd = Lloyd { steps, ..Lloyd::DEFAULT };
        lloyd.sample(500, &Window::unit_torus(), &mut ChaCha8Rng::seed_from_u64(seed)).unwrap()
    }

    #[test]
    fn no_step_leaves_uniform_points_and_every_step_makes_them_more_regular() {
        let index = |steps| {
            let ri = |seed| {
                let distances = nearest_neighbours(&pattern(steps, seed), &Window::unit_torus()).distances;
                moments(&distances, Deviation::Sample).ri.unwrap()
            };
            (0..6).map(ri).sum::<f64>() / 6.
        };
        let indexes = [0, 1, 5, 30].map(index);
        assert!((indexes[0] - 1.91).abs() < 0.1, "{indexes:?}");
        assert!(indexes.is_sorted() && indexes[3] > 8., "{indexes:?}");
    }

    #[test]
    fn a_step_moves_each_point_to_the_centroid_of_its_cell() {
        // after many steps, the cells of points near rest are nearly all six-sided
        let six = |steps| voronoi(&pattern(steps, 3), &Window::unit_torus()).summary().six_sided_percent;
        assert!(six(300).unwrap() > 70. && six(0).unwrap() < 35., "{:?} {:?}", six(300), six(0));
    }

    #[test]
    fn points_crowd_where_the_density_is() {
        let density = Density::from_fn(50, 50, |x, _| if x < 0.5 { 8. } else { 1. }).unwrap();
        let lloyd = Lloyd { density: Some(density), ..Lloyd::DEFAULT };
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let points = lloyd.sample(800, &Window::unit_square(), &mut rng).unwrap();
        let dense = points.iter().filter(|p| p.x < 0.5).count();
        assert!((550..=720).contains(&dense), "{dense}");
    }
}
