//! Gaussian filter, at a cost that stays bounded for wide kernels.
//!
//! 1. For σ below 8 px, the weighted sums are computed exactly, along x and then along y.
//! 2. For wider kernels, weighted means every ⌊σ/4⌋ px form a coarser grid, on which σ is only 4 to
//!    6 steps.
//! 3. Cubics (Catmull and Rom 1974, <https://doi.org/10.1016/B978-0-12-079050-0.50020-5>) lead back
//!    to the pixels.

use super::pad::framed;
use super::{Plane, fill_rows, mirror, values};
use fearless_simd::{Level, Simd, dispatch, prelude::*};

/// Half-width of the kernel, in standard deviations; there, the weight is .03 % of that in the
/// middle.
const CUT: f64 = 4.;

/// Smallest standard deviation of a kernel on a coarser grid, in steps of that grid.
///
/// A finer grid would cost more without adding detail.
const COARSE_SIGMA: f64 = 4.;

/// Returns `plane` filtered by a Gaussian of standard deviation `sigma` px.
///
/// The kernel is cut at ⌈4σ⌉, and the plane is mirrored at its border with the edge pixel repeated
/// (OpenCV's BORDER_REFLECT). Below σ = 8 px the sum is exact. From there on, it is taken over
/// weighted means every ⌊σ/4⌋ px and interpolated by cubics. The result stays within 1e-3 of the
/// input's range, at a cost that does not grow with σ. For σ ≤ 0, the plane itself is returned.
pub fn gaussian(plane: &Plane, sigma: f64) -> Plane {
    if sigma <= 0. || plane.is_empty() {
        return plane.clone();
    }
    let step = ((sigma / COARSE_SIGMA) as usize).max(1);
    if step == 1 { fine_columns(&fine_rows(plane, sigma), sigma) } else { coarse(plane, sigma, step) }
}

/// Returns the weights of the Gaussian kernel from its middle outwards; both sides of the complete
/// kernel together sum to 1.
fn half_kernel(sigma: f64) -> Vec<f32> {
    let radius = (CUT * sigma).ceil() as usize;
    let weights: Vec<f64> = (0..=radius).map(|k| (-0.5 * (k as f64 / sigma).powi(2)).exp()).collect();
    let sum = 2. * weights.iter().sum::<f64>() - weights[0];
    weights.iter().map(|w| (w / sum) as f32).collect()
}

/// Computes one filtered row: Σₖ `kernel[|k|]` · `row(k)`, for k on both sides of the row.
fn weigh_rows<'a>(out: &mut [f32], kernel: &[f32], row: impl Fn(isize) -> &'a [f32]) {
    let pairs = kernel.iter().enumerate().map(|(k, &weight)| {
        let k = k as isize;
        if k == 0 { Pair::alone(row(0), weight) } else { Pair { before: row(-k), after: row(k), weight } }
    });
    weigh(out, &pairs.collect::<Vec<_>>());
}

/// Two rows that lie as far above as below the one that is computed.
struct Pair<'a> {
    /// Row above the computed one.
    before: &'a [f32],
    /// Row below the computed one.
    after: &'a [f32],
    /// Weight by which the sum of both rows is multiplied.
    weight: f32,
}

impl<'a> Pair<'a> {
    /// Returns the pair in which the computed row itself stands for both rows, with half the
    /// weight.
    const fn alone(row: &'a [f32], weight: f32) -> Self {
        Self { before: row, after: row, weight: 0.5 * weight }
    }
}

