use super::shaped::{Shaped, TargetCurve};
use super::{Frame, SampleError, Sampler};
use crate::geometry::{Point, Window};
use rand::Rng;
use std::f64::consts::FRAC_2_SQRT_PI;
use std::sync::LazyLock;

/// Frequency of the step in √n. The highest at which g stays above 0 is 1/√π: there g(0) = 1 − π f² = 0 (Heck et al. 2013, §4).
const FREQUENCY: f64 = 0.5 * FRAC_2_SQRT_PI;

static SHAPED: LazyLock<Shaped> =
    LazyLock::new(|| Shaped { curve: TargetCurve::below(FREQUENCY), nearest: None });

/// Step blue noise (Heck et al. 2013): no power below 1/√π √n, that of independent points above; [`Shaped`] towards
/// g(r) = 1 − f J₁(2πfr)/r.
#[derive(Clone, Copy, Debug)]
pub struct Step;

impl Sampler for Step {
    fn name(&self) -> &'static str {
        "step"
    }

    fn about(&self) -> &'static str {
        "step blue noise: power 0 below 0.564 √n, 1 above, by optimisation of the PCF (Heck et al. 2013); exactly n"
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        SHAPED.fill(n, frame, rng)
    }

    fn sample(&self, n: usize, window: &Window, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        SHAPED.sample(n, window, rng)
    }
}
