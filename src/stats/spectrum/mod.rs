//! Power spectrum of a point pattern and its radial averages (Ulichney 1987; Lagae & Dutré 2008).
//!
//! 1. Sum exp(−2πi k·x) over the points for every wave vector k of the window.
//! 2. Square the moduli and divide by the number of points: the periodogram.
//! 3. Average it over annuli of |k|; the variance within an annulus gives the anisotropy.

mod modal;
mod waves;

use super::StatsError;
use super::error::all_inside;
use crate::geometry::{Point, Window};
pub use modal::{ModalSpacing, modal_spacing};
use serde::{Deserialize, Serialize};

/// Largest number of waves in a spectrum. Requests for more are refused, because their powers and
/// sums would fill gigabytes.
const MOST_WAVES: f64 = 5e7;

/// Options of a power spectrum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SpectrumOptions {
    /// Highest frequency: .1–20, default 4, in units of √λ, the square root of the density (√n in
    /// the unit square).
    pub max_frequency: f64,
}

impl Default for SpectrumOptions {
    fn default() -> Self {
        Self { max_frequency: 4. }
    }
}

impl SpectrumOptions {
    /// Checks that the highest frequency is in its range.
    ///
    /// # Errors
    /// Fails if the frequency is out of its range.
    pub fn validate(&self) -> Result<(), StatsError> {
        if (0.1..=20.).contains(&self.max_frequency) {
            return Ok(());
        }
        let range = "0.1 to 20 times √density";
        Err(StatsError::Option {
            option: "maximum frequency of the spectrum",
            value: self.max_frequency,
            range,
        })
    }
}

/// Power spectrum of a point pattern: 1 on average for independent points.
#[derive(Clone, Debug, PartialEq)]
pub struct PowerSpectrum {
    /// Frequency of each annulus, in units of √λ, the square root of the density.
    ///
    /// The frequencies are multiples of 1/√n, for n points; multiples at which there are no waves
    /// are left out.
    pub frequency: Vec<f64>,
    /// Mean power of each annulus.
    pub power: Vec<f64>,
    /// Anisotropy of each annulus, in dB: 10 log₁₀(s²/P²), with P the mean and s² the variance of
    /// the power of its waves (divisor: number of waves − 1).
    ///
    /// For one pattern without preferred direction it is about 0 dB, because the variance of the
    /// power then equals its squared mean; for the mean spectrum of m such patterns, about −10
    /// log₁₀ m. `None` for an annulus with a single wave or without variance.
    ///
    /// Sources: Ulichney (1987); Lagae & Dutré (2008),
    /// <https://doi.org/10.1111/j.1467-8659.2007.01100.x>.
    pub anisotropy_db: Vec<Option<f64>>,
    /// Highest wave numbers in `plane`: the largest kx and the largest ky.
    highest: [usize; 2],
    /// Frequency of the wave with kx = 1, ky = 0 and of the wave with kx = 0, ky = 1, in √λ.
    step: [f64; 2],
    /// Power of the waves (kx, ky) with 0 ≤ kx ≤ `highest[0]` and |ky| ≤ `highest[1]`, at index `kx
    /// · (2 · highest[1] + 1) + ky + highest[1]`.
    ///
    /// Waves with kx < 0 are not stored, because the opposite wave (−kx, −ky) has the same power.
    plane: Vec<f64>,
}

