//! Target curves: pair correlation functions that a pattern is to get, made from a measured
//! function or from a spectrum.
//!
//! - A measured function was smoothed by a kernel. The smoothing is undone by van Cittert's
//!   iteration.
//! - A spectrum is converted to a pair correlation function by the Hankel transform.
//!
//! Sources: van Cittert (1931), <https://doi.org/10.1007/BF01391351>; Heck, Schlömer and Deussen
//! (2013), <https://doi.org/10.1145/2487228.2487233>.

use super::super::SampleError;
use std::f64::consts::{PI, TAU};

/// Distance between successive samples of g, in hexagonal spacings.
const STEP: f64 = 0.02;
/// Longest distance at which pairs are controlled, in hexagonal spacings; the numbers of more
/// distant pairs are left to chance.
pub(super) const REACH: f64 = 6.;
/// Range of distances, in spacings, over which a target from tables changes from the measured pair
/// correlation function to the function that follows from the spectrum.
const BLEND: [f64; 2] = [2., 2.4];
/// Standard deviation of the Gaussian kernel by which measured functions were smoothed, in
/// spacings: the default of [`crate::stats::PcfOptions`].
const SIGMA: f64 = 0.1;
/// Number of rounds of deconvolution.
///
/// After five rounds, the result smoothed again is within .03 of a measured hard core; more rounds
/// would amplify noise.
const ROUNDS: usize = 5;
/// Smallest distance, in spacings, at which a measured curve may end: a shorter curve says nothing
/// about a pattern.
const SHORTEST: f64 = 1.;

/// Pair correlation function g(r) that a pattern is to get.
///
/// r is in hexagonal spacings √(2/(√3 λ)), where λ is the density of the points.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetCurve {
    /// Samples of g, without smoothing, at multiples of [`STEP`].
    g: Vec<f64>,
    /// Rows of frequency, in √λ, and power, or `None` if the spectrum is not known.
    ///
    /// The power is constant below the first row and 1 above the last.
    spectrum: Option<Vec<[f64; 2]>>,
}

impl TargetCurve {
    /// Creates a target from a measured pair correlation function; `rows` are pairs of r and g.
    ///
    /// r is in hexagonal spacings and rises from row to row. g is smoothed as by
    /// [`crate::stats::pcf`] with its default kernel. Below the first r, g is constant; above the
    /// last r, or above 6 spacings, g is left to chance. A kernel k smooths g to Ĝ(r) = ∫ d g(d)
    /// k(r − d) dd / r. This is undone by the iteration of van Cittert (1931),
    /// <https://doi.org/10.1007/BF01391351>.
    ///
    /// # Errors
    /// Fails if there are fewer than two rows, r does not rise, begins below 0 or ends below 1, or
    /// g is negative or not finite.
    pub fn from_pcf(rows: &[[f64; 2]]) -> Result<Self, SampleError> {
        check(rows, "a target pair correlation function", "r", "g", SHORTEST)?;
        let last = rows[rows.len() - 1][0].min(REACH);
        let measured = |r: f64| interpolate(rows, r);
        Ok(Self { g: sharpened(&measured, rows[0][0], last, last), spectrum: None })
    }

    /// Creates a target from a power spectrum; `rows` are pairs of frequency f and power S(f).
    ///
    /// f is in units of √λ, which is √n for n points in a unit square, and rises from row to row. S
    /// is the power of the periodogram |Σ exp(−2πi k·x)|²/n. Below the first f, S is constant;
    /// above the last it is 1, as for independent points.
    ///
    /// g(r) = 1 + 2π ∫ (S(f) − 1) J₀(2πfr) f df with λ = 1, a Hankel transform (Heck et al. 2013,
    /// eq. 3, <https://doi.org/10.1145/2487228.2487233>). If no point process has that spectrum, g
    /// comes out negative in places and is set to 0 there.
    ///
    /// # Errors
    /// Fails if there are fewer than two rows, f does not rise or begins below 0, or S is negative
    /// or not finite.
    pub fn from_spectrum(rows: &[[f64; 2]]) -> Result<Self, SampleError> {
        check(rows, "a target spectrum", "frequency", "power", f64::MIN_POSITIVE)?;
        Ok(Self { g: transformed(rows), spectrum: Some(rows.to_vec()) })
    }

    /// Creates the target of step blue noise: power 0 below `frequency` (in √λ) and 1 above.
    ///
    /// g(r) = 1 − f J₁(2πfr)/r (Heck et al. 2013, eq. 8,
    /// <https://doi.org/10.1145/2487228.2487233>).
    pub(in super::super) fn below(frequency: f64) -> Self {
        let g = |i: usize| {
            let r = i as f64 * STEP * unit();
            // J₁(x) ≈ x/2 at 0
            let drop = if i == 0 {
                PI * frequency * frequency
            } else {
                frequency * libm::j1(TAU * frequency * r) / r
            };
            (1. - drop).max(0.)
        };
        Self {
            g: (0..=(REACH / STEP) as usize).map(g).collect(),
            spectrum: Some(vec![[0., 0.], [frequency, 0.]]),
        }
    }

