use super::region::{Region, Relaxes};
use super::{Density, Frame, Parameter, SampleError, Sampler, Values, Watch};
use crate::geometry::power::PowerSites;
use crate::geometry::{Point, Window};
use rand::Rng;

/// Random points, each moved to the centroid of its Voronoi cell, for a number of steps (Lloyd 1982): with many, a centroidal
/// Voronoi tessellation (Du, Faber & Gunzburger 1999).
#[derive(Clone, Debug, PartialEq)]
pub struct Lloyd {
    /// How often all points are moved.
    pub steps: usize,
    /// How dense points are to be (their density then goes with its square root, as centroidal tessellations do); evenly
    /// without.
    pub density: Option<Density>,
}

impl Lloyd {
    /// 20 steps, even density.
    pub const DEFAULT: Self = Self { steps: 20, density: None };
}

impl Default for Lloyd {
    fn default() -> Self {
        Self::DEFAULT
    }
}

static PARAMETERS: [Parameter; 1] = [Parameter {
    name: "steps",
    unit: "",
    range: (0., 1_000_000.),
    whole: true,
    default: "20",
    meaning: "moves of all points to the centroids of their Voronoi cells; 0 leaves them uniform",
}];

impl Sampler for Lloyd {
    fn name(&self) -> &'static str {
        "lloyd"
    }

    fn about(&self) -> &'static str {
        "uniform points moved to the centroids of their Voronoi cells; exactly n (Lloyd 1982)"
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

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn configure(&self, settings: &[(&str, &str)]) -> Result<Box<dyn Sampler>, SampleError> {
        let values = Values::read(self.name(), &PARAMETERS, settings)?;
        let steps = values.count("steps").unwrap_or(self.steps);
        Ok(Box::new(Self { steps, density: self.density.clone() }))
    }

    fn with_density(&self, density: &Density) -> Option<Box<dyn Sampler>> {
        Some(Box::new(Self { density: Some(density.clone()), ..self.clone() }))
    }
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