/// Computes the weighted sum of pairs of rows, at the widest SIMD level available.
///
/// Every sum is added up in the same order at all levels.
fn weigh(out: &mut [f32], pairs: &[Pair<'_>]) {
    dispatch!(Level::new(), simd => weigh_by(simd, out, pairs));
}

/// Computes the sums of a row, several registers at a time so that their additions overlap.
///
/// The end of the row is computed one register and then one pixel at a time.
#[inline(always)]
fn weigh_by<S: Simd>(simd: S, out: &mut [f32], pairs: &[Pair<'_>]) {
    /// Number of registers of sums that are added up side by side.
    const REGISTERS: usize = 4;
    let mut x = 0;
    while x + REGISTERS * S::f32s::LEN <= out.len() {
        sums::<S, REGISTERS>(simd, out, pairs, x);
        x += REGISTERS * S::f32s::LEN;
    }
    while x + S::f32s::LEN <= out.len() {
        sums::<S, 1>(simd, out, pairs, x);
        x += S::f32s::LEN;
    }
    for (x, o) in out.iter_mut().enumerate().skip(x) {
        *o = pairs.iter().fold(0., |sum, pair| sum + pair.weight * (pair.before[x] + pair.after[x]));
    }
}

/// Writes the weighted sums of `REGISTERS` registers of pixels, from pixel `x` on, into `out`.
#[inline(always)]
fn sums<S: Simd, const REGISTERS: usize>(simd: S, out: &mut [f32], pairs: &[Pair<'_>], x: usize) {
    let length = REGISTERS * S::f32s::LEN;
    let mut sums = [S::f32s::splat(simd, 0.); REGISTERS];
    for pair in pairs {
        let (before, after) = (&pair.before[x..x + length], &pair.after[x..x + length]);
        for (r, sum) in sums.iter_mut().enumerate() {
            let part = r * S::f32s::LEN..(r + 1) * S::f32s::LEN;
            let both =
                S::f32s::from_slice(simd, &before[part.clone()]) + S::f32s::from_slice(simd, &after[part]);
            *sum += both * pair.weight;
        }
    }
    for (sum, out) in sums.iter().zip(out[x..x + length].chunks_exact_mut(S::f32s::LEN)) {
        sum.store_slice(out);
    }
}

/// Returns the plane filtered along x by the exact sum.
fn fine_rows(plane: &Plane, sigma: f64) -> Plane {
    let (h, w) = plane.dim();
    let kernel = half_kernel(sigma);
    let reach = kernel.len() - 1;
    let data = values(plane);
    fill_rows(h, w, |y, out| {
        let row = &data[y * w..(y + 1) * w];
        let framed = framed(row, reach, reach);
        weigh_rows(out, &kernel, |k| &framed[(reach as isize + k) as usize..]);
    })
}

/// Returns the plane filtered along y by the exact sum.
fn fine_columns(plane: &Plane, sigma: f64) -> Plane {
    let (h, w) = plane.dim();
    let kernel = half_kernel(sigma);
    let data = values(plane);
    fill_rows(h, w, |y, out| {
        weigh_rows(out, &kernel, |k| {
            let i = mirror(y as isize + k, h);
            &data[i * w..(i + 1) * w]
        });
    })
}

/// Gaussian filter along one axis of a plane, on a grid with one point every `step` px.
struct Coarse {
    /// Distance between neighbouring points of the grid, in px.
    step: usize,
    /// Weights of the pixels around a point of the grid.
    ///
    /// The weights form a triangle (a hat) twice as wide as `step`, so that fine detail does not
    /// pass for coarse detail.
    hat: Vec<f32>,
    /// Weights of the Gaussian kernel on the grid, from its middle outwards.
    kernel: Vec<f32>,
    /// Number of grid points that the kernel needs beyond either end of the axis.
    reach: usize,
    /// Number of grid points that cover the pixels of the axis.
    inside: usize,
}

impl Coarse {
    fn new(length: usize, sigma: f64, step: usize) -> Self {
        let count = 2 * step - step % 2;
        let distance = |k: usize| k as f64 - 0.5 * (count - 1) as f64;
        let weight = |k: usize| (1. - distance(k).abs() / step as f64) / step as f64;
        // the hat blurs as well, so the kernel must be narrower by its variance
        let variance: f64 = (0..count).map(|k| weight(k) * distance(k).powi(2)).sum();
        let kernel = half_kernel((sigma * sigma - variance).sqrt() / step as f64);
        let reach = kernel.len() + 1;
        let hat = (0..count).map(|k| weight(k) as f32).collect();
        Self { step, hat, kernel, reach, inside: length.div_ceil(step) }
    }

    /// Returns the number of grid points, including those beyond either end of the axis.
    const fn points(&self) -> usize {
        self.inside + 2 * self.reach
    }

    /// Returns the index, in a row with its mirrored frame, of the first pixel that enters the
    /// weighted mean of grid point `i`.
    const fn first(&self, i: usize) -> usize {
        (i + 2) * self.step - self.step / 2
    }

    /// Returns the width, in px, of the mirrored frame beyond either end of the axis that the grid
    /// points need.
    const fn frame(&self) -> usize {
        (self.reach + 2) * self.step
    }

    /// Returns the number of filtered samples along the axis.
    ///
    /// Two samples beyond either end serve the cubics at the border.
    const fn samples(&self) -> usize {
        self.inside + 4
    }

    /// Returns the index of the grid point at the position of the filtered sample `i`.
    const fn middle(&self, i: usize) -> usize {
        i + self.reach - 2
    }

    /// Returns, for every pixel along an axis of `length` px, the first of the four samples around
    /// it, and their weights.
    fn cubics(&self, length: usize) -> Vec<(usize, [f32; 4])> {
        (0..length)
            .map(|x| {
                let position = (x as f64 + 0.5) / self.step as f64 - 0.5 + 2.;
                let cell = position.floor();
                (cell as usize - 1, catmull_rom((position - cell) as f32))
            })
            .collect()
    }
}

/// Returns the plane filtered along x on a coarser grid.
fn coarse_rows(plane: &Plane, sigma: f64, step: usize) -> Plane {
    let (h, w) = plane.dim();
    let grid = Coarse::new(w, sigma, step);
    let cubics = grid.cubics(w);
    let data = values(plane);
    fill_rows(h, w, |y, out| {
        let framed = framed(&data[y * w..(y + 1) * w], grid.frame(), grid.frame());
        let mean = |i| framed[grid.first(i)..].iter().zip(&grid.hat).map(|(v, weight)| weight * v).sum();
        let points: Vec<f32> = (0..grid.points()).map(mean).collect();
        let mut samples = vec![0f32; grid.samples()];
        weigh_rows(&mut samples, &grid.kernel, |k| &points[(grid.middle(0) as isize + k) as usize..]);
        for (o, (at, weights)) in out.iter_mut().zip(&cubics) {
            *o = samples[*at..].iter().zip(weights).map(|(s, weight)| weight * s).sum();
        }
    })
}

/// Returns the plane filtered along both axes on coarser grids.
///
/// The columns go to the coarser grid first and come back last, so that the fewest rows are
/// filtered along x.
fn coarse(plane: &Plane, sigma: f64, step: usize) -> Plane {
    let (h, w) = plane.dim();
    let data = values(plane);
    let grid = Coarse::new(h, sigma, step);
    let points = fill_rows(grid.points(), w, |i, out| {
        let last = grid.hat.len() - 1;
        let row = |k: usize| {
            let y = mirror((grid.first(i) + k) as isize - grid.frame() as isize, h);
            &data[y * w..(y + 1) * w]
        };
        // the two halves of the hat have the same weights, so rows are added in pairs
        let pairs = grid.hat[..=last / 2].iter().enumerate().map(|(k, &weight)| match last - k {
            opposite if opposite == k => Pair::alone(row(k), weight),
            opposite => Pair { before: row(k), after: row(opposite), weight },
        });
        weigh(out, &pairs.collect::<Vec<_>>());
    });
    let points = values(&points);
    let coarse = fill_rows(grid.samples(), w, |i, out| {
        weigh_rows(out, &grid.kernel, |k| {
            let j = (grid.middle(i) as isize + k) as usize;
            &points[j * w..(j + 1) * w]
        });
    });
    let coarse = coarse_rows(&coarse, sigma, step);
    let coarse = values(&coarse);
    let cubics = grid.cubics(h);
    fill_rows(h, w, |y, out| {
        let (at, [a, b, c, d]) = cubics[y];
        let row = |j: usize| &coarse[(at + j) * w..(at + j + 1) * w];
        for ((((o, p), q), r), s) in out.iter_mut().zip(row(0)).zip(row(1)).zip(row(2)).zip(row(3)) {
            *o = a * p + b * q + c * r + d * s;
        }
    })
}

/// Returns the Catmull–Rom weights of four neighbouring samples for a point between the second and
/// the third.
///
/// `t` (0–1) is the fraction of the way from the second to the third.
fn catmull_rom(t: f32) -> [f32; 4] {
    [
        0.5 * t * (-1. + t * (2. - t)),
        1. + 0.5 * t * t * (-5. + 3. * t),
        0.5 * t * (1. + t * (4. - 3. * t)),
        0.5 * t * t * (t - 1.),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture(h: usize, w: usize) -> Plane {
        Plane::from_shape_fn((h, w), |(y, x)| {
            let (x, y) = (x as f32, y as f32);
            0.5 + 0.3 * (0.7 * x).sin() * (0.5 * y).cos() + 0.2 * (0.03 * x + 0.05 * y).sin()
        })
    }

    /// Returns the filtered plane by the definition of the Gaussian filter.
    fn direct(plane: &Plane, sigma: f64) -> Plane {
        let (h, w) = plane.dim();
        let radius = (CUT * sigma).ceil() as isize;
        let weights: Vec<f64> =
            (-radius..=radius).map(|k| (-0.5 * (k as f64 / sigma).powi(2)).exp()).collect();
        let sum: f64 = weights.iter().sum();
        let along_y = ndarray::Array2::from_shape_fn((h, w), |(y, x)| {
            (-radius..=radius)
                .map(|k| {
                    weights[(k + radius) as usize] / sum * f64::from(plane[[mirror(y as isize + k, h), x]])
                })
                .sum::<f64>()
        });
        Plane::from_shape_fn((h, w), |(y, x)| {
            (-radius..=radius)
                .map(|k| weights[(k + radius) as usize] / sum * along_y[[y, mirror(x as isize + k, w)]])
                .sum::<f64>() as f32
        })
    }

    fn largest_difference(a: &Plane, b: &Plane) -> f32 {
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0., f32::max)
    }

    #[test]
    fn narrow_kernels_equal_the_direct_sum() {
        let plane = texture(37, 23);
        for sigma in [0.4, 1.3, 7.] {
            assert!(largest_difference(&gaussian(&plane, sigma), &direct(&plane, sigma)) < 2e-6);
        }
    }

    #[test]
    fn wide_kernels_stay_within_a_thousandth_of_the_range() {
        // a wave just below the grid's own is the hardest
        for sigma in [8., 12., 16., 32.] {
            let step = (sigma / COARSE_SIGMA).floor();
            for part in [1.03, 1.06, 1.1, 1.5, 2.] {
                let wave = Plane::from_shape_fn((40, 150), |(_, x)| {
                    (std::f64::consts::TAU * x as f64 / (part * step)).sin() as f32
                });
                let error = 0.5 * largest_difference(&gaussian(&wave, sigma), &direct(&wave, sigma));
                assert!(error < 1e-3, "sigma {sigma}, wave of {part} steps: {error}");
            }
        }
        let rough = Plane::from_shape_fn((91, 150), |(y, x)| ((x * 7919 + y * 104_729) % 101) as f32 / 101.);
        for plane in [texture(91, 150), rough] {
            for sigma in [8., 11., 15., 18.75, 30., 55.] {
                let error = largest_difference(&gaussian(&plane, sigma), &direct(&plane, sigma));
                assert!(error < 1e-4, "sigma {sigma}: {error}");
            }
        }
    }

    #[test]
    fn a_kernel_wider_than_the_image_still_gives_its_mean() {
        let plane = texture(9, 5);
        let mean = plane.mean().unwrap();
        assert!(gaussian(&plane, 40.).iter().all(|v| (v - mean).abs() < 1e-3));
    }
}
