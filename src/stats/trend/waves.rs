//! Sums of cosine waves over the points of the unit square.

use std::f64::consts::{PI, SQRT_2};

/// Returns the mean, over the modes (j, k), of the squared sum of √2cos(jπx) · √2cos(kπy) over the
/// points of the unit square.
///
/// `modes` contains the pairs (j, k). If j or k is 0, its factor is 1, so that every wave has mean
/// square 1.
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

/// Fills `values` with 1, √2cos(πu), √2cos(2πu) …
///
/// The cosines follow from the recurrence cos((j+1)t) = 2 cos t cos jt − cos((j−1)t), because a
/// cosine per wave and point would be slower.
pub(super) fn waves(u: f64, values: &mut [f64]) {
    let cosine = (PI * u).cos();
    // cos(−πu) and cos(0), from which the recurrence starts.
    let (mut before, mut now) = (cosine, 1.);
    for (j, value) in values.iter_mut().enumerate() {
        *value = if j == 0 { 1. } else { SQRT_2 * now };
        (before, now) = (now, 2. * cosine * now - before);
    }
}
