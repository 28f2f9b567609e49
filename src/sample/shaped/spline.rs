//! Cubic B-spline on nodes 1 apart. The values of a spline at the nodes sum to 1, and its standard
//! deviation is 1/√3.

/// Returns the values, at the nodes −1, 0, 1 and 2, of a spline centred at `u`, where 0 ≤ u < 1.
#[inline]
pub(super) fn weights(u: f64) -> [f64; 4] {
    let v = 1. - u;
    let middle = |t: f64| 2. / 3. - t * t + 0.5 * t * t * t;
    [v * v * v / 6., middle(u), middle(v), u * u * u / 6.]
}

/// Returns the derivatives of [`weights`] with respect to `u`.
#[inline]
pub(super) fn slopes(u: f64) -> [f64; 4] {
    let v = 1. - u;
    let middle = |t: f64| -2. * t + 1.5 * t * t;
    [-0.5 * v * v, middle(u), -middle(v), 0.5 * u * u]
}

/// Returns the value of the spline at distance `t` from its centre.
pub(super) fn at(t: f64) -> f64 {
    match t.abs() {
        t if t < 1. => 2. / 3. - t * t + 0.5 * t * t * t,
        t if t < 2. => (2. - t).powi(3) / 6.,
        _ => 0.,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_to_one_and_slopes_are_their_differences() {
        for u in [0., 0.2, 0.5, 0.99] {
            let (w, s) = (weights(u), slopes(u));
            assert!((w.iter().sum::<f64>() - 1.).abs() < 1e-12);
            for k in 0..4 {
                assert!((w[k] - at(u - (k as f64 - 1.))).abs() < 1e-12);
                let difference = (weights(u + 1e-6)[k] - weights(u - 1e-6)[k]) / 2e-6;
                assert!((s[k] - difference).abs() < 1e-8);
            }
        }
    }
}
