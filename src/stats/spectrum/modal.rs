//! Modal spacing: the spacing that belongs to the first ring of the power spectrum (Yellott 1983).
//!
//! 1. Average the power over frequency with a Gaussian kernel.
//! 2. Find its maximum between .6 and 1.6 √λ and refine it by a parabola.
//! 3. Convert the frequency of the maximum to the spacing of the triangular lattice with that ring.

use super::{PowerSpectrum, SpectrumOptions, spectrum};
use crate::geometry::{Point, Window, lattice_dual};
use crate::stats::StatsError;
use serde::{Deserialize, Serialize};

/// Lowest and highest frequency at which the ring is sought, in √λ, with λ the density.
///
/// The ring of the triangular lattice lies between them, at √(2/√3) = 1.075.
const RANGE: (f64, f64) = (0.6, 1.6);
/// Step between the frequencies that are tried, in √λ. The maximum is then refined by a parabola.
const STEP: f64 = 0.01;
/// Standard deviation of the kernel that averages power over frequency, in √λ: about half the width
/// of the rings of cone mosaics.
const SMOOTHING: f64 = 0.05;
/// Smallest number of points for which a ring is sought. With fewer points, too few waves are as
/// long as the spacing.
const FEWEST: usize = 20;

/// First ring of the power of a point pattern, and the spacing that belongs to it.
///
/// Source: Yellott (1983), <https://doi.org/10.1126/science.6867716>.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModalSpacing {
    /// Radius f of the ring, in cycles per unit of the coordinates.
    pub frequency: f64,
    /// Modal spacing 1/f: the distance between rows of the triangular lattice whose first ring has
    /// the frequency f.
    pub row_spacing: f64,
    /// Distance 2/(√3 f) between neighbours of the triangular lattice whose first ring has the
    /// frequency f.
    ///
    /// This lattice has 2/(√3 spacing²) = (√3/2) f² points per squared unit of the coordinates.
    pub spacing: f64,
    /// Averaged power on the ring: 1 for independent points.
    pub power: f64,
}

