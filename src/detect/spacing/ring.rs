//! Spacing from Yellott's ring: cones that keep a distance from each other put a ring into the
//! power spectrum.
//!
//! 1. The spectrum of a flattened image under a Hann window is summed over angle into bins of
//!    log-frequency: once over all directions, once along x and once across x.
//! 2. A small network (`ring_network`) gives every candidate spacing its odds.
//! 3. The most probable candidate, refined by a parabola, is the spacing.
//!
//! Yellott (1983), <https://doi.org/10.1126/science.6867716>.

use super::SPACING_RANGE;
use super::bins::{BINS, CANDIDATES, LONGEST_PERIOD, PER_OCTAVE, bin_of, candidate};
use super::ring_network;
use crate::image::{Plane, Spectrum, crop, signed_frequency};
use std::sync::OnceLock;

/// Side of the Fourier transform, and longest side of the part of an image that is transformed, in
/// px: a power of two, for which the transform is fast.
pub(super) const SIZE: usize = 512;
/// Smallest number of times that a spacing must fit into the shorter side of the image to be a
/// candidate.
///
/// With fewer periods, a ring cannot be told from uneven illumination.
pub(in crate::detect) const PERIODS: f64 = 5.;
/// Probability that the true spacing is below [`RingEstimate::least`], the smallest spacing that a
/// count of cones may show.
///
/// If more cones are counted than that spacing allows, some of them are more likely noise. A
/// smaller probability gives results that are better by .0002 on marked split-detector images, and
/// worse by up to .03 on noisy simulated images.
const CLOSER: f64 = 0.15;
/// Factor, up or down, by which a spacing may differ from the true one and still count as right.
const RIGHT: f64 = 1.15;
/// Band of a spectrum, in cycles per spacing, that contains the power of the ring.
const RING_BAND: (f64, f64) = (0.8, 1.4);
/// Frequency, in cycles per spacing, around which noise is measured.
///
/// Cones have no detail this fine, so there is hardly anything but noise.
const FINEST: f64 = 2.6;
/// Ratio of the upper end of the band around [`FINEST`] to its middle, and of the middle to the
/// lower end.
const FINEST_BAND: f64 = 1.15;
/// Smallest clarity ([`RingProfile::clarity`]) of an image with hardly any noise. Below it, the
/// confocal filter is widened and the threshold of the confocal network raised.
pub(in crate::detect) const CLEAR: f64 = 6.2;
/// Number of frequencies around the ring at which [`RingProfile::around`] gives the power: a range
/// of 3½ octaves in steps of a quarter octave.
pub(in crate::detect) const AROUND: usize = 15;

/// Radially averaged power spectrum of an image over log-frequency, and the spacing it shows.
///
/// The spectrum is the logarithm of power in 24 bins per octave from 1/64 to 1/2 cycles per px.
/// Cones that keep a distance from each other put a ring into it, here a peak near the frequency 1
/// / spacing (Yellott 1983, <https://doi.org/10.1126/science.6867716>).
pub struct RingProfile {
    /// Natural logarithm of the mean power in every bin, over all directions.
    all: [f32; BINS],
    /// Logarithm of the odds, up to a constant, that each candidate is the cone spacing.
    ///
    /// It is minus infinity for candidates too wide for the image that was transformed.
    scores: [f32; CANDIDATES],
}

/// Cone spacing estimated from the ring in the spectrum of an image, with its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingEstimate {
    /// Cone spacing in px.
    pub spacing: f64,
    /// Probability, 0–1, judged by the spectrum alone, that the spacing is within 15 % of the true
    /// one.
    pub confidence: f64,
    /// Lower limit of the spacing in px: with a probability of 15 %, the true spacing is below it.
    /// At most `spacing`.
    pub least: f64,
}