/// Computes the power spectrum of a point pattern.
///
/// The spectrum is the periodogram P(k) = |Σ_j exp(−2πi k·x_j)|²/n of n points x_j. It is averaged
/// over annuli, each of which consists of the waves with the same nearest integer to |k|√A, in a
/// window of area A (Ulichney 1987; Lagae & Dutré 2008,
/// <https://doi.org/10.1111/j.1467-8659.2007.01100.x>). The wave vectors k are (j/w, l/h), with
/// integers j and l that are not both 0, as if the w × h window were a torus. The same waves are
/// used in a window with a border, because the transform of the window is 0 at these waves, so the
/// mean density contributes nothing. The time is linear in n. The error of the power is at most
/// 10⁻⁶ P, or 10⁻⁸ if P is below .01.
///
/// # Errors
/// Fails if there is no point, a point is outside, an option is out of its range, there are more
/// than 5·10⁷ waves, or the window is a polygon (whose own spectrum would hide the spectrum of the
/// points).
///
/// # Examples
/// ```
/// use conemosaic::prelude::*;
/// use conemosaic::stats::{SpectrumOptions, spectrum};
///
/// let window = Window::rectangle(0., 0., 16., 16.)?;
/// let place = |i: usize| Point::new((i % 16) as f64, (i / 16) as f64);
/// let points: Vec<Point> = (0..256).map(place).collect();
/// let found = spectrum(&points, &window, &SpectrumOptions::default())?;
/// // a lattice of step 1 has all its power at multiples of 16 waves across the window
/// let [peak, beside] = [16, 15].map(|kx| found.at(kx, 0));
/// assert!(peak > Some(255.) && beside < Some(1e-9));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn spectrum(
    points: &[Point],
    window: &Window,
    options: &SpectrumOptions,
) -> Result<PowerSpectrum, StatsError> {
    options.validate()?;
    if matches!(window, Window::Polygon(_)) {
        return Err(StatsError::NotRectangular { statistic: "the power spectrum" });
    }
    let n = points.len();
    if n == 0 {
        return Err(StatsError::TooFewPoints { statistic: "the power spectrum", needed: 1, found: 0 });
    }
    let bounds = window.bounds();
    all_inside(points, window)?;
    let root = (n as f64).sqrt();
    let annuli = (options.max_frequency * root).floor();
    // |k| √A is hypot(j √(h/w), l √(w/h)).
    let stretch = (bounds.height() / bounds.width()).sqrt();
    let highest = [(annuli + 0.5) / stretch, (annuli + 0.5) * stretch];
    let waves = (highest[0] + 1.) * (2. * highest[1] + 1.);
    if waves > MOST_WAVES {
        let range = "at most 5e7, so choose a lower maximum frequency";
        return Err(StatsError::Option { option: "number of waves of the spectrum", value: waves, range });
    }
    let highest = highest.map(|v| v.floor() as usize);
    let unit: Vec<[f64; 2]> = points
        .iter()
        .map(|p| [(p.x - bounds.x0()) / bounds.width(), (p.y - bounds.y0()) / bounds.height()])
        .collect();
    let plane: Vec<f64> =
        waves::sums(&unit, highest[0], highest[1]).iter().map(|s| s.norm_sqr() / n as f64).collect();

    let mut annulus = vec![Annulus::default(); annuli as usize + 1];
    for (j, column) in plane.chunks_exact(2 * highest[1] + 1).enumerate() {
        // A wave and its opposite have the same power, so one of them is counted. For kx = 0, this
        // means ky > 0.
        let first = if j == 0 { highest[1] + 1 } else { 0 };
        for (l, &power) in column.iter().enumerate().skip(first) {
            let length = (j as f64 * stretch).hypot((l as f64 - highest[1] as f64) / stretch);
            if let Some(a) = annulus.get_mut(length.round_ties_even() as usize) {
                a.add(power);
            }
        }
    }
    let filled = || annulus.iter().enumerate().skip(1).filter(|(_, a)| a.waves > 0.);
    Ok(PowerSpectrum {
        frequency: filled().map(|(k, _)| k as f64 / root).collect(),
        power: filled().map(|(_, a)| a.mean).collect(),
        anisotropy_db: filled().map(|(_, a)| a.anisotropy_db()).collect(),
        highest,
        step: [stretch / root, 1. / (stretch * root)],
        plane,
    })
}

/// Running mean and sum of squared deviations of the power in one annulus (Welford 1962,
/// <https://doi.org/10.1080/00401706.1962.10490022>).
#[derive(Clone, Copy, Default)]
struct Annulus {
    /// Number of waves in the annulus.
    waves: f64,
    /// Mean power of these waves.
    mean: f64,
    /// Sum of squared deviations of the powers from their mean.
    squares: f64,
}

impl Annulus {
    /// Adds the power of one wave.
    fn add(&mut self, power: f64) {
        self.waves += 1.;
        let off = power - self.mean;
        self.mean += off / self.waves;
        self.squares += off * (power - self.mean);
    }

    /// Returns the anisotropy in dB; `None` for a single wave or without variance.
    fn anisotropy_db(&self) -> Option<f64> {
        let ratio = self.squares / (self.waves - 1.) / (self.mean * self.mean);
        (self.waves > 1. && ratio > 0. && ratio.is_finite()).then(|| 10. * ratio.log10())
    }
}

impl PowerSpectrum {
    /// Returns the difference in frequency of neighbouring waves along x and along y, in √λ, the
    /// square root of the density.
    pub const fn wave_step(&self) -> [f64; 2] {
        self.step
    }

    /// Returns the highest wave numbers, along x and along y, for which [`Self::at`] has a value.
    pub fn highest(&self) -> [usize; 2] {
        self.highest
    }

