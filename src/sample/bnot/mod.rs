//! Blue noise through optimal transport (BNOT): points at the centroids of power cells of equal
//! mass.
//!
//! The solver for the weights is in `capacity.rs`, with the linear systems in `multigrid.rs`; the
//! alternation of weights and moves is in `relaxation.rs`.

mod capacity;
mod laplacian;
mod multigrid;
mod regularity;
mod relaxation;

use super::relaxed_region::{Region, Relaxes};
use super::{Configure, Density, Frame, SampleError, Sampler, Settable, Setting, Watch};
use crate::geometry::{Point, Window};
use rand::Rng;

/// Points whose power cells have equal masses and whose positions are the centroids of the cells.
///
/// 1. Place n points at random and move each once to the centroid of its Voronoi cell.
/// 2. Find weights for which all power cells have the same mass, by damped Newton steps. The
///    relative deviation allowed is 1 % or, if that is less, the length of the last move in
///    spacings.
/// 3. Move every point to the centroid of its cell. Repeat from 2 for a number of steps, or until
///    the points rest.
/// 4. Find weights once more, for masses that are equal within 10⁻⁶.
///
/// The number of steps decides how regular the pattern is. In the unit square (all points,
/// population standard deviation; means of 5 to 60 seeds), the regularity index of 1050 points is
/// 12.6 after 3 steps, 17.8 after 9, and 22.1 after the 20 steps that reproduce the paper's tables.
/// The index of 1024 points at rest is 25.4 with a tolerance of .00285 spacings (some 61 steps),
/// and 26.3 with .001 (some 200 steps). `run` and `compare` use 20 steps.
///
/// Source: de Goes, Breeden, Ostromoukhov and Desbrun (2012),
/// <https://doi.org/10.1145/2366145.2366190>.
#[derive(Clone, Debug, PartialEq)]
pub struct Bnot {
    /// Number of times all points are moved to the centroids of their cells; `None` repeats the
    /// moves until the points rest, see `tolerance`.
    pub steps: Option<usize>,
    /// Root mean square distance between the points and the centroids of their cells at which the
    /// points count as being at rest, in hexagonal spacings.
    ///
    /// With the default, mean pair correlation functions agree with those of the independent
    /// program that the tests compare with, when that program has converged.
    pub tolerance: f64,
    /// Number of times hexagonal crystals in the pattern are broken up and the points relaxed anew,
    /// as by de Goes et al. (2012).
    ///
    /// Each time, points whose cells are too similar to the neighbouring cells are displaced at
    /// random, together with their neighbours, and 20 steps follow.
    pub breaks: usize,
    /// Relative density of the points, or `None` for an even density.
    pub density: Option<Density>,
}

impl Bnot {
    /// Default setting: steps are repeated until the points rest.
    pub const CONVERGED: Self = Self { steps: None, tolerance: 2.85e-3, breaks: 0, density: None };
    /// Setting of 20 steps, with which the published tables of cone mosaics and samplers are
    /// reproduced.
    pub const PAPER: Self = Self { steps: Some(20), ..Self::CONVERGED };
}

impl Default for Bnot {
    fn default() -> Self {
        Self::CONVERGED
    }
}

/// Largest number of steps, so that every run ends; after it, the points count as being at rest.
const MOST_STEPS: usize = 1000;

impl Sampler for Bnot {
    fn name(&self) -> &'static str {
        "bnot"
    }

    fn about(&self) -> &'static str {
        "blue noise through optimal transport: power cells of equal area, each with its point at the \
         centroid; exactly n (de Goes et al. 2012)"
    }

    fn exact(&self) -> bool {
        true
    }

    fn by_default(&self) -> bool {
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

    fn as_reference(&self) -> Option<&'static dyn Sampler> {
        Some(&Self::PAPER)
    }
}

impl Settable for Bnot {
    const SETTINGS: &'static [Setting<Self>] = &[
        Setting {
            name: "steps",
            unit: "",
            range: (0., 100_000.),
            whole: true,
            unset: "until the points rest",
            meaning: "number of moves of all points to the centroids of equal cells; 20 reproduce the published tables and are used by run and compare",
            get: |s| s.steps.map(|steps| steps as f64),
            set: |s, v| s.steps = Some(v as usize),
        },
        Setting {
            name: "tolerance",
            unit: "spacings",
            range: (1e-9, 1.),
            whole: false,
            unset: "",
            meaning: "distance to the centroids (root mean square) below which the points rest; after 1000 steps they rest in any case",
            get: |s| Some(s.tolerance),
            set: |s, v| s.tolerance = v,
        },
        Setting {
            name: "breaks",
            unit: "",
            range: (0., 100.),
            whole: true,
            unset: "",
            meaning: "number of times that hexagonal crystals are broken up, with 20 steps after each (de Goes et al. 2012)",
            get: |s| Some(s.breaks as f64),
            set: |s, v| s.breaks = v as usize,
        },
    ];
}

impl Relaxes for Bnot {
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
        let start = region.scatter(self.name(), n, rng)?;
        let (points, _) = self.relax(&start, region, rng, progress)?;
        Ok(region.place(&points))
    }
}

#[cfg(test)]
mod tests;
