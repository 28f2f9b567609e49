//! Sums Σ_j exp(−2πi (kx x_j + ky y_j)) over points (x_j, y_j) of the unit torus, for integers kx
//! and ky.
//!
//! Few points and waves are summed directly, others by a non-uniform Fourier transform:
//!
//! 1. Spread each point over 14 × 14 cells of a grid with a smooth kernel.
//! 2. Transform the grid by FFT, first along rows, then along columns.
//! 3. Divide by the transform of the kernel.

use rayon::prelude::*;
use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex64;
use std::f64::consts::{PI, TAU};

/// Largest number of points times waves for which the terms are summed directly, which is then
/// faster than the grid.
const FEW: usize = 500_000;
/// Number w of grid cells over which a point is spread, along either axis.
///
/// With the oversampling σ of [`OVERSAMPLING`], the error by aliasing is exp(−πw√(1 − 1/σ)) =
/// 3·10⁻⁹ (Barnett, Magland & af Klinteberg 2019, eq. 4.1, <https://doi.org/10.1137/18M120885X>).
const WIDTH: usize = 14;
/// Oversampling σ: half the number of grid points per wavelength of the highest wave. It must be
/// above 1.
///
/// A larger σ would allow a narrower kernel, but make the Fourier transform larger.
const OVERSAMPLING: f64 = 1.25;
/// Shape β of the kernel exp(β(√(1 − z²) − 1)), for the width [`WIDTH`] and the oversampling
/// [`OVERSAMPLING`]. The factor .97 is that of the library FINUFFT.
const BETA: f64 = 0.97 * PI * WIDTH as f64 * (1. - 0.5 / OVERSAMPLING);

/// Computes the sums for 0 ≤ kx ≤ `columns` and |ky| ≤ `rows`, at index `kx · (2 rows + 1) + ky +
/// rows`.
///
/// `points` are the positions (x_j, y_j), from 0 to 1.
pub(super) fn sums(points: &[[f64; 2]], columns: usize, rows: usize) -> Vec<Complex64> {
    let waves = (columns + 1) * (2 * rows + 1);
    if points.len().saturating_mul(waves) <= FEW {
        direct(points, columns, rows)
    } else {
        gridded(points, columns, rows)
    }
}

/// Computes the same sums as [`sums`], term by term.
pub(super) fn direct(points: &[[f64; 2]], columns: usize, rows: usize) -> Vec<Complex64> {
    let height = 2 * rows + 1;
    let mut sums = vec![Complex64::default(); (columns + 1) * height];
    for p in points {
        let down: Vec<Complex64> =
            (0..height).map(|k| Complex64::cis(-TAU * (k as f64 - rows as f64) * p[1])).collect();
        for (kx, column) in sums.chunks_exact_mut(height).enumerate() {
            let across = Complex64::cis(-TAU * kx as f64 * p[0]);
            column.iter_mut().zip(&down).for_each(|(s, d)| *s += across * d);
        }
    }
    sums
}

/// Computes the same sums as [`sums`], by a non-uniform Fourier transform.
///
/// Sources: Dutt & Rokhlin (1993), <https://doi.org/10.1137/0914081>; kernel of Barnett et al.
/// (2019), <https://doi.org/10.1137/18M120885X>.
pub(super) fn gridded(points: &[[f64; 2]], columns: usize, rows: usize) -> Vec<Complex64> {
    let length = |highest: usize| {
        let least = (OVERSAMPLING * (2 * highest + 1) as f64).ceil() as usize;
        // The grid must be wider than the kernel, and a multiple of 32 keeps the Fourier transform
        // fast.
        least.max(2 * WIDTH).next_multiple_of(32)
    };
    let (width, height) = (length(columns), length(rows));
    let mut grid = spread(points, width, height);

    let plan = RealFftPlanner::<f64>::new().plan_fft_forward(width);
    let half = width / 2 + 1;
    // Only the requested waves of each row are kept.
    let mut kept = vec![Complex64::default(); height * (columns + 1)];
    kept.par_chunks_mut(columns + 1).zip(grid.par_chunks_mut(width)).for_each_init(
        || vec![Complex64::default(); half],
        |transformed, (out, row)| {
            let done = plan.process(row, transformed);
            debug_assert!(done.is_ok());
            out.copy_from_slice(&transformed[..=columns]);
        },
    );
    drop(grid);

    let plan = FftPlanner::new().plan_fft_forward(height);
    let (across, down) = (kernel_transform(columns, width), kernel_transform(rows, height));
    let mut sums = vec![Complex64::default(); (columns + 1) * (2 * rows + 1)];
    sums.par_chunks_mut(2 * rows + 1).enumerate().for_each_init(
        || vec![Complex64::default(); height],
        |column, (kx, out)| {
            column.iter_mut().zip(kept.chunks_exact(columns + 1)).for_each(|(c, row)| *c = row[kx]);
            plan.process(column);
            for (k, sum) in out.iter_mut().enumerate() {
                let from = if k >= rows { k - rows } else { height + k - rows };
                *sum = column[from] / (across[kx] * down[k.abs_diff(rows)]);
            }
        },
    );
    sums
}

