//! Least-squares fit of a background and a ring to the profile of a spectrum.
//!
//! Over the logarithm of frequency, from three periods per tile to half a cycle per px, the
//! logarithm of power is modelled as a cubic polynomial plus a Gaussian. All parameters but the
//! Gaussian's position are linear, so every position is tried and no starting guess is needed.
//!
//! 1. Prepare orthonormal polynomials over the frequencies of the profile once. Prepare also, for
//!    every position to be tried, the component of the Gaussian that is orthogonal to these
//!    polynomials, normalised.
//! 2. The square of the scalar product of this component with the profile is the sum of squares
//!    that the Gaussian explains beyond the background.
//! 3. The position with the highest local maximum of this sum, refined by a parabola, is the ring.

use super::FourierSpacing;
use crate::detect::SPACING_RANGE;
use crate::geometry::lattice_dual;
use std::ops::RangeInclusive;

/// Number of frequencies per octave at which a profile is read for the fit: steps of 2.9 %, a
/// quarter of a ring's standard deviation ([`WIDTH`]).
const PER_OCTAVE: f64 = 24.;
/// Number of frequencies per octave at which a ring is tried; a parabola gives the position between
/// them.
const TRIED_PER_OCTAVE: f64 = 48.;
/// Lowest frequency of the fit, in periods per tile.
///
/// Slower waves are uneven illumination, and what the Hann window leaves of the mean.
const FIRST: f64 = 3.;
/// Smallest number of periods per tile of a ring that is tried: slower rings cannot be told from
/// the background.
const PERIODS: f64 = 5.;
/// Degree of the polynomial that models the background; chosen together with [`WIDTH`] and
/// [`FIRST`] on marked and simulated images.
const DEGREE: usize = 3;
/// Standard deviation of a ring in the natural logarithm of frequency.
///
/// With .15 instead, spacings are on average .05 % wider in confocal images, .5 % closer in
/// split-detector ones and 1.2 % wider in simulated histology.
const WIDTH: f64 = 0.12;

/// The prepared fit of a background and a ring to profiles of tiles of one size.
pub(super) struct RingFit {
    /// Side of the tiles in px.
    side: f64,
    /// Positions in a profile at which it is read for the fit, each as the index of a radius and
    /// the weight (0–1) of the next radius.
    places: Vec<(usize, f64)>,
    /// Orthonormal polynomials over the frequencies at `places` that model the background.
    background: Vec<Vec<f64>>,
    /// Rings that are tried, each with two values: the natural logarithm of its frequency (cycles
    /// per px), and its component orthogonal to `background`, normalised.
    rings: Vec<(f64, Vec<f64>)>,
}

/// Variance of the decimal logarithm of the power of noise: π²/(6 ln²10).
///
/// The power of noise is exponentially distributed.
const SCATTER: f64 = 0.3102;
/// Number of neighbouring terms of a tile's transform, along a line, that a Hann window makes so
/// alike that they count as one: the equivalent noise bandwidth of the window.
const CORRELATED: f64 = 1.5;
/// Number of standard deviations of the scatter of noise that a ring must exceed to have any
/// confidence.
const DEVIATIONS: f64 = 3.;

impl RingFit {
    /// Prepares the fit for tiles of `side` px whose transform has `size` × `size` terms.
    pub fn new(side: usize, size: usize) -> Self {
        let first = (FIRST / side as f64).ln();
        let step = std::f64::consts::LN_2 / PER_OCTAVE;
        let read = (0..).map(|k| first + f64::from(k) * step).take_while(|u| u.exp() <= 0.5);
        let logs: Vec<f64> = read.filter(|u| ((u.exp() * size as f64) as usize) < size / 2).collect();
        let places = logs.iter().map(|u| u.exp() * size as f64).map(|r| (r as usize, r.fract())).collect();
        let middle = logs.iter().sum::<f64>() / logs.len().max(1) as f64;
        let mut background: Vec<Vec<f64>> = Vec::new();
        for degree in 0..=DEGREE {
            let power: Vec<f64> = logs.iter().map(|u| (u - middle).powi(degree as i32)).collect();
            background.extend(without(power, &background));
        }
        let (slow, fast) =
            (lattice_dual(SPACING_RANGE.1).max(PERIODS / side as f64), lattice_dual(SPACING_RANGE.0));
        let step = std::f64::consts::LN_2 / TRIED_PER_OCTAVE;
        let tried = (0..).map(|k| slow.ln() + f64::from(k) * step).take_while(|u| *u <= fast.ln());
        let rings = tried
            .filter_map(|at| {
                let ring = logs.iter().map(|u| (-0.5 * ((u - at) / WIDTH).powi(2)).exp()).collect();
                Some((at, without(ring, &background)?))
            })
            .collect();
        Self { side: side as f64, places, background, rings }
    }

