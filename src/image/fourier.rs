//! Two-dimensional fast Fourier transform of a real plane, and filters in its domain.
//!
//! 1. Rows are transformed first; they are real, so only the half with fx ≥ 0 is kept.
//! 2. The result is stored column by column, and the columns are transformed in place.
//!
//! Small planes are transformed by one thread, large ones by all.

use super::{PARALLEL_PIXELS, Plane};
use rayon::prelude::*;
use realfft::RealFftPlanner;
use rustfft::{FftDirection, FftPlanner, num_complex::Complex32};
use std::cell::RefCell;

/// Number of rows or columns per task; one scratch buffer serves them all.
const LINES: usize = 16;

thread_local! {
    /// Planners of Fourier transforms, kept by every thread.
    ///
    /// Planning a length costs more than transforming it, and the images of a folder share their
    /// lengths.
    static PLANNERS: RefCell<(RealFftPlanner<f32>, FftPlanner<f32>)> =
        RefCell::new((RealFftPlanner::new(), FftPlanner::new()));
}

/// Returns the smallest even length ≥ `length` that has no prime factor above 5.
///
/// A fast Fourier transform of real numbers is fast for such lengths.
pub fn fast_length(length: usize) -> usize {
    let smooth = |mut n: usize| {
        for p in [2, 3, 5] {
            while n.is_multiple_of(p) {
                n /= p;
            }
        }
        n == 1
    };
    (length.max(1)..).find(|&n| n.is_multiple_of(2) && smooth(n)).unwrap_or(length)
}

/// Two-dimensional Fourier transform of a real plane.
///
/// Only the half with fx ≥ 0 is stored, column by column: `values[kx · height + ky]`. The other
/// half follows from it by symmetry.
pub struct Spectrum {
    /// Width of the plane that was transformed, in px.
    width: usize,
    /// Height of the plane that was transformed, in px.
    height: usize,
    /// Terms of the transform, column by column.
    values: Vec<Complex32>,
}

impl Spectrum {
    /// Returns the transform of `plane`, padded with zeros to `height` × `width`.
    ///
    /// Neither `height` nor `width` may be smaller than that of the plane.
    pub fn forward(plane: &Plane, height: usize, width: usize) -> Self {
        let (rows, columns) = plane.dim();
        let half = width / 2 + 1;
        let row_plan = PLANNERS.with_borrow_mut(|p| p.0.plan_fft_forward(width));
        // rows below the plane are zero and transform to zero
        let mut by_row = vec![Complex32::default(); rows * half];
        let transform_rows = |(task, out): (usize, &mut [Complex32])| {
            let (mut input, mut scratch) = (row_plan.make_input_vec(), row_plan.make_scratch_vec());
            for (k, out) in out.chunks_mut(half).enumerate() {
                let (row, beyond) = input.split_at_mut(columns);
                row.iter_mut().zip(plane.row(LINES * task + k)).for_each(|(i, v)| *i = *v);
                beyond.fill(0.); // the plan uses its input as scratch
                // the buffers were made by the plan, so it cannot refuse their lengths
                let done = row_plan.process_with_scratch(&mut input, out, &mut scratch);
                debug_assert!(done.is_ok());
            }
        };
        let parallel = height * width >= PARALLEL_PIXELS && columns > 0;
        if parallel {
            by_row.par_chunks_mut(LINES * half).enumerate().for_each(transform_rows);
        } else {
            by_row.chunks_mut(LINES * half).enumerate().for_each(transform_rows);
        }
        let mut values = vec![Complex32::default(); half * height];
        let gather = |(kx, out): (usize, &mut [Complex32])| {
            out.iter_mut().zip(by_row.chunks(half)).for_each(|(o, row)| *o = row[kx]);
        };
        if parallel {
            values.par_chunks_mut(height).enumerate().for_each(gather);
        } else {
            values.chunks_mut(height).enumerate().for_each(gather);
        }
        let mut spectrum = Self { width, height, values };
        spectrum.transform_columns(FftDirection::Forward);
        spectrum
    }

    /// Transforms all columns in place.
    fn transform_columns(&mut self, direction: FftDirection) {
        let plan = PLANNERS.with_borrow_mut(|p| p.1.plan_fft(self.height, direction));
        // only half of the terms are stored, so this is the limit for the entire plane
        if self.values.len() >= PARALLEL_PIXELS / 2 {
            self.values.par_chunks_mut(LINES * self.height).for_each(|columns| plan.process(columns));
        } else {
            plan.process(&mut self.values);
        }
    }

