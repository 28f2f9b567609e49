/// The lower triangle L of a symmetric matrix L Lᵀ. A row that depends on earlier ones is left out.
pub(crate) struct Cholesky {
    n: usize,
    lower: Vec<f64>,
    own: Vec<bool>,
}

impl Cholesky {
    /// Decomposes an n × n matrix, given by row and column. A row depends on earlier ones if of its square no more is
    /// left than the share `least`, 0–1.
    pub(crate) fn new(n: usize, least: f64, matrix: impl Fn(usize, usize) -> f64) -> Self {
        let mut lower = vec![0.; n * n];
        let mut own = vec![true; n];
        for i in 0..n {
            // slices instead of indices: this loop is what long decompositions spend their time in
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

    /// Says that row `k` does not depend on earlier ones.
    pub(crate) fn is_own(&self, k: usize) -> bool {
        self.own[k]
    }

    /// Says that every row is finite and none depends on others.
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
