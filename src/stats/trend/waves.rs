//! Sums of cosine waves over the points of the unit square.

use std::f64::consts::{PI, SQRT_2};

/// Returns the mean square of the sums of waves √2cos(jπx) · √2cos(kπy) over points of the unit
/// square.
///
/// `modes` holds the pairs (j, k). Where j or k is 0, the factor with this number is 1 instead, so
/// that every wave has mean square 1 over the unit square.
pub(super) fn mean_square(unit: &[(f64, f64)], modes: &[(usize, usize)]) -> f64 {
    let most = modes.iter().map(|&(j, k)| j.max(k)).max().unwrap_or(0);
    let (mut across, mut down) = (vec![1.; most + 1], vec![1.; most + 1]);
    let mut sums = vec![0.; modes.len()];
    for &(u, v) in unit {
        waves(u, &mut across);
        waves(v, &mut down);
        for (sum, &(j, k)) in sums.iter_mut().zip(modes) {
            *sum += across[j] * down[k];
        }
    }
    sums.iter().map(|s| s * s).sum::<f64>() / modes.len() as f64
}

/// Fills `values` with 1, √2cos(πu), √2cos(2πu) …, by the recurrence cos((j+1)t) = 2 cos t cos jt −
/// cos((j−1)t).
pub(super) fn waves(u: f64, values: &mut [f64]) {
    let cosine = (PI * u).cos();
    let (mut before, mut now) = (cosine, 1.);
    for (j, value) in values.iter_mut().enumerate() {
        *value = if j == 0 { 1. } else { SQRT_2 * now };
        (before, now) = (now, 2. * cosine * now - before);
    }
}