    /// Returns the power of the wave (kx, ky), or `None` beyond the highest wave.
    ///
    /// The power of the wave (0, 0) is the number of points.
    pub fn at(&self, kx: isize, ky: isize) -> Option<f64> {
        let (kx, ky) = if kx < 0 { (-kx, -ky) } else { (kx, ky) };
        let [columns, rows] = self.highest;
        let inside = kx as usize <= columns && ky.unsigned_abs() <= rows;
        let row = (ky + rows as isize) as usize;
        inside.then(|| self.plane[kx as usize * (2 * rows + 1) + row])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::sampler;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use std::f64::consts::TAU;

    fn pattern(name: &str, n: usize, window: &Window, seed: u64) -> Vec<Point> {
        sampler(name).unwrap().sample(n, window, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap()
    }

    #[test]
    fn power_is_that_of_the_definition_in_any_rectangle() {
        let window = Window::rectangle(-3., 2., 5., 4.).unwrap();
        let points = pattern("uniform", 150, &window, 1);
        let spectrum = spectrum(&points, &window, &SpectrumOptions { max_frequency: 2. }).unwrap();
        let [columns, rows] = spectrum.highest().map(|k| k as isize);
        let mut annuli = vec![(0., 0.); 25];
        for (j, l) in (-columns..=columns).flat_map(|j| (-rows..=rows).map(move |l| (j, l))) {
            let phase = |p: &Point| -TAU * (j as f64 * p.x / 8. + l as f64 * p.y / 2.);
            let (re, im) = points.iter().map(phase).fold((0., 0.), |(a, b), t| (a + t.cos(), b + t.sin()));
            let power = (re * re + im * im) / 150.;
            assert!((spectrum.at(j, l).unwrap() - power).abs() < 1e-6 * power.max(0.01));
            let k = ((j as f64 / 8.).hypot(l as f64 / 2.) * 4.).round_ties_even() as usize;
            if (1..25).contains(&k) {
                annuli[k] = (annuli[k].0 + power, annuli[k].1 + 1.);
            }
        }
        for (f, power) in spectrum.frequency.iter().zip(&spectrum.power) {
            let (sum, waves) = annuli[(f * 150f64.sqrt()).round() as usize];
            assert!((power - sum / waves).abs() < 1e-6, "{f}");
        }
    }

    #[test]
    fn independent_points_have_power_one_and_no_direction() {
        let window = Window::unit_torus();
        let spectrum =
            spectrum(&pattern("uniform", 4000, &window, 2), &window, &SpectrumOptions::default()).unwrap();
        let mean = |v: &mut dyn Iterator<Item = f64>| {
            let all: Vec<f64> = v.skip(20).collect();
            all.iter().sum::<f64>() / all.len() as f64
        };
        let power = mean(&mut spectrum.power.iter().copied());
        assert!((power - 1.).abs() < 0.02, "{power}");
        let anisotropy = mean(&mut spectrum.anisotropy_db.iter().flatten().copied());
        assert!(anisotropy.abs() < 0.3, "{anisotropy} dB");
    }

    #[test]
    fn a_lattice_has_direction() {
        let window = Window::unit_torus();
        let lattice =
            spectrum(&pattern("square", 1024, &window, 3), &window, &SpectrumOptions::default()).unwrap();
        assert!((lattice.at(32, 0).unwrap() - 1024.).abs() < 1e-3);
        assert!(lattice.at(31, 0).unwrap() < 1e-6);
        let at_first = lattice.frequency.iter().position(|&f| f == 1.).unwrap();
        assert!(lattice.anisotropy_db[at_first].unwrap() > 10.);
    }

    #[test]
    fn what_has_no_spectrum_is_refused() {
        let window = Window::unit_square();
        let options = SpectrumOptions::default();
        assert!(matches!(spectrum(&[], &window, &options), Err(StatsError::TooFewPoints { .. })));
        let outside = [Point::new(2., 0.)];
        assert!(matches!(spectrum(&outside, &window, &options), Err(StatsError::Outside { .. })));
        let never = SpectrumOptions { max_frequency: f64::NAN };
        assert!(matches!(spectrum(&[Point::new(0., 0.)], &window, &never), Err(StatsError::Option { .. })));
        let corners = [(0., 0.), (2., 0.), (0., 2.)].map(|(x, y)| Point::new(x, y));
        let triangle = Window::polygon(vec![corners.to_vec()]).unwrap();
        let inside = [Point::new(0.1, 0.1)];
        assert!(matches!(spectrum(&inside, &triangle, &options), Err(StatsError::NotRectangular { .. })));
    }

    #[test]
    fn threads_make_no_difference() {
        let window = Window::unit_square();
        let points = pattern("uniform", 3000, &window, 4);
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| spectrum(&points, &window, &SpectrumOptions::default()).unwrap())
        };
        assert_eq!(on(1), on(3));
    }
}
