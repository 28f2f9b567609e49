//! Airy pattern of a clear round pupil, read from a table.
//!
//! The amplitude at distance r from the centre is 2 J₁(v) / v, with v = π D r / (λ f), the diameter
//! D of the pupil, the wavelength λ and the focal length f. J₁ is a Bessel function. Lengths here
//! are in full widths at half maximum of the intensity, so D, λ and f are not needed.

use std::f64::consts::PI;
use std::sync::OnceLock;

/// Number of samples in the table per full width at half maximum of the intensity.
///
/// Linear interpolation between them errs by less than 10⁻⁴ of the largest amplitude.
const PER_WIDTH: usize = 64;
/// Distance at which the pattern is cut off, in full widths at half maximum of the intensity.
///
/// It is v = 10.02, just inside the third dark ring at v = 10.17. The second bright ring, with 0.42
/// % of the intensity of the centre, lies within; the third one, with 0.16 %, is left out.
pub(super) const AIRY_CUT: f64 = 3.1;
/// Full width at half maximum of the intensity in units of v: twice the v at which (2 J₁(v) / v)² =
/// ½.
const WIDTH: f64 = 3.232_679;

/// Returns the amplitude of the Airy pattern, which is 1 at its centre.
///
/// `distance` is in full widths at half maximum of the intensity. The value is interpolated
/// linearly between the samples of a table; beyond [`AIRY_CUT`] it is 0.
pub(super) fn airy_amplitude(distance: f64) -> f64 {
    // made when first asked for, as every pixel of every spot reads it
    static TABLE: OnceLock<Vec<f64>> = OnceLock::new();
    let table = TABLE.get_or_init(|| {
        let count = (AIRY_CUT * PER_WIDTH as f64).ceil() as usize + 2;
        (0..count).map(|i| besinc(WIDTH * i as f64 / PER_WIDTH as f64)).collect()
    });
    let at = distance * PER_WIDTH as f64;
    match table.get(at as usize..at as usize + 2) {
        Some(&[a, b]) => a + (b - a) * at.fract(),
        _ => 0.,
    }
}

/// Computes 2 J₁(v) / v with Bessel's integral J₁(v) = ∫₀^π cos(τ − v sin τ) dτ / π.
///
/// The integrand is even and has the period 2π, so the trapezium rule over half a period is exact
/// but for terms of the order of J₁₂₇(v). With 64 steps they vanish at double precision for all v
/// in use.
fn besinc(v: f64) -> f64 {
    // far more than v ≤ 10.1 needs; the table is made only once
    const STEPS: usize = 64;
    if v < 1e-6 {
        return 1.;
    }
    let term = |k: usize| {
        let tau = PI * k as f64 / STEPS as f64;
        (tau - v * tau.sin()).cos()
    };
    let inner: f64 = (1..STEPS).map(term).sum();
    2. / v * (inner + 0.5 * (term(0) + term(STEPS))) / STEPS as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pattern_has_the_zeros_the_width_and_the_rings_of_the_textbook() {
        assert_eq!(airy_amplitude(0.), 1.);
        // first and second zero of J₁
        assert!(besinc(3.831_705_970).abs() < 1e-9 && besinc(7.015_586_670).abs() < 1e-9);
        assert!((airy_amplitude(0.5).powi(2) - 0.5).abs() < 1e-6);
        // the first ring has 1.75 % of the intensity
        assert!((besinc(5.135_622).powi(2) - 0.0175).abs() < 1e-4);
    }
}