/// One term of the Fourier transform, and how its power is shared among bins and directions.
struct Term {
    /// Index in the transform's order of storage.
    index: u32,
    /// Lower of the two bins that share the term.
    bin: u16,
    /// Fraction (0–1) of the power that the upper of the two bins receives.
    upper_share: f32,
    /// Fraction (0–1) of the power that counts as along x: fx² / f².
    along_x: f32,
    /// Number of terms of the full spectrum that this term stands for.
    ///
    /// It is 2 for a term whose mirror image at fx < 0 is not stored, and otherwise 1.
    weight: f32,
}

/// Returns the terms of the transform that fall into the bins.
fn terms() -> &'static [Term] {
    /// Terms that fall into the bins, computed on first use.
    static TERMS: OnceLock<Vec<Term>> = OnceLock::new();
    TERMS.get_or_init(|| {
        // terms up to a bin beyond either end of the axis share their power with the outermost
        // bins; a bin is a factor of 2^(1/24) = 1.03 wide
        let lowest = 1. / (1.05 * LONGEST_PERIOD);
        let mut terms = Vec::new();
        for kx in 0..=SIZE / 2 {
            for ky in 0..SIZE {
                let fx = kx as f64 / SIZE as f64;
                let fy = f64::from(signed_frequency(ky, SIZE));
                let f = fx.hypot(fy);
                if f <= lowest || f >= 0.515 {
                    continue;
                }
                // one more bin at either end catches the shares that fall off the axis
                let place = (PER_OCTAVE * (LONGEST_PERIOD * f).log2() + 1.).clamp(0., (BINS + 1) as f64);
                terms.push(Term {
                    index: (kx * SIZE + ky) as u32,
                    bin: place as u16,
                    upper_share: place.fract() as f32,
                    along_x: (fx * fx / (f * f)) as f32,
                    weight: if kx == 0 || kx == SIZE / 2 { 1. } else { 2. },
                });
            }
        }
        terms
    })
}

/// Returns a Hann window of `length` values, without the zeros at its ends.
fn hann(length: usize) -> Vec<f32> {
    let step = std::f64::consts::TAU / (length + 1) as f64;
    (1..=length).map(|k| (0.5 - 0.5 * (step * k as f64).cos()) as f32).collect()
}

/// Sums of power in bins: over all directions, along x, across x.
///
/// The first and the last two bins receive the shares that fall off the axis.
pub(super) type Power = [[f64; BINS + 3]; 3];

/// Returns the power of a flattened plane under a Hann window, summed into bins.
///
/// Of a plane larger than 512 px, only the upper left 512 × 512 px are used.
pub(super) fn power_of(flat: &Plane) -> Power {
    let (h, w) = flat.dim();
    let (taper_y, taper_x) = (hann(h.min(SIZE)), hann(w.min(SIZE)));
    let mut tapered = crop(flat, 0, 0, h.min(SIZE), w.min(SIZE));
    for (mut row, weight) in tapered.rows_mut().into_iter().zip(&taper_y) {
        row.iter_mut().zip(&taper_x).for_each(|(v, taper)| *v *= weight * taper);
    }
    let spectrum = Spectrum::forward(&tapered, SIZE, SIZE);
    let power: Vec<f32> = spectrum.power().collect();
    let mut sums = [[0f64; BINS + 3]; 3];
    for t in terms() {
        let p = power[t.index as usize] * t.weight;
        let bin = t.bin as usize;
        for (sum, part) in sums.iter_mut().zip([1., t.along_x, 1. - t.along_x]) {
            sum[bin] += f64::from(p * part * (1. - t.upper_share));
            sum[bin + 1] += f64::from(p * part * t.upper_share);
        }
    }
    sums
}

/// Returns the sum of the weights of all terms in each bin; sums of power are divided by it to give
/// means.
fn bin_weights() -> &'static [[f64; BINS + 3]; 3] {
    /// Sums of weights, computed on first use.
    static WEIGHTS: OnceLock<[[f64; BINS + 3]; 3]> = OnceLock::new();
    WEIGHTS.get_or_init(|| {
        let mut sums = [[0f64; BINS + 3]; 3];
        for t in terms() {
            let bin = t.bin as usize;
            for (sum, part) in sums.iter_mut().zip([1., t.along_x, 1. - t.along_x]) {
                sum[bin] += f64::from(t.weight * part * (1. - t.upper_share));
                sum[bin + 1] += f64::from(t.weight * part * t.upper_share);
            }
        }
        sums
    })
}