    /// Transforms back to a plane of `height` × `width`.
    pub fn inverse(mut self) -> Plane {
        self.transform_columns(FftDirection::Inverse);
        let half = self.width / 2 + 1;
        let plan = PLANNERS.with_borrow_mut(|p| p.0.plan_fft_inverse(self.width));
        let scale = 1. / (self.width * self.height) as f32;
        let mut data = vec![0f32; self.width * self.height];
        let (values, height, width) = (&self.values, self.height, self.width);
        let transform_rows = |(task, out): (usize, &mut [f32])| {
            let (mut input, mut scratch) = (plan.make_input_vec(), plan.make_scratch_vec());
            for (k, out) in out.chunks_mut(width).enumerate() {
                let y = LINES * task + k;
                input.iter_mut().zip(values.chunks(height)).for_each(|(i, column)| *i = column[y] * scale);
                // the first term along x of a real plane is real, and so is the last if the width
                // is even; rounding left a trace that the plan would refuse
                input[0].im = 0.;
                if width.is_multiple_of(2) {
                    input[half - 1].im = 0.;
                }
                let done = plan.process_with_scratch(&mut input, out, &mut scratch);
                debug_assert!(done.is_ok());
            }
        };
        if data.len() >= PARALLEL_PIXELS {
            data.par_chunks_mut(LINES * width).enumerate().for_each(transform_rows);
        } else {
            data.chunks_mut(LINES * width).enumerate().for_each(transform_rows);
        }
        Plane::from_shape_vec((height, width), data).unwrap_or_default()
    }

    /// Multiplies every term by `factor(of_x(fx), of_y(fy))`.
    ///
    /// The frequencies are in cycles per pixel, 0 ≤ fx ≤ ½ and −½ ≤ fy < ½. `of_x` is called only
    /// once per column and `of_y` only once per row.
    pub fn multiply<X, Y: Sync>(
        &mut self,
        of_x: impl Fn(f32) -> X + Sync,
        of_y: impl Fn(f32) -> Y,
        factor: impl Fn(&X, &Y) -> Complex32 + Sync,
    ) {
        let (width, height) = (self.width, self.height);
        let rows: Vec<Y> = (0..height).map(|ky| of_y(signed_frequency(ky, height))).collect();
        let column = |(kx, values): (usize, &mut [Complex32])| {
            let x = of_x(kx as f32 / width as f32);
            for (value, y) in values.iter_mut().zip(&rows) {
                *value *= factor(&x, y);
            }
        };
        // only half of the terms are stored, so this is the limit for the entire plane
        if self.values.len() >= PARALLEL_PIXELS / 2 {
            self.values.par_chunks_mut(height).enumerate().for_each(column);
        } else {
            self.values.chunks_mut(height).enumerate().for_each(column);
        }
    }

    /// Returns the power |value|² of every term, in the order of storage: `[kx · height + ky]`.
    pub fn power(&self) -> impl Iterator<Item = f32> {
        self.values.iter().map(|v| v.norm_sqr())
    }
}

/// Returns the frequency of term `k` of a transform of `length` terms, in cycles per sample, in
/// [−½, ½).
pub(crate) fn signed_frequency(k: usize, length: usize) -> f32 {
    let k = if 2 * k < length { k as f32 } else { k as f32 - length as f32 };
    k / length as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back_is_the_same_plane() {
        for (h, w, height, width) in [(12, 15, 12, 15), (9, 10, 9, 10), (7, 7, 7, 7), (40, 20, 48, 32)] {
            let plane = Plane::from_shape_fn((h, w), |(y, x)| ((y * 31 + x * 17) % 23) as f32);
            let back = Spectrum::forward(&plane, height, width).inverse();
            for ((y, x), value) in back.indexed_iter() {
                assert!((value - plane.get([y, x]).unwrap_or(&0.)).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn a_wave_has_its_power_at_its_frequency() {
        let (h, w) = (16, 24);
        let wave = |x: usize, y: usize| 3. * x as f32 / w as f32 + 2. * y as f32 / h as f32;
        let plane = Plane::from_shape_fn((h, w), |(y, x)| (std::f32::consts::TAU * wave(x, y)).cos());
        let power: Vec<f32> = Spectrum::forward(&plane, h, w).power().collect();
        let peak = (0..power.len()).max_by(|&a, &b| power[a].total_cmp(&power[b])).unwrap();
        assert_eq!((peak / h, peak % h), (3, 2));
    }

    #[test]
    fn fast_lengths_have_small_factors_only() {
        assert_eq!([1, 7, 11, 97, 241].map(fast_length), [2, 8, 12, 100, 250]);
    }
}
