//! Solver of graph Laplacians: conjugate gradients, preconditioned by aggregation multigrid.
//!
//! 1. Group the nodes of the graph, and the groups again, down to a small graph.
//! 2. In each round, make a Gauss–Seidel sweep, remove the smooth part of the error by a correction
//!    from the grouped graph, and sweep back. The result is the preconditioned residual of
//!    conjugate gradients.
//!
//! Sources: Vaněk, Mandel and Brezina (1996), <https://doi.org/10.1007/BF02238511>; Notay (2010).

use super::laplacian::Laplacian;

/// Largest number of nodes for which a system is solved by sweeps alone, without further grouping.
const SMALL: usize = 24;
/// Number of pairs of Gauss–Seidel sweeps, down and up, that solve a system of at most [`SMALL`]
/// nodes.
const SWEEPS: usize = 12;
/// Factor by which corrections from a coarser level are enlarged.
///
/// A correction that is constant on each group has too much energy for its size, so the coarse
/// system makes it too small.
const OVERCORRECTION: f64 = 1.6;

/// Hierarchy of Laplacians, each of larger groups of nodes than the one before.
///
/// An error that is smooth on one level is rough on the next, where sweeps remove it.
pub(super) struct Multigrid {
    levels: Vec<Level>,
}

/// Laplacian of one level of the hierarchy, with the working memory for its cycle.
struct Level {
    matrix: Laplacian,
    /// Group to which each node belongs; the group is a node of the next level.
    groups: Vec<u32>,
    /// Product of the matrix and the current solution.
    rest: Vec<f64>,
    /// Right-hand side of the next level.
    below: Vec<f64>,
    /// Solution of the next level.
    correction: Vec<f64>,
}

impl Multigrid {
    pub(super) fn new(matrix: Laplacian) -> Self {
        let mut levels = Vec::new();
        let mut matrix = matrix;
        loop {
            let n = matrix.len();
            let (groups, count) = if n > SMALL { matrix.groups() } else { (Vec::new(), n) };
            let coarse = (count < n).then(|| matrix.grouped(&groups, count));
            levels.push(Level {
                matrix,
                groups,
                rest: vec![0.; n],
                below: vec![0.; count],
                correction: vec![0.; count],
            });
            match coarse {
                Some(next) => matrix = next,
                None => return Self { levels },
            }
        }
    }

    /// Solves L x = b and returns the number of rounds used.
    ///
    /// `b` must have mean 0. The rounds of conjugate gradients end when the root mean square of the
    /// residual is at most `tolerance` times that of `b`, or after `most` rounds.
    pub(super) fn solve(&mut self, b: &[f64], x: &mut Vec<f64>, tolerance: f64, most: usize) -> usize {
        let n = b.len();
        x.clear();
        x.resize(n, 0.);
        let mut rest = b.to_vec();
        let (mut z, mut image) = (vec![0.; n], vec![0.; n]);
        let end = tolerance * tolerance * dot(b, b);
        let mut direction: Vec<f64> = Vec::new();
        let mut product = 0.;
        for round in 0..most {
            if dot(&rest, &rest) <= end {
                return round;
            }
            z.fill(0.);
            cycle(&mut self.levels, &rest, &mut z);
            centre(&mut z);
            let next = dot(&rest, &z);
            if next.is_nan() || next <= 0. {
                return round;
            }
            if direction.is_empty() {
                direction.clone_from(&z);
            } else {
                let share = next / product;
                direction.iter_mut().zip(&z).for_each(|(d, z)| *d = z + share * *d);
            }
            product = next;
            self.levels[0].matrix.apply(&direction, &mut image);
            let step = product / dot(&direction, &image);
            if !step.is_finite() {
                return round;
            }
            for i in 0..n {
                x[i] += step * direction[i];
                rest[i] -= step * image[i];
            }
        }
        most
    }
}

/// Runs one multigrid cycle, which moves x from 0 towards the solution of the first level's system.
///
/// The map from b to x is symmetric, as conjugate gradients need.
fn cycle(levels: &mut [Level], b: &[f64], x: &mut [f64]) {
    let Some((level, coarser)) = levels.split_first_mut() else { return };
    if coarser.is_empty() {
        for _ in 0..SWEEPS {
            level.matrix.sweep_down(b, x);
            level.matrix.sweep_up(b, x);
        }
        return;
    }
    level.matrix.sweep_down(b, x);
    level.matrix.apply(x, &mut level.rest);
    level.below.fill(0.);
    for (i, &group) in level.groups.iter().enumerate() {
        level.below[group as usize] += b[i] - level.rest[i];
    }
    level.correction.fill(0.);
    cycle(coarser, &level.below, &mut level.correction);
    for (x, &group) in x.iter_mut().zip(&level.groups) {
        *x += OVERCORRECTION * level.correction[group as usize];
    }
    level.matrix.sweep_up(b, x);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Subtracts the mean from all values.
pub(super) fn centre(x: &mut [f64]) {
    let mean = x.iter().sum::<f64>() / x.len().max(1) as f64;
    x.iter_mut().for_each(|x| *x -= mean);
}