impl RingProfile {
    /// Returns the profile of a flattened image (see [`crate::detect::flatten()`]) of at most
    /// 512 × 512 px, or of the upper left of a larger one.
    pub fn of(flat: &Plane) -> Self {
        Self::from_powers([&power_of(flat)], flat.dim())
    }

    /// Returns the profile of the mean power of tiles of `height` × `width` px.
    pub(super) fn from_powers<'a>(
        tiles: impl IntoIterator<Item = &'a Power>,
        (height, width): (usize, usize),
    ) -> Self {
        let mut sums: Power = [[0.; BINS + 3]; 3];
        let mut count = 0f64;
        for tile in tiles {
            count += 1.;
            sums.iter_mut().flatten().zip(tile.iter().flatten()).for_each(|(sum, power)| *sum += power);
        }
        let channel = |c: usize| {
            std::array::from_fn(|b| {
                // the floors of 1e-12 prevent a division by 0 and the logarithm of 0
                let power = sums[c][b + 1] / count.max(1.);
                (power / bin_weights()[c][b + 1].max(1e-12) + 1e-12).ln() as f32
            })
        };
        let [all, along_x, across_x] = [0, 1, 2].map(channel);
        let mut scores = ring_network::scores([&all, &along_x, &across_x]);
        let widest = (height.min(width) as f64 / PERIODS).clamp(SPACING_RANGE.0, SPACING_RANGE.1);
        for (k, score) in scores.iter_mut().enumerate() {
            if candidate(k as f64) > widest {
                *score = f32::NEG_INFINITY;
            }
        }
        Self { all, scores }
    }

    /// Returns the spacing: the most probable candidate, refined by a parabola.
    ///
    /// The probabilities are those of a small network (see `ring_network`).
    pub fn spacing(&self) -> RingEstimate {
        let spacing = self.peak_among(|_| true);
        RingEstimate { spacing, confidence: self.probability_near(spacing), least: self.least().min(spacing) }
    }

    /// Returns the most probable spacing, in px, that differs from `spacing` by at most the factor
    /// `factor`, up or down.
    pub(super) fn spacing_near(&self, spacing: f64, factor: f64) -> f64 {
        self.peak_among(|s| (s / spacing).ln().abs() <= factor.ln())
    }

    /// Returns the most probable spacing, in px, among the candidates that are `allowed`.
    fn peak_among(&self, allowed: impl Fn(f64) -> bool) -> f64 {
        let peak = (0..CANDIDATES)
            .filter(|k| allowed(candidate(*k as f64)))
            .max_by(|&a, &b| self.scores[a].total_cmp(&self.scores[b]))
            .unwrap_or(CANDIDATES - 1);
        // the first and the last candidate have no neighbour on one side, so they are not refined
        let offset = match self.scores.get(peak.wrapping_sub(1)..peak + 2) {
            Some(&[a, b, c]) if a.is_finite() && a - 2. * b + c < 0. => {
                f64::from(0.5 * (a - c) / (a - 2. * b + c)).clamp(-0.5, 0.5)
            }
            _ => 0.,
        };
        candidate(peak as f64 + offset)
    }

    /// Returns the spacing, in px, below which the true one lies with the probability [`CLOSER`].
    ///
    /// Within a bin, the probability is spread evenly.
    fn least(&self) -> f64 {
        let shares: Vec<f64> = self.probabilities().collect();
        let mut closer = 0.;
        for (k, share) in shares.iter().enumerate().rev() {
            closer += share;
            if closer > CLOSER {
                return candidate(k as f64 - 0.5 + (closer - CLOSER) / share);
            }
        }
        SPACING_RANGE.1
    }

    /// Returns the probability (0–1) that the true spacing is within 15 % of `spacing`, in px.
    fn probability_near(&self, spacing: f64) -> f64 {
        let near = |s: f64| (s / spacing).ln().abs() <= RIGHT.ln();
        self.probabilities().enumerate().filter(|(k, _)| near(candidate(*k as f64))).map(|(_, p)| p).sum()
    }

    /// Returns the probability of each candidate, 0–1.
    fn probabilities(&self) -> impl Iterator<Item = f64> {
        let highest = self.scores.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let odds = move |score: f32| f64::from(score - highest).exp();
        let sum: f64 = self.scores.iter().map(|s| odds(*s)).sum();
        self.scores.iter().map(move |s| odds(*s) / sum)
    }

    /// Returns the clarity of an image whose cones are `spacing` px apart.
    ///
    /// The clarity is the natural logarithm of the ratio of the power around the ring to that of
    /// detail finer than any cone: above 6 on a clear image, 2 where noise is as strong as the
    /// cones.
    pub fn clarity(&self, spacing: f64) -> f64 {
        // bands are several bins wide, so none is empty
        let mean = |low: f64, high: f64| {
            let bin = |bin: f64| bin.clamp(0., (BINS - 1) as f64) as usize;
            let band = &self.all[bin(bin_of(spacing / low).ceil())..=bin(bin_of(spacing / high).floor())];
            band.iter().map(|p| f64::from(*p)).sum::<f64>() / band.len() as f64
        };
        // where cones are few px apart, the spectrum ends before the finest detail
        let finest = FINEST.min(0.5 * spacing / FINEST_BAND);
        mean(RING_BAND.0, RING_BAND.1) - mean(finest / FINEST_BAND, finest * FINEST_BAND)
    }

    /// Returns the natural logarithm of the power at 15 frequencies around the ring of cones
    /// `spacing` px apart, less the mean over all bins.
    ///
    /// The frequencies run from 1.5 octaves below the ring's to two octaves above it, in steps of a
    /// quarter octave. Each value is the mean over five bins.
    pub fn around(&self, spacing: f64) -> [f64; AROUND] {
        /// Quarter of an octave, in bins.
        const STEP: f64 = PER_OCTAVE / 4.;
        let ring = bin_of(spacing);
        let at = |bin: f64| f64::from(self.all[bin.clamp(0., (BINS - 1) as f64) as usize]);
        let mean = self.all.iter().map(|p| f64::from(*p)).sum::<f64>() / BINS as f64;
        std::array::from_fn(|k| {
            let middle = (ring + STEP * (k as f64 - 6.)).round();
            (-2..=2).map(|j| at(middle + f64::from(j))).sum::<f64>() / 5. - mean
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns an image of a triangular lattice of Gaussian spots.
    fn lattice_image(side: usize, spacing: f64) -> Plane {
        let row = spacing * 3f64.sqrt() / 2.;
        Plane::from_shape_fn((side, side), |(y, x)| {
            let (x, y) = (x as f64, y as f64);
            let nearest = (-1..=1)
                .flat_map(|dj| {
                    let j = (y / row).round() + f64::from(dj);
                    let shift = if j.rem_euclid(2.) == 0. { 0. } else { 0.5 };
                    let i = (x / spacing - shift).round() + shift;
                    [(x - i * spacing).powi(2) + (y - j * row).powi(2)]
                })
                .fold(f64::INFINITY, f64::min);
            (-nearest / (2. * (0.2 * spacing).powi(2))).exp() as f32
        })
    }

    #[test]
    fn ring_radius_matches_spacing() {
        for (side, spacing) in [(150, 6.), (150, 10.), (300, 18.), (500, 9.)] {
            let flat = crate::detect::flatten(&lattice_image(side, spacing));
            let estimate = RingProfile::of(&flat).spacing();
            assert!((estimate.spacing / spacing - 1.).abs() < 0.15, "{spacing}: {estimate:?}");
        }
    }
}
