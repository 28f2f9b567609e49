use super::{Shaped, TargetCurve};
use crate::geometry::{Point, Window};
use crate::sample::{Configure, Frame, SampleError, Sampler, Settable, Setting, Watch};
use rand::Rng;
use std::f64::consts::FRAC_2_SQRT_PI;

/// Highest possible frequency of the step, in √n: 1/√π, with which g(0) = 1 − π f² is 0.
///
/// A higher frequency would need a negative g (Heck et al. 2013, §4).
const HIGHEST: f64 = 0.5 * FRAC_2_SQRT_PI;

/// Step blue noise: no power below a frequency, and the power of independent points above it.
///
/// The points are made by [`Shaped`] with the target g(r) = 1 − f J₁(2πfr)/r, where f is the
/// frequency of the step and J₁ a Bessel function.
///
/// Source: Heck, Schlömer and Deussen (2013), <https://doi.org/10.1145/2487228.2487233>.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Frequency of the step, in √n; at most 1/√π.
    pub frequency: f64,
}

impl Step {
    /// Setting with the step at the highest possible frequency, 1/√π √n.
    pub const HIGHEST: Self = Self { frequency: HIGHEST };

    /// Returns the sampler that moves points until the spectrum has the step.
    fn shaped(&self) -> Shaped {
        Shaped { curve: TargetCurve::below(self.frequency), nearest: None }
    }
}

impl Sampler for Step {
    fn name(&self) -> &'static str {
        "step"
    }

    fn about(&self) -> &'static str {
        "step blue noise: power 0 below a frequency and 1 above, reached by optimising the PCF; exactly n \
         (Heck et al. 2013)"
    }

    fn exact(&self) -> bool {
        true
    }

    fn settable(&self) -> Option<&dyn Configure> {
        Some(self)
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

impl Settable for Step {
    const SETTINGS: &'static [Setting<Self>] = &[Setting {
        name: "frequency",
        unit: "√n",
        range: (0.05, HIGHEST),
        whole: false,
        unset: "",
        meaning: "frequency of the step; 1/√π is the highest at which such points exist (Heck et al. 2013)",
        get: |s| Some(s.frequency),
        set: |s, v| s.frequency = v,
    }];
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
