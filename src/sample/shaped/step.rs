use super::{Shaped, TargetCurve};
use crate::geometry::{Point, Window};
use crate::sample::{Frame, Parameter, SampleError, Sampler, Values, Watch};
use rand::Rng;
use std::f64::consts::FRAC_2_SQRT_PI;

/// The highest frequency, in √n, at which g stays above 0 is 1/√π: there g(0) = 1 − π f² = 0 (Heck et al. 2013, §4).
const HIGHEST: f64 = 0.5 * FRAC_2_SQRT_PI;

/// Step blue noise (Heck et al. 2013): no power below a frequency, that of independent points above; [`Shaped`] towards
/// g(r) = 1 − f J₁(2πfr)/r.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Where the step is, in √n: at most 1/√π.
    pub frequency: f64,
}

impl Step {
    /// The step at 1/√π √n, the highest there can be.
    pub const HIGHEST: Self = Self { frequency: HIGHEST };

    fn shaped(&self) -> Shaped {
        Shaped { curve: TargetCurve::below(self.frequency), nearest: None }
    }
}

impl Sampler for Step {
    fn name(&self) -> &'static str {
        "step"
    }

    /// A test of theory rather than a model of cones: its curve is next to dart throwing's.
    fn by_default(&self) -> bool {
        false
    }

    fn about(&self) -> &'static str {
        "step blue noise: power 0 below a frequency, 1 above, by optimisation of the PCF (Heck et al. 2013); exactly n"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "frequency",
            unit: "√n",
            range: (0.05, HIGHEST),
            whole: false,
            default: "0.5642, 1/√π",
            meaning: "where the step is; 1/√π is the highest at which such points exist (Heck et al. 2013)",
        }]
    }

    fn configure(&self, settings: &[(&str, &str)]) -> Result<Box<dyn Sampler>, SampleError> {
        let values = Values::read(self.name(), self.parameters(), settings)?;
        Ok(Box::new(Self { frequency: values.get("frequency").unwrap_or(self.frequency) }))
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        self.shaped().fill(n, frame, rng)
    }

    fn sample_watched(
        &self,
        n: usize,
        window: &Window,
        rng: &mut dyn Rng,
        progress: &mut Watch<'_>,
    ) -> Result<Vec<Point>, SampleError> {
        self.shaped().sample_watched(n, window, rng, progress)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::{SpectrumOptions, spectrum};
    use rand::SeedableRng;

    #[test]
    fn power_steps_where_it_is_told_to() {
        let window = Window::unit_torus();
        for frequency in ["0.3", "0.5"] {
            let step = Step::HIGHEST.configure(&[("frequency", frequency)]).unwrap();
            let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
            let points = step.sample(900, &window, &mut rng).unwrap();
            let power = spectrum(&points, &window, &SpectrumOptions { max_frequency: 2. }).unwrap();
            let at: f64 = frequency.parse().unwrap();
            for (f, p) in power.frequency.iter().zip(&power.power) {
                let far = (f - at).abs() > 0.1;
                assert!(!far || (*f < at && *p < 0.1) || (*f > at && *p > 0.6), "step at {at}: {p} at {f}");
            }
        }
        assert!(Step::HIGHEST.configure(&[("frequency", "0.6")]).is_err());
    }
}
