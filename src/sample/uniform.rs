use super::{Frame, SampleError, Sampler};
use crate::geometry::Point;
use rand::{Rng, RngExt};

/// Independent uniform points: complete spatial randomness.
#[derive(Clone, Copy, Debug)]
pub struct Uniform;

impl Sampler for Uniform {
    fn name(&self) -> &'static str {
        "uniform"
    }

    fn about(&self) -> &'static str {
        "independent uniform points (white noise); exactly n"
    }

    fn exact(&self) -> bool {
        true
    }

    fn by_default(&self) -> bool {
        true
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        Ok((0..n)
            .map(|_| {
                let (u, v): (f64, f64) = (rng.random(), rng.random());
                frame.place(u * frame.width, v * frame.height)
            })
            .collect())
    }
}
