//! Cholesky decomposition of a symmetric matrix into L Lᵀ, which also works if rows depend linearly
//! on each other.

/// Lower triangular factor L of a symmetric matrix L Lᵀ.
///
/// A row that is a linear combination of earlier rows does not contribute to later rows;
/// [`Self::is_own`] returns `false` for it.
pub(crate) struct Cholesky {
    /// Number of rows and columns.
    n: usize,
    /// Entries of L, row by row, with zeros above the diagonal.
    lower: Vec<f64>,
    /// One flag per row: `true` if the row is linearly independent of the rows before it.
    own: Vec<bool>,
}

impl Cholesky {
    /// Decomposes the `n` × `n` matrix whose entry in row i and column k is `matrix(i, k)`.
    ///
    /// Earlier rows are projected out of each row in turn. A row counts as dependent on them if at
    /// most the fraction `least` (0–1) of its diagonal entry is left.
    pub(crate) fn new(n: usize, least: f64, matrix: impl Fn(usize, usize) -> f64) -> Self {
        let mut lower = vec![0.; n * n];
        let mut own = vec![true; n];
        for i in 0..n {
            // Slices are faster than indices here, and large decompositions spend their time in
            // this loop.
            let (above, row) = lower.split_at_mut(i * n);
            for j in 0..i {
                let earlier = &above[j * n..=j * n + j];
                let dot: f64 = row[..j].iter().zip(earlier).map(|(x, y)| x * y).sum();
                row[j] = if own[j] { (matrix(i, j) - dot) / earlier[j] } else { 0. };
            }
            let dot: f64 = row[..i].iter().map(|x| x * x).sum();
            let rest = matrix(i, i) - dot;
            own[i] = rest > least * matrix(i, i);
            // The entry 1 for a dependent row keeps the divisions by diagonal entries defined.
            row[i] = if own[i] { rest.sqrt() } else { 1. };
        }
        Self { n, lower, own }
    }

    /// Returns whether row `k` is linearly independent of the rows before it.
    pub(crate) fn is_own(&self, k: usize) -> bool {
        self.own[k]
    }

    /// Returns whether all diagonal entries of L are finite and no row depends on earlier rows.
    pub(crate) fn is_whole(&self) -> bool {
        (0..self.n).all(|k| self.own[k] && self.lower[k * self.n + k].is_finite())
    }

    /// Solves L y = x in place: x ← L⁻¹ x.
    pub(crate) fn forward(&self, x: &mut [f64]) {
        for i in 0..self.n {
            let dot: f64 = (0..i).map(|k| self.lower[i * self.n + k] * x[k]).sum();
            x[i] = (x[i] - dot) / self.lower[i * self.n + i];
        }
    }

    /// Solves Lᵀ y = x in place: x ← L⁻ᵀ x.
    pub(crate) fn backward(&self, x: &mut [f64]) {
        for i in (0..self.n).rev() {
            let dot: f64 = (i + 1..self.n).map(|k| self.lower[k * self.n + i] * x[k]).sum();
            x[i] = (x[i] - dot) / self.lower[i * self.n + i];
        }
    }
}
