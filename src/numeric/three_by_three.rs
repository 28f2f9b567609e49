//! Inverse, eigenvalues and eigenvectors of 3 × 3 matrices.

use std::f64::consts::TAU;

/// Returns the inverse of a 3 × 3 matrix by its cofactors.
///
/// Returns `None` if the absolute value of the determinant is not above 10⁻¹⁴, a limit that suits
/// matrices whose entries are near 1, or if it is not finite.
pub(crate) fn inverted(m: [[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    let cofactor = |i: usize, j: usize| {
        let (r, s, u, v) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[r][u] * m[s][v] - m[r][v] * m[s][u]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    let ok = determinant.is_finite() && determinant.abs() > 1e-14;
    ok.then(|| std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / determinant)))
}

/// Returns the eigenvalues of a 3 × 3 matrix, all of which must be real.
///
/// The eigenvalues are the roots of the characteristic polynomial, a cubic, which is solved by
/// Viète's trigonometric formula.
pub(crate) fn eigenvalues(m: [[f64; 3]; 3]) -> [f64; 3] {
    let trace = m[0][0] + m[1][1] + m[2][2];
    let minors = m[0][0] * m[1][1] - m[0][1] * m[1][0] + m[0][0] * m[2][2] - m[0][2] * m[2][0]
        + m[1][1] * m[2][2]
        - m[1][2] * m[2][1];
    let determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
        - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    // with λ = trace/3 + u, the characteristic polynomial becomes u³ − 3 p u − 2 q = 0
    let shift = trace / 3.;
    let p = (shift * shift - minors / 3.).max(0.);
    let q = (determinant - minors * shift) / 2. + shift * shift * shift;
    let root = p.sqrt();
    let cosine = if root > 0. { (q / (p * root)).clamp(-1., 1.) } else { 0. };
    let angle = cosine.acos() / 3.;
    [0., 1., 2.].map(|k| shift + 2. * root * (angle + k * TAU / 3.).cos())
}

/// Returns the unit eigenvector of `m` for the eigenvalue `value`.
///
/// The eigenvector is perpendicular to all rows of `m` − `value`·I, so it is the cross product of
/// two of them. Returns `None` if all rows are parallel, so that the direction is not unique.
pub(crate) fn eigenvector(mut m: [[f64; 3]; 3], value: f64) -> Option<[f64; 3]> {
    (0..3).for_each(|k| m[k][k] -= value);
    let product = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let length = |v: &[f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
    let candidates = [product(m[0], m[1]), product(m[1], m[2]), product(m[2], m[0])];
    let best = candidates.into_iter().max_by(|a, b| length(a).total_cmp(&length(b)))?;
    let size = length(&best);
    (size.is_finite() && size > 0.).then(|| best.map(|c| c / size))
}

#[cfg(test)]
mod tests {
    use super::*;

    const M: [[f64; 3]; 3] = [[2., 1., 0.], [1., 3., 1.], [0., 1., 4.]];

    fn times(m: [[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
        m.map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
    }

    #[test]
    fn an_inverse_undoes_its_matrix() {
        let back = times(inverted(M).unwrap(), times(M, [1., -2., 5.]));
        assert!(back.iter().zip([1., -2., 5.]).all(|(a, b)| (a - b).abs() < 1e-12), "{back:?}");
        assert_eq!(inverted([[1., 2., 3.], [2., 4., 6.], [0., 0., 1.]]), None);
    }

    #[test]
    fn a_matrix_stretches_its_eigenvectors_by_its_eigenvalues() {
        for value in eigenvalues(M) {
            let vector = eigenvector(M, value).unwrap();
            let stretched = times(M, vector);
            assert!(stretched.iter().zip(vector).all(|(a, b)| (a - value * b).abs() < 1e-9), "{value}");
        }
        assert_eq!(eigenvector([[0.; 3]; 3], 0.), None);
    }
}