    /// Creates a target from tables of a measured pair correlation function and of the spectrum of
    /// the same patterns.
    ///
    /// `pcf` lists g at .15, .244, … spacings, smoothed as [`TargetCurve::from_pcf`] expects it.
    /// `spectrum` lists the power at .05, .1, … √λ. Between 2 and 2.4 spacings, the measured g
    /// gives way to the g that follows from the spectrum.
    pub(in super::super) fn from_tables(pcf: &[f64], spectrum: &[f64]) -> Self {
        let rows = |values: &[f64], first: f64, step: f64| -> Vec<[f64; 2]> {
            values.iter().enumerate().map(|(i, &v)| [first + i as f64 * step, v]).collect()
        };
        let (pcf, spectrum) = (rows(pcf, 0.15, 0.094), rows(spectrum, 0.05, 0.05));
        let far = transformed(&spectrum);
        let measured = |r: f64| {
            let share = ((r - BLEND[0]) / (BLEND[1] - BLEND[0])).clamp(0., 1.);
            interpolate(&pcf, r) * (1. - share) + share * sampled(&far, r)
        };
        let mut g = sharpened(&measured, pcf[0][0], BLEND[0], REACH);
        let first = (BLEND[1] / STEP) as usize;
        g[first..].copy_from_slice(&far[first..]);
        Self { g, spectrum: Some(spectrum) }
    }

    /// Returns g at a distance of `r` spacings; beyond [`TargetCurve::reach`], g is 1.
    pub fn at(&self, r: f64) -> f64 {
        sampled(&self.g, r)
    }

    /// Returns the power at a frequency in √λ, or `None` if the spectrum is not known.
    pub fn power(&self, frequency: f64) -> Option<f64> {
        let rows = self.spectrum.as_ref()?;
        let beyond = rows.last().is_none_or(|row| frequency > row[0]);
        Some(if beyond { 1. } else { interpolate(rows, frequency) })
    }

    /// Returns the longest distance at which g is known, in spacings.
    pub fn reach(&self) -> f64 {
        (self.g.len() - 1) as f64 * STEP
    }
}

/// Returns an error if the rows do not describe a curve, see the errors of the constructors.
///
/// `what` names the curve in the message, `x` and `y` name its columns. The last x must be at least
/// `least_end`.
fn check(
    rows: &[[f64; 2]],
    what: &'static str,
    x: &'static str,
    y: &'static str,
    least_end: f64,
) -> Result<(), SampleError> {
    let refuse = |problem: String| Err(SampleError::Target { what, problem });
    if rows.len() < 2 {
        return refuse(format!("needs at least two rows of {x} and {y}, but has {}", rows.len()));
    }
    for (row, &[a, b]) in rows.iter().enumerate() {
        let before = if row == 0 { f64::NEG_INFINITY } else { rows[row - 1][0] };
        if !(a.is_finite() && a >= 0. && a > before) {
            return refuse(format!(
                "must list {x} in ascending order from 0 or more, but row {} has {a}",
                row + 1
            ));
        }
        if !(b.is_finite() && b >= 0.) {
            return refuse(format!(
                "must have finite values of {y} of 0 or more, but row {} has {b}",
                row + 1
            ));
        }
    }
    let end = rows[rows.len() - 1][0];
    if end < least_end {
        return refuse(format!("must reach {x} = {least_end} or more, but ends at {end}"));
    }
    Ok(())
}

/// Interpolates linearly between rows; the value is constant before the first and after the last
/// row.
fn interpolate(rows: &[[f64; 2]], x: f64) -> f64 {
    let after = rows.partition_point(|row| row[0] <= x);
    match (after.checked_sub(1).map(|i| rows[i]), rows.get(after)) {
        (Some([a, ya]), Some(&[b, yb])) => ya + (yb - ya) * (x - a) / (b - a),
        (Some([_, y]), None) | (None, Some(&[_, y])) => y,
        (None, None) => 1.,
    }
}

/// Interpolates linearly between samples of g; the value is 1 beyond the last sample.
fn sampled(g: &[f64], r: f64) -> f64 {
    let at = r / STEP;
    let i = at as usize;
    match (g.get(i), g.get(i + 1)) {
        (Some(a), Some(b)) => a + (b - a) * (at - i as f64),
        (Some(a), None) => *a,
        _ => 1.,
    }
}

