//! Power of a pattern's longest waves, which pairs at short distances do not determine.

use super::curve::TargetCurve;
use rustfft::num_complex::Complex64;
use std::f64::consts::TAU;

/// Highest frequency of a controlled wave, in cycles per hexagonal spacing.
///
/// The numbers of pairs by distance determine all shorter waves. Waves up to this frequency are
/// about as long as the controlled distances or longer, so their power is controlled by itself.
const HIGHEST: f64 = 0.25;
/// Largest number of waves that are controlled, as the number of long waves grows with n, and with
/// it the time.
///
/// The longest waves are taken, annulus by annulus; the first annulus is taken in any case.
const MOST: usize = 256;

/// Long waves on a torus, grouped in annuli of similar frequency, with the power wanted for each
/// annulus.
///
/// Lengths are in hexagonal spacings. Annulus k contains the waves whose frequency, times the
/// square root of the torus's area, rounds to k.
pub(super) struct LongWaves {
    /// Integer wave numbers (kx, ky), annulus by annulus. Two opposite waves have the same power,
    /// so only one of them is listed.
    waves: Vec<(usize, isize)>,
    annuli: Vec<Annulus>,
    /// Sides of the torus.
    sides: [f64; 2],
    /// Largest |kx| and largest |ky| in `waves`.
    highest: [usize; 2],
}

/// Waves of similar frequency.
struct Annulus {
    /// Indices of the waves in [`LongWaves::waves`].
    waves: std::ops::Range<usize>,
    /// Mean power that the waves are to get.
    power: f64,
}

impl LongWaves {
    /// Creates the list of waves; the list is empty if the spectrum of `target` is not known.
    pub(super) fn new(target: &TargetCurve, sides: [f64; 2]) -> Self {
        let mut long = Self { waves: Vec::new(), annuli: Vec::new(), sides, highest: [0; 2] };
        let root = (sides[0] * sides[1]).sqrt();
        let stretch = (sides[1] / sides[0]).sqrt();
        // a hexagonal spacing is √(2/√3) in units of 1/√λ
        let unit = (2. / 3f64.sqrt()).sqrt();
        for k in 1..=(HIGHEST * root) as usize {
            let Some(power) = target.power(k as f64 / root * unit) else { break };
            let first = long.waves.len();
            let reach = k as f64 + 0.5;
            let (columns, rows) = ((reach / stretch) as usize, (reach * stretch) as isize);
            for kx in 0..=columns {
                for ky in (if kx == 0 { 1 } else { -rows })..=rows {
                    let length = (kx as f64 * stretch).hypot(ky as f64 / stretch);
                    if length.round_ties_even() as usize == k {
                        long.waves.push((kx, ky));
                    }
                }
            }
            if long.waves.len() > MOST && k > 1 {
                long.waves.truncate(first);
                break;
            }
            if long.waves.len() > first {
                long.annuli.push(Annulus { waves: first..long.waves.len(), power });
            }
        }
        for &(kx, ky) in &long.waves {
            long.highest = [long.highest[0].max(kx), long.highest[1].max(ky.unsigned_abs())];
        }
        long
    }

    /// Returns the number of annuli.
    pub(super) fn annuli(&self) -> usize {
        self.annuli.len()
    }

    /// Returns the mean power that the waves of annulus `a` are to get.
    pub(super) fn goal(&self, a: usize) -> f64 {
        self.annuli[a].power
    }

    /// Computes the mean power |Σ exp(−2πi k·x)|²/n of each annulus, with the sum over the n
    /// points.
    pub(super) fn power(&self, points: &[[f64; 2]]) -> Vec<f64> {
        let sums = self.sums(points);
        let n = points.len() as f64;
        let mean = |a: &Annulus| {
            sums[a.waves.clone()].iter().map(|s| s.norm_sqr()).sum::<f64>() / (n * a.waves.len() as f64)
        };
        self.annuli.iter().map(mean).collect()
    }

    /// Calls `add(i, a, gradient)` with the gradient of the power of annulus `a` with respect to
    /// the position of point `i`.
    pub(super) fn derive(&self, points: &[[f64; 2]], mut add: impl FnMut(usize, usize, [f64; 2])) {
        if self.waves.is_empty() {
            return;
        }
        let sums = self.sums(points);
        let per_cycle = self.sides.map(|side| TAU / side);
        let mut turns = Turns::default();
        for (i, p) in points.iter().enumerate() {
            turns.set(self, *p);
            for (index, a) in self.annuli.iter().enumerate() {
                let scale = 2. / (points.len() * a.waves.len()) as f64;
                let mut gradient = [0.; 2];
                for (&(kx, ky), sum) in self.waves[a.waves.clone()].iter().zip(&sums[a.waves.clone()]) {
                    let slope = scale * (sum.conj() * turns.at(kx, ky)).im;
                    gradient[0] += slope * kx as f64 * per_cycle[0];
                    gradient[1] += slope * ky as f64 * per_cycle[1];
                }
                add(i, index, gradient);
            }
        }
    }

    /// Computes Σ exp(−2πi k·x) over the points for each wave.
    fn sums(&self, points: &[[f64; 2]]) -> Vec<Complex64> {
        let mut sums = vec![Complex64::default(); self.waves.len()];
        if sums.is_empty() {
            return sums;
        }
        let mut turns = Turns::default();
        for p in points {
            turns.set(self, *p);
            sums.iter_mut().zip(&self.waves).for_each(|(s, &(kx, ky))| *s += turns.at(kx, ky));
        }
        sums
    }
}

/// Values of exp(−2πi kx x/w) and exp(−2πi ky y/h) at one point of a torus of w × h, for all kx and
/// ky ≥ 0 in use.
#[derive(Default)]
struct Turns {
    /// Values for kx = 0, 1, ….
    across: Vec<Complex64>,
    /// Values for ky = 0, 1, ….
    down: Vec<Complex64>,
}

impl Turns {
    /// Computes the values at point `p`.
    fn set(&mut self, waves: &LongWaves, p: [f64; 2]) {
        let powers = |out: &mut Vec<Complex64>, axis: usize| {
            let turn = Complex64::cis(-TAU * p[axis] / waves.sides[axis]);
            out.clear();
            out.push(Complex64::new(1., 0.));
            for k in 0..waves.highest[axis] {
                out.push(out[k] * turn);
            }
        };
        powers(&mut self.across, 0);
        powers(&mut self.down, 1);
    }

    #[inline]
    /// Returns exp(−2πi k·x) of the wave (kx, ky) at the point.
    fn at(&self, kx: usize, ky: isize) -> Complex64 {
        let down = self.down[ky.unsigned_abs()];
        self.across[kx] * if ky < 0 { down.conj() } else { down }
    }
}
