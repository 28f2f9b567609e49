//! Cholesky decomposition of a symmetric matrix into L Lᵀ, for matrices whose rows may be
//! dependent.

/// Lower triangle L of a symmetric matrix L Lᵀ.
///
/// A row that depends on earlier ones is left out.
pub(crate) struct Cholesky {
    /// Number of rows and columns.
    n: usize,
    /// Entries of L, row by row, with zeros above the diagonal.
    lower: Vec<f64>,
    /// `true` for every row that does not depend on earlier ones.
    own: Vec<bool>,
}

impl Cholesky {
    /// Decomposes an n × n matrix, given by row and column.
    ///
    /// A row counts as dependent on earlier ones if at most the fraction `least`, 0–1, of its
    /// diagonal entry is left after their parts are subtracted.
    pub(crate) fn new(n: usize, least: f64, matrix: impl Fn(usize, usize) -> f64) -> Self {
        let mut lower = vec![0.; n * n];
        let mut own = vec![true; n];
        for i in 0..n {
            // slices instead of indices, because long decompositions spend their time in this loop
            let (above, row) = lower.split_at_mut(i * n);
            for j in 0..i {
                let earlier = &above[j * n..=j * n + j];
                let dot: f64 = row[..j].iter().zip(earlier).map(|(x, y)| x * y).sum();
                row[j] = if own[j] { (matrix(i, j) - dot) / earlier[j] } else { 0. };
            }
            let dot: f64 = row[..i].iter().map(|x| x * x).sum();
            let rest = matrix(i, i) - dot;
            own[i] = rest > least * matrix(i, i);
            row[i] = if own[i] { rest.sqrt() } else { 1. };
        }
        Self { n, lower, own }
    }

    /// Returns whether row `k` does not depend on earlier ones.
    pub(crate) fn is_own(&self, k: usize) -> bool {
        self.own[k]
    }

    /// Returns whether the diagonal of every row is finite and no row depends on others.
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
