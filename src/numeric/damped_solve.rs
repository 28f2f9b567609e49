use super::cholesky::Cholesky;

/// Solves (A + μI) y = b for y by Cholesky decomposition; A is symmetric and positive semidefinite.
///
/// `a` contains A row by row. The damping μ is `damping` times the mean of the diagonal of A. It
/// keeps equations solvable that depend almost linearly on each other. Returns `None` if a pivot of
/// the decomposition is not positive and finite.
pub(crate) fn solve(a: &[f64], damping: f64, b: &[f64]) -> Option<Vec<f64>> {
    let n = b.len();
    let trace: f64 = (0..n).map(|i| a[i * n + i]).sum();
    let mu = damping * trace / n as f64;
    let entry = |i: usize, k: usize| if i == k { a[i * n + k] + mu } else { a[i * n + k] };
    let factor = Cholesky::new(n, 0., entry);
    let mut y = b.to_vec();
    factor.forward(&mut y);
    factor.backward(&mut y);
    factor.is_whole().then_some(y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solution_solves_the_damped_equations() {
        let a = [4., 2., 0.6, 2., 5., 1., 0.6, 1., 3.];
        let b = [1., -2., 3.];
        let y = solve(&a, 0.5, &b).unwrap();
        for i in 0..3 {
            let left: f64 = (0..3).map(|k| a[i * 3 + k] * y[k]).sum::<f64>() + 0.5 * 4. * y[i];
            assert!((left - b[i]).abs() < 1e-12);
        }
    }

    #[test]
    fn equations_without_a_solution_are_refused() {
        assert_eq!(solve(&[0., 0., 0., 0.], 1e-3, &[1., 1.]), None);
        assert_eq!(solve(&[f64::NAN; 4], 1e-3, &[1., 1.]), None);
    }
}