    /// Returns the ring of a profile whose hexagonal spacing (px) lies in `spacings`, or `None` if
    /// there is no ring.
    ///
    /// There is no ring if the part of the profile that a ring explains has no local maximum
    /// strictly inside `spacings`. `part` is the number of tiles averaged in the profile, times the
    /// fraction of all directions that its sector covers.
    pub fn ring(&self, profile: &[f64], part: f64, spacings: RangeInclusive<f64>) -> Option<FourierSpacing> {
        let at = |&(k, share): &(usize, f64)| profile[k] + share * (profile[k + 1] - profile[k]);
        let values: Vec<f64> = self.places.iter().map(at).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let values: Vec<f64> = values.iter().map(|v| v - mean).collect();
        let explained: f64 = self.background.iter().map(|b| dot(b, &values).powi(2)).sum();
        // sums of squares: what the background leaves, then what each ring explains of it
        let left = dot(&values, &values) - explained;
        let gains: Vec<(f64, f64)> = self
            .rings
            .iter()
            .filter(|(log, _)| spacings.contains(&lattice_dual(log.exp())))
            .map(|(log, ring)| (*log, dot(ring, &values).max(0.).powi(2)))
            .collect();
        let peak = gains
            .windows(3)
            .filter(|g| g[1].1 > g[0].1 && g[1].1 >= g[2].1)
            .max_by(|a, b| a[1].1.total_cmp(&b[1].1))?;
        let [a, b, c] = [peak[0].1, peak[1].1, peak[2].1];
        let offset = 0.5 * (a - c) / (a - 2. * b + c);
        let frequency = (peak[1].0 + offset * (peak[2].0 - peak[1].0)).exp();
        Some(FourierSpacing {
            row_spacing: 1. / frequency,
            spacing: lattice_dual(frequency),
            confidence: ((b - DEVIATIONS * DEVIATIONS * self.chance(frequency) / part) / left).clamp(0., 1.),
        })
    }

    /// Returns the sum of squares that a ring explains, on average, in the profile of one tile of
    /// noise.
    ///
    /// The sum is a product of two factors. The first is the variance of the mean over the terms on
    /// a circle, half of which mirrors the other half. The second is the number of frequencies of
    /// the profile that share these terms.
    fn chance(&self, frequency: f64) -> f64 {
        let radius = frequency * self.side;
        let variance = SCATTER * CORRELATED / (std::f64::consts::PI * radius);
        let shared = CORRELATED / radius * PER_OCTAVE / std::f64::consts::LN_2;
        let all = WIDTH * std::f64::consts::PI.sqrt() * PER_OCTAVE / std::f64::consts::LN_2;
        // at most twice the number of frequencies that the ring itself covers
        variance * shared.clamp(1., 2. * all)
    }
}

/// Returns a vector less its components along the orthonormal `others`, normalised to length 1, or
/// `None` if only rounding errors are left.
fn without(mut vector: Vec<f64>, others: &[Vec<f64>]) -> Option<Vec<f64>> {
    let before = dot(&vector, &vector);
    for other in others {
        let part = dot(&vector, other);
        vector.iter_mut().zip(other).for_each(|(v, o)| *v -= part * o);
    }
    let length = dot(&vector, &vector).sqrt();
    (length > 1e-9 * before.sqrt()).then(|| vector.into_iter().map(|v| v / length).collect())
}

/// Returns the scalar product of two vectors.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a profile that the model describes exactly, at radii of 1/400 cycles per px.
    fn profile(frequency: f64, height: f64) -> Vec<f64> {
        let at = |k: i32| {
            let log = (f64::from(k.max(1)) / 400.).ln();
            3. - 1.2 * log - 0.2 * log * log
                + height * (-0.5 * ((log - frequency.ln()) / WIDTH).powi(2)).exp()
        };
        (0..=200).map(at).collect()
    }

    #[test]
    fn a_ring_on_a_smooth_background_is_found_where_it_is() {
        let fit = RingFit::new(200, 400);
        for frequency in [0.04, 0.0731, 0.11, 0.2, 0.27] {
            for height in [0.3, 2.] {
                let found = fit.ring(&profile(frequency, height), 1e6, 4. ..=40.).unwrap();
                assert!((found.row_spacing * frequency - 1.).abs() < 2e-3, "{frequency} {height}: {found:?}");
                assert!((found.spacing * frequency * 0.75f64.sqrt() - 1.).abs() < 2e-3);
                assert!(found.confidence > 0.99, "{found:?}");
            }
        }
    }

    #[test]
    fn without_a_ring_or_with_one_elsewhere_there_is_none() {
        let fit = RingFit::new(200, 400);
        assert_eq!(fit.ring(&[1.; 201], 1., 4. ..=40.), None);
        // a dip instead of a ring, and only spacings around it are allowed
        assert_eq!(fit.ring(&profile(0.1, -1.), 1., 10. ..=13.), None);
        assert_eq!(fit.ring(&profile(0.1, 1.), 1., 14. ..=40.).filter(|r| r.confidence > 0.5), None);
    }

    #[test]
    fn the_smallest_tile_has_candidates() {
        assert!(!RingFit::new(24, 48).rings.is_empty());
        assert_eq!(RingFit::new(24, 48).background.len(), DEGREE + 1);
    }
}