impl PowerSpectrum {
    /// Finds the first ring of the spectrum, between .6 and 1.6 √λ, with λ the density of the
    /// points.
    ///
    /// The ring is the maximum of the power, averaged over frequency with a Gaussian of standard
    /// deviation .05 √λ and refined by a parabola. The number of waves grows with frequency; each
    /// has the weight 1/frequency, so that all frequencies count equally.
    ///
    /// `window` is the window of the points. Returns `None` for fewer than 20 points, if there is
    /// no maximum within the range, and for a spectrum that ends before 1.75 √λ. Independent points
    /// have a maximum too, by chance, with a power near 1.
    pub fn modal(&self, window: &Window) -> Option<ModalSpacing> {
        let n = self.at(0, 0)?;
        let bounds = window.bounds();
        let stretch = (bounds.height() / bounds.width()).sqrt();
        let [columns, rows] = self.highest();
        let root = n.sqrt();
        // The average at the highest frequency needs the power up to three standard deviations
        // beyond.
        let end = RANGE.1 + 3. * SMOOTHING;
        let enough = |highest: usize, stretch: f64| (highest + 1) as f64 * stretch >= end * root;
        if n < FEWEST as f64 || !enough(columns, stretch) || !enough(rows, 1. / stretch) {
            return None;
        }
        // For each step of frequency: sums of weighted power and of weights over its waves.
        let mut fine = vec![[0.; 2]; (end / STEP) as usize];
        for kx in 0..=columns as isize {
            // A wave and its opposite have the same power, so only one of them is counted. For kx =
            // 0, this means ky > 0.
            let first = if kx == 0 { 1 } else { -(rows as isize) };
            for ky in first..=rows as isize {
                let frequency = (kx as f64 * stretch).hypot(ky as f64 / stretch) / root;
                let (Some(bin), Some(power)) = (fine.get_mut((frequency / STEP) as usize), self.at(kx, ky))
                else {
                    continue;
                };
                *bin = [bin[0] + power / frequency, bin[1] + 1. / frequency];
            }
        }
        let middle = |bin: usize| (bin as f64 + 0.5) * STEP;
        let averaged = |at: usize| {
            let kernel = |bin: usize| (-0.5 * ((middle(bin) - middle(at)) / SMOOTHING).powi(2)).exp();
            let sums = fine.iter().enumerate().map(|(bin, v)| v.map(|v| kernel(bin) * v));
            let [power, weight] = sums.fold([0.; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
            power / weight
        };
        let (first, last) = ((RANGE.0 / STEP) as usize, (RANGE.1 / STEP) as usize);
        let smooth: Vec<f64> = (first..=last).map(averaged).collect();
        let peak = (0..smooth.len()).max_by(|&a, &b| smooth[a].total_cmp(&smooth[b]).then(b.cmp(&a)))?;
        let &[a, b, c] = smooth.get(peak.checked_sub(1)?..peak + 2)? else { return None };
        let curved = a - 2. * b + c;
        if curved >= 0. {
            return None;
        }
        let offset = (0.5 * (a - c) / curved).clamp(-0.5, 0.5);
        let frequency = (middle(first + peak) + offset * STEP) * (n / window.area()).sqrt();
        Some(ModalSpacing {
            frequency,
            row_spacing: 1. / frequency,
            spacing: lattice_dual(frequency),
            power: b,
        })
    }
}

/// Finds the ring of a pattern as [`PowerSpectrum::modal`] does, or returns `None` if there is no
/// ring.
///
/// # Errors
/// Fails as [`spectrum()`] does: without points, if a point is outside, or in a polygon.
pub fn modal_spacing(points: &[Point], window: &Window) -> Result<Option<ModalSpacing>, StatsError> {
    // `modal` needs 3 standard deviations beyond the range; the fourth is a margin.
    let options = SpectrumOptions { max_frequency: RANGE.1 + 4. * SMOOTHING };
    Ok(spectrum(points, window, &options)?.modal(window))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Rectangle;
    use crate::mosaic::hexagonal_spacing;
    use crate::sample::sampler;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn ratio(points: &[Point], window: &Window) -> (f64, f64) {
        let found = modal_spacing(points, window).unwrap().unwrap();
        (found.spacing / hexagonal_spacing(points.len(), window.area()).unwrap(), found.power)
    }

    #[test]
    fn the_triangular_lattice_has_its_own_spacing() {
        let row = 7. * 0.75f64.sqrt();
        let points: Vec<Point> = (0..480)
            .map(|k| (k % 20, k / 20))
            .map(|(i, j)| Point::new(7. * (f64::from(i) + 0.5 * f64::from(j % 2)), f64::from(j) * row))
            .collect();
        let window = Window::Torus(Rectangle::new(0., 0., 140., 24. * row).unwrap());
        let found = modal_spacing(&points, &window).unwrap().unwrap();
        assert!((found.spacing / 7. - 1.).abs() < 0.005, "{found:?}");
        assert!((found.row_spacing / row - 1.).abs() < 0.005);
        // The documentation of `ModalSpacing::spacing` gives the density.
        assert!((0.75f64.sqrt() * found.frequency.powi(2) * window.area() / 480. - 1.).abs() < 0.01);
        assert!(found.power > 5.);
    }

    #[test]
    fn the_ring_of_regular_patterns_is_near_that_of_the_lattice_in_any_rectangle() {
        for window in [Window::unit_torus(), Window::rectangle(2., 0., 5., 1.).unwrap()] {
            for (name, n) in [("lloyd", 300), ("bnot", 300), ("poisson-disk", 1000)] {
                let mut rng = ChaCha8Rng::seed_from_u64(n as u64);
                let points = sampler(name).unwrap().sample(n, &window, &mut rng).unwrap();
                let (ratio, power) = ratio(&points, &window);
                println!("{name} {n} {ratio} {power}");
                assert!((ratio - 1.).abs() < 0.08, "{name}: {ratio}");
                assert!(power > 1.5, "{name}: {power}");
            }
        }
    }

    #[test]
    fn a_ring_needs_points_and_a_spectrum_that_reaches_it() {
        let window = Window::unit_square();
        assert!(matches!(modal_spacing(&[], &window), Err(StatsError::TooFewPoints { .. })));
        let line: Vec<Point> = (0..30).map(|k| Point::new(f64::from(k) / 29., 0.5)).collect();
        for few in [&line[..1], &line[..3], &[line[0]; 3][..]] {
            assert_eq!(modal_spacing(few, &window), Ok(None));
        }
        // On a line there is power wherever the pattern repeats, but nothing fails.
        assert!(modal_spacing(&line, &window).is_ok());
        let short = SpectrumOptions { max_frequency: 1. };
        assert_eq!(spectrum(&line, &window, &short).unwrap().modal(&window), None);
    }
}
