//! A small network that estimates the cone spacing from a power spectrum.
//!
//! It consists of three convolutions along log-frequency, so that a ring looks the same at any
//! spacing. It was trained by `scripts/train-ring` on hand-marked and simulated images of all
//! modalities, clear, noisy and blurred.

use super::bins::{BINS, CANDIDATES, FIRST};
use std::sync::OnceLock;

/// Number of neighbouring bins that each output of a convolution depends on: an octave, half of it
/// on either side.
const TAPS: usize = 25;
/// Numbers of channels into and out of the convolutions.
///
/// The input is the power in all directions, along x and across x; the output is the score of a
/// spacing.
const WIDTHS: [usize; 4] = [3, 16, 16, 1];

/// File of the weights (out × in × taps) and biases of one convolution after the other, as 32-bit
/// floats, little endian.
static FILE: &[u8; 4 * COUNT] = include_bytes!("ring.f32");
/// Number of weights and biases in the file.
const COUNT: usize = count(0) + count(1) + count(2);

/// Returns the number of weights and biases of a layer.
const fn count(layer: usize) -> usize {
    WIDTHS[layer + 1] * (WIDTHS[layer] * TAPS + 1)
}

/// Returns the file of the weights, on which results depend.
pub(in crate::detect) const fn weights() -> &'static [u8] {
    FILE
}

/// The channels of a spectrum or of a layer's output, one after the other.
type Channels = Vec<[f32; BINS]>;

/// Returns the logarithm of the odds, up to a constant, that each candidate is the cone spacing.
///
/// Candidates run from the widest to the closest. `log_power` is the logarithm of the power over
/// all directions, along x and across x.
pub(super) fn scores(log_power: [&[f32; BINS]; 3]) -> [f32; CANDIDATES] {
    /// Numbers in [`FILE`], converted on first use.
    static WEIGHTS: OnceLock<Vec<f32>> = OnceLock::new();
    let mut weights =
        &WEIGHTS.get_or_init(|| FILE.as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect())[..];
    let mut maps: Channels = log_power.map(above_mean).to_vec();
    for layer in 0..WIDTHS.len() - 1 {
        // weights and biases of this layer
        let own;
        (own, weights) = weights.split_at(count(layer));
        let (taps, biases) = own.split_at(own.len() - WIDTHS[layer + 1]);
        maps = taps
            .chunks_exact(WIDTHS[layer] * TAPS)
            .zip(biases)
            .map(|(t, b)| convolve(&maps, t, *b))
            .collect();
        // the last layer gives scores, which may be negative
        if layer + 2 < WIDTHS.len() {
            maps.as_flattened_mut().iter_mut().for_each(|v| *v = v.max(0.));
        }
    }
    std::array::from_fn(|k| maps[0][FIRST + k])
}

/// Returns a profile less its mean, so that the gain of the image does not matter.
fn above_mean(profile: &[f32; BINS]) -> [f32; BINS] {
    let mean = profile.iter().sum::<f32>() / BINS as f32;
    profile.map(|p| p - mean)
}

/// Returns the sum of the channels' convolutions with their `taps`, plus `bias`.
///
/// Beyond either end, a channel continues with its outermost value.
fn convolve(channels: &Channels, taps: &[f32], bias: f32) -> [f32; BINS] {
    /// Number of taps on either side of the middle one.
    const HALF: usize = TAPS / 2;
    let mut sum = [bias; BINS];
    for (channel, taps) in channels.iter().zip(taps.chunks_exact(TAPS)) {
        let longer: [f32; BINS + 2 * HALF] =
            std::array::from_fn(|k| channel[k.saturating_sub(HALF).min(BINS - 1)]);
        for (k, tap) in taps.iter().enumerate() {
            sum.iter_mut().zip(&longer[k..]).for_each(|(s, v)| *s += tap * v);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `scripts/train-ring` wrote the fixture beside the weights.
    #[test]
    fn scores_are_those_of_the_network_that_was_trained() {
        let rows: Vec<Vec<Option<f32>>> = include_str!("../../../fixtures/ring_network.csv")
            .lines()
            .skip(1)
            .map(|line| line.split(',').map(|v| v.parse().ok()).collect())
            .collect();
        assert_eq!(rows.len(), BINS);
        let [all, along_x, across_x] = [0, 1, 2].map(|c| std::array::from_fn(|b| rows[b][c].unwrap()));
        let expected: Vec<f32> = rows.iter().filter_map(|row| row[3]).collect();
        let found = scores([&all, &along_x, &across_x]);
        assert_eq!(expected.len(), found.len());
        for (expected, found) in expected.iter().zip(found) {
            assert!((expected - found).abs() < 1e-3, "{found}, trained: {expected}");
        }
    }
}