/// Returns the sum of the kernels around all points on a `width` × `height` grid of the torus, row
/// by row.
fn spread(points: &[[f64; 2]], width: usize, height: usize) -> Vec<f64> {
    let mut grid = vec![0.; width * height];
    let weights = |at: f64| {
        let first = (at - 0.5 * WIDTH as f64).ceil();
        let weights: [f64; WIDTH] = std::array::from_fn(|k| kernel(first + k as f64 - at));
        (first, weights)
    };
    for p in points {
        let (left, across) = weights(p[0] * width as f64);
        let (top, down) = weights(p[1] * height as f64);
        let columns: [usize; WIDTH] =
            std::array::from_fn(|k| (left as isize + k as isize).rem_euclid(width as isize) as usize);
        for (k, weight) in down.into_iter().enumerate() {
            let row = (top as isize + k as isize).rem_euclid(height as isize) as usize * width;
            columns.iter().zip(&across).for_each(|(&c, a)| grid[row + c] += weight * a);
        }
    }
    grid
}

/// Returns the kernel at a distance of `t` grid cells from the point, which is 0 beyond half of
/// [`WIDTH`].
fn kernel(t: f64) -> f64 {
    let z = t * (2. / WIDTH as f64);
    let inside = 1. - z * z;
    if inside < 0. { 0. } else { (BETA * (inside.sqrt() - 1.)).exp() }
}

/// Returns the Fourier transform of the kernel, ∫ kernel(t) cos(2πkt/length) dt, for all k from 0
/// to `highest`.
///
/// The integral is computed by the midpoint rule; `length` is the number of grid cells along the
/// axis.
fn kernel_transform(highest: usize, length: usize) -> Vec<f64> {
    /// Number of nodes of the midpoint rule per grid cell.
    const NODES_PER_CELL: usize = 16;
    let nodes: Vec<[f64; 2]> = (0..WIDTH * NODES_PER_CELL / 2)
        .map(|k| (k as f64 + 0.5) / NODES_PER_CELL as f64)
        .map(|t| [t, 2. * kernel(t) / NODES_PER_CELL as f64])
        .collect();
    (0..=highest)
        .map(|k| {
            let w = TAU * k as f64 / length as f64;
            nodes.iter().map(|[t, weight]| weight * (w * t).cos()).sum()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn gridded_power_is_that_of_the_direct_sum() {
        for (n, columns, rows) in [(700, 40, 40), (300, 3, 90), (500, 70, 0), (50, 1, 1)] {
            let mut rng = ChaCha8Rng::seed_from_u64(n as u64);
            let mut points: Vec<[f64; 2]> = (0..n).map(|_| [rng.random(), rng.random()]).collect();
            points[0] = [0., 1f64.next_down()];
            let (exact, fast) = (direct(&points, columns, rows), gridded(&points, columns, rows));
            for (k, (a, b)) in exact.iter().zip(&fast).enumerate() {
                let (a, b) = (a.norm_sqr() / f64::from(n), b.norm_sqr() / f64::from(n));
                // Relative to the mean power, which is 1, where the power itself is close to 0.
                assert!((a - b).abs() <= 1e-6 * a.max(0.01), "{n} points, wave {k}: {a} {b}");
            }
        }
    }
}