/// Returns samples, [`STEP`] apart from 0 to `end`, of the function that becomes `measured` when it
/// is smoothed.
///
/// The smoothing is undone between `first` and `last`; below `first`, the correction found at
/// `first` is used.
fn sharpened(measured: &dyn Fn(f64) -> f64, first: f64, last: f64, end: f64) -> Vec<f64> {
    let samples = (end / STEP) as usize + 1;
    let r = |i: usize| i as f64 * STEP;
    let mut g: Vec<f64> = (0..samples).map(|i| measured(r(i))).collect();
    let width = (6. * SIGMA / STEP) as usize;
    let kernel: Vec<f64> = (0..=width).map(|k| (-0.5 * (r(k) / SIGMA).powi(2)).exp()).collect();
    let norm = STEP / (TAU.sqrt() * SIGMA);
    for _ in 0..ROUNDS {
        let smooth = |i: usize| {
            let near = i.saturating_sub(width)..=i + width;
            near.map(|k| kernel[k.abs_diff(i)] * r(k) * g[k.min(samples - 1)]).sum::<f64>() * norm / r(i)
        };
        // At shorter distances the kernel would extend far into negative distances, where g is not
        // defined.
        let from = (first.max(1.5 * SIGMA) / STEP).ceil() as usize;
        let to = samples.min((last / STEP) as usize + 1);
        let mut change = vec![0.; samples];
        (from..to).for_each(|i| change[i] = measured(r(i)) - smooth(i));
        let lowest = change.get(from).copied().unwrap_or(0.);
        change.iter_mut().take(from).for_each(|c| *c = lowest);
        g.iter_mut().zip(&change).for_each(|(g, c)| *g = (*g + c).max(0.));
    }
    g
}

/// Returns the hexagonal spacing in units of 1/√λ: √(2/√3).
fn unit() -> f64 {
    (2. / 3f64.sqrt()).sqrt()
}

/// Computes samples of g, [`STEP`] apart, from the rows of a radial power spectrum.
fn transformed(rows: &[[f64; 2]]) -> Vec<f64> {
    /// Number of frequencies summed per period of the Bessel function at the longest distance,
    /// where it oscillates fastest.
    const PER_WAVE: f64 = 24.;
    let last = rows[rows.len() - 1][0];
    // the bounds keep narrow spectra accurate and wide ones affordable
    let steps = (PER_WAVE * last * REACH * unit()).ceil().clamp(400., 20_000.) as usize;
    let step = last / steps as f64;
    let terms: Vec<[f64; 2]> = (0..steps)
        .map(|k| {
            let f = (k as f64 + 0.5) * step;
            [TAU * f, (interpolate(rows, f) - 1.) * TAU * f * step]
        })
        .collect();
    (0..=(REACH / STEP) as usize)
        .map(|i| {
            let r = i as f64 * STEP * unit();
            let sum: f64 = terms.iter().map(|&[w, weight]| weight * libm::j0(w * r)).sum();
            (1. + sum).max(0.)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spectrum_with_a_step_has_its_closed_form() {
        let f = 0.5;
        let curve = TargetCurve::from_spectrum(&[[0., 0.], [f, 0.]]).unwrap();
        for i in 1..60 {
            let r = f64::from(i) * 0.1;
            let expected = TargetCurve::below(f).at(r);
            assert!((curve.at(r) - expected).abs() < 2e-3, "{r}: {} {expected}", curve.at(r));
        }
    }

    #[test]
    fn smoothing_the_sharpened_curve_gives_what_was_measured() {
        // a narrow peak, of standard deviation .2
        let truth = |r: f64| 1. + 1.5 * (-0.5 * ((r - 1.) / 0.2f64).powi(2)).exp();
        let smoothed = |r: f64| {
            let sum: f64 = (1..2000)
                .map(|k| f64::from(k) * 0.002)
                .map(|d| d * truth(d) * (-0.5 * ((r - d) / SIGMA).powi(2)).exp() * 0.002)
                .sum();
            sum / (TAU.sqrt() * SIGMA) / r
        };
        let rows: Vec<[f64; 2]> =
            (0..117).map(|k| 0.15 + f64::from(k) * 0.02).map(|r| [r, smoothed(r)]).collect();
        let curve = TargetCurve::from_pcf(&rows).unwrap();
        let worst = |g: &dyn Fn(f64) -> f64| {
            (20..200).map(|k| f64::from(k) * 0.01).map(|r| (g(r) - truth(r)).abs()).fold(0., f64::max)
        };
        let (before, after) = (worst(&smoothed), worst(&|r| curve.at(r)));
        assert!(before > 0.15 && after < 0.04, "{before} {after}");
    }

    #[test]
    fn unsound_curves_are_refused_with_the_row() {
        let message = |rows: &[[f64; 2]]| TargetCurve::from_pcf(rows).unwrap_err().to_string();
        assert!(message(&[[0.1, 1.]]).contains("two rows"));
        assert!(message(&[[0.2, 1.], [0.1, 1.]]).contains("row 2 has 0.1"));
        assert!(message(&[[0.2, 1.], [2., -1.]]).contains("row 2 has -1"));
        assert!(message(&[[0.2, f64::NAN], [2., 1.]]).contains("row 1"));
        assert!(message(&[[0.2, 1.], [0.5, 1.]]).contains("ends at 0.5"));
        assert!(TargetCurve::from_spectrum(&[[0., 1.], [0., 1.]]).is_err());
    }
}
