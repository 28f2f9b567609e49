use super::Shaped;
use crate::geometry::{Point, Window};
use crate::sample::{Frame, SampleError, Sampler, Watch};
use rand::Rng;
use std::sync::LazyLock;

/// Noise with a known pair correlation function and spectrum, made by [`Shaped`] but listed under
/// its own name.
#[derive(Debug)]
pub struct Noise {
    /// Name that users type, see [`Sampler::name`].
    pub(in crate::sample) name: &'static str,
    /// One line about the pattern, see [`Sampler::about`].
    pub(in crate::sample) about: &'static str,
    /// Sampler with the pair correlation function and spectrum, created on first use.
    pub(in crate::sample) shaped: &'static LazyLock<Shaped>,
}

impl Sampler for Noise {
    fn name(&self) -> &'static str {
        self.name
    }

    fn about(&self) -> &'static str {
        self.about
    }

    fn exact(&self) -> bool {
        true
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        self.shaped.fill(n, frame, rng)
    }

    fn sample_watched(
        &self,
        n: usize,
        window: &Window,
        rng: &mut dyn Rng,
        progress: &mut Watch<'_>,
    ) -> Result<Vec<Point>, SampleError> {
        self.shaped.sample_watched(n, window, rng, progress)
    }
}
