/// The y of (A + μ) y = b for a symmetric, not negative A, μ being `damping` times the mean of its diagonal: by Cholesky's
/// decomposition. `None` if that breaks down.
pub(crate) fn solve(a: &[f64], damping: f64, b: &[f64]) -> Option<Vec<f64>> {
    let n = b.len();
    let trace: f64 = (0..n).map(|i| a[i * n + i]).sum();
    let mu = damping * trace / n as f64;
    let mut l = a.to_vec();
    for i in 0..n {
        let (above, row) = l.split_at_mut(i * n);
        for j in 0..i {
            let earlier = &above[j * n..=j * n + j];
            let sum: f64 = row[..j].iter().zip(earlier).map(|(x, y)| x * y).sum();
            row[j] = (row[j] - sum) / earlier[j];
        }
        let sum: f64 = row[..i].iter().map(|x| x * x).sum();
        let pivot = row[i] + mu - sum;
        if !(pivot.is_finite() && pivot > 0.) {
            return None;
        }
        row[i] = pivot.sqrt();
    }
    let mut y = b.to_vec();
    for i in 0..n {
        let sum: f64 = (0..i).map(|k| l[i * n + k] * y[k]).sum();
        y[i] = (y[i] - sum) / l[i * n + i];
    }
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..n).map(|k| l[k * n + i] * y[k]).sum();
        y[i] = (y[i] - sum) / l[i * n + i];
    }
    Some(y)
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
