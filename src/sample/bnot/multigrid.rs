use super::laplacian::Laplacian;

/// Nodes of a system that is solved by sweeps alone, and how many.
const SMALL: usize = 24;
const SWEEPS: usize = 12;
/// What a correction that is constant on groups lacks: its energy is too large, so it comes out too small.
const OVERCORRECTION: f64 = 1.6;

/// A Laplacian and those of ever larger groups of its nodes: errors that are smooth on one are rough on the next, where
/// sweeps remove them (aggregation multigrid; Vaněk et al. 1996, Notay 2010). As preconditioner of conjugate gradients.
pub(super) struct Multigrid {
    levels: Vec<Level>,
}

struct Level {
    matrix: Laplacian,
    /// Group of each node: its node on the next level.
    groups: Vec<u32>,
    rest: Vec<f64>,
    /// Right-hand side and solution of the next level, and a second solution.
    below: Vec<f64>,
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

    /// Solves L x = b, b without mean, by preconditioned conjugate gradients until the remainder is `tolerance` times b
    /// in the mean square, or `most` rounds. How many rounds it took.
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

/// x nearer to the solution of the first level's system, from 0; symmetric in b.
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

/// Takes the mean off.
pub(super) fn centre(x: &mut [f64]) {
    let mean = x.iter().sum::<f64>() / x.len().max(1) as f64;
    x.iter_mut().for_each(|x| *x -= mean);
}
