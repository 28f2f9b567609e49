//! A small network with one hidden layer that tells modalities apart by their
//! [`Features`](super::features::Features), and a logistic regression that tells whether cones in a
//! split-detector image are dark on the left or on the right.
//!
//! Both are trained by `scripts/train-modality`.

use super::features::{DIRECTION, MODALITY};
use crate::detect::Modality;
use std::sync::OnceLock;
use strum::VariantArray;

/// Number of units of the hidden layer: 16 for each of four networks whose scores are averaged.
const HIDDEN: usize = 64;
/// Number of outputs: one score per modality.
const CLASSES: usize = Modality::VARIANTS.len();

/// File of the weights (out × in) and biases of both layers, then the weights of the logistic
/// regression, as 32-bit floats, little endian.
///
/// Modalities are in the order of [`Modality::VARIANTS`].
static FILE: &[u8; 4 * COUNT] = include_bytes!("modality.f32");
/// Number of weights and biases of the hidden layer.
const FIRST: usize = HIDDEN * (MODALITY + 1);
/// Number of weights and biases of the output layer.
const LAST: usize = CLASSES * (HIDDEN + 1);
/// Number of 32-bit floats in the file.
const COUNT: usize = FIRST + LAST + DIRECTION;

/// Returns the file of the weights, on which results depend.
pub(in crate::detect) const fn weights() -> &'static [u8] {
    FILE
}

/// Returns the numbers in the file.
fn numbers() -> &'static [f64] {
    /// Numbers in [`FILE`], converted on first use.
    static NUMBERS: OnceLock<Vec<f64>> = OnceLock::new();
    NUMBERS.get_or_init(|| FILE.as_chunks().0.iter().map(|b| f64::from(f32::from_le_bytes(*b))).collect())
}

/// Returns the most probable modality and its probability, 0–1.
pub(super) fn most_probable(features: &[f64; MODALITY]) -> (Modality, f64) {
    let scores = scores(features);
    let best = (0..CLASSES).max_by(|&a, &b| scores[a].total_cmp(&scores[b])).unwrap_or(0);
    let sum: f64 = scores.iter().map(|s| (s - scores[best]).exp()).sum();
    (Modality::VARIANTS[best], 1. / sum)
}

/// Returns the logarithm of the odds of each modality, up to a constant.
fn scores(features: &[f64; MODALITY]) -> [f64; CLASSES] {
    let (first, rest) = numbers().split_at(FIRST);
    let hidden: [f64; HIDDEN] = layer::<MODALITY, HIDDEN>(first, features).map(f64::tanh);
    layer(&rest[..LAST], &hidden)
}

/// Returns the evidence, in logits, that cones in a split-detector image are dark on the left.
pub(super) fn dark_left(features: &[f64; DIRECTION]) -> f64 {
    numbers()[FIRST + LAST..].iter().zip(features).map(|(w, f)| w * f).sum()
}

/// Returns the outputs of a layer before its activation.
fn layer<const IN: usize, const OUT: usize>(weights: &[f64], inputs: &[f64; IN]) -> [f64; OUT] {
    let (factors, biases) = weights.split_at(IN * OUT);
    std::array::from_fn(|k| {
        let own = &factors[k * IN..(k + 1) * IN];
        biases[k] + own.iter().zip(inputs).map(|(w, v)| w * v).sum::<f64>()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `scripts/train-modality` wrote the fixture beside the weights: features and scores of some
    /// images.
    #[test]
    fn scores_are_those_of_the_network_that_was_trained() {
        let mut rows = 0;
        for line in include_str!("../../../fixtures/modality_network.csv").lines().skip(1) {
            let values: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
            let (features, expected) = values.split_at(MODALITY);
            for (expected, found) in expected.iter().zip(scores(features.try_into().unwrap())) {
                assert!((expected - found).abs() < 1e-3, "{found}, trained: {expected}");
            }
            rows += 1;
        }
        assert!(rows >= 6);
    }
}
