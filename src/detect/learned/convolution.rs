//! Convolution of feature maps by SIMD instructions.
//!
//! 1. The weights are put into the order of their use, so that they are read one after the other.
//! 2. A block of sums (outputs × neighbouring pixels) stays in registers while all taps are added
//!    to it.
//! 3. The frame of zeros around the maps makes every tap readable, so no tap is tested for the
//!    border.

use super::maps::{LANES, Maps};
use fearless_simd::{Level, Simd, dispatch, prelude::*};

/// Weights of one convolution, out × in × side × side, and one bias per output channel.
#[derive(Clone, Debug)]
pub(super) struct Kernel {
    /// Number of output channels.
    pub outputs: usize,
    /// Number of input channels.
    pub inputs: usize,
    /// Side of the window of taps in px, an odd number.
    pub side: usize,
    /// Weights, by output, input, row and column.
    pub weights: Vec<f32>,
    /// Biases, one per output channel.
    pub bias: Vec<f32>,
}

impl Maps {
    /// Returns the convolution of these maps with `kernel`: Σ weight · input + bias, with zeros
    /// outside the maps.
    pub(super) fn convolved(&self, kernel: &Kernel) -> Self {
        self.through(kernel, false)
    }

    /// Returns the convolution of these maps with `kernel`, in which negative values are replaced
    /// by zero (ReLU).
    pub(super) fn layer(&self, kernel: &Kernel) -> Self {
        self.through(kernel, true)
    }

    /// Returns the convolution with `kernel`, computed at the widest SIMD level available; if
    /// `rectified`, negative values become zero.
    ///
    /// Each pass accumulates 4 outputs × 2 vectors (1 × 4 for a single output). These are enough
    /// independent sums to hide the latency of the multiply-add, and few enough to stay in 16
    /// registers together with their factors.
    fn through(&self, kernel: &Kernel, rectified: bool) -> Self {
        let mut out = Self::framed(kernel.outputs, self.height, self.width);
        let pass = |together| Pass {
            input: self,
            kernel,
            blocks: kernel.blocks(together),
            taps: self.offsets(kernel),
            rectified,
        };
        let level = Level::new();
        match kernel.outputs {
            1 => dispatch!(level, simd => pass(1).run::<_, 1, 4>(simd, &mut out)),
            _ => dispatch!(level, simd => pass(4).run::<_, 4, 2>(simd, &mut out)),
        }
        out
    }

    /// Returns the offset in memory from a pixel to each tap, by input, row and column.
    fn offsets(&self, kernel: &Kernel) -> Vec<isize> {
        let half = (kernel.side / 2) as isize;
        let (stride, plane) = (self.stride as isize, self.plane() as isize);
        let mut offsets = Vec::with_capacity(kernel.inputs * kernel.side * kernel.side);
        for input in 0..kernel.inputs as isize {
            for j in -half..=half {
                offsets.extend((-half..=half).map(|i| input * plane + j * stride + i));
            }
        }
        offsets
    }
}

impl Kernel {
    /// Returns the weights in the order of their use.
    ///
    /// Outputs are grouped into blocks of `together`. Within a block, the weights run by input, row
    /// and column, and those of all outputs for one tap stand side by side. If the last block has
    /// fewer outputs, weights of zero fill it up.
    fn blocks(&self, together: usize) -> Vec<f32> {
        let taps = self.inputs * self.side * self.side;
        let mut blocks = Vec::with_capacity(self.outputs.next_multiple_of(together) * taps);
        for first in (0..self.outputs).step_by(together) {
            for tap in 0..taps {
                blocks.extend(
                    (first..first + together).map(|o| self.weights.get(o * taps + tap).unwrap_or(&0.)),
                );
            }
        }
        blocks
    }
}

/// One convolution of all rows of the input maps.
///
/// The methods are inlined into the dispatching caller, so that they are compiled once per SIMD
/// level.
struct Pass<'a> {
    /// Maps that are convolved.
    input: &'a Maps,
    /// Convolution that is applied; only the biases are read from it.
    kernel: &'a Kernel,
    /// Weights in the order of their use, see [`Kernel::blocks`].
    blocks: Vec<f32>,
    /// Offset in memory from a pixel to each tap.
    taps: Vec<isize>,
    /// `true` if negative sums become zero.
    rectified: bool,
}

impl Pass<'_> {
    /// Computes all rows of `out`, `TOGETHER` outputs and `VECTORS` registers along x at a time.
    ///
    /// The end of a row is computed one register at a time.
    #[inline(always)]
    fn run<S: Simd, const TOGETHER: usize, const VECTORS: usize>(&self, simd: S, out: &mut Maps) {
        const { assert!(S::f32s::LEN <= LANES) };
        let width = self.input.width;
        let long = VECTORS * S::f32s::LEN;
        for y in 0..self.input.height {
            for (block, weights) in self.blocks.chunks(TOGETHER * self.taps.len()).enumerate() {
                let first = block * TOGETHER;
                let bias = std::array::from_fn(|k| self.kernel.bias.get(first + k).copied().unwrap_or(0.));
                let mut x = 0;
                while x + long <= width {
                    let sums =
                        self.sums::<S, TOGETHER, VECTORS>(simd, weights, bias, self.input.start(0, y) + x);
                    self.write::<S, TOGETHER, _>(sums, (first, y, x), out);
                    x += long;
                }
                while x < width {
                    let sums = self.sums::<S, TOGETHER, 1>(simd, weights, bias, self.input.start(0, y) + x);
                    self.write::<S, TOGETHER, _>(sums, (first, y, x), out);
                    x += S::f32s::LEN;
                }
            }
        }
    }

    /// Returns the sums of a block of outputs, for the pixels from index `at` on.
    #[inline(always)]
    fn sums<S: Simd, const TOGETHER: usize, const VECTORS: usize>(
        &self,
        simd: S,
        weights: &[f32],
        bias: [f32; TOGETHER],
        at: usize,
    ) -> [[S::f32s; VECTORS]; TOGETHER] {
        let mut sums = bias.map(|b| [S::f32s::splat(simd, b); VECTORS]);
        for (weights, &offset) in weights.as_chunks::<TOGETHER>().0.iter().zip(&self.taps) {
            let start = at.wrapping_add_signed(offset);
            let input = &self.input.data[start..start + VECTORS * S::f32s::LEN];
            let input: [S::f32s; VECTORS] = std::array::from_fn(|v| {
                S::f32s::from_slice(simd, &input[v * S::f32s::LEN..(v + 1) * S::f32s::LEN])
            });
            for (sums, &weight) in sums.iter_mut().zip(weights) {
                let weight = S::f32s::splat(simd, weight);
                for (sum, input) in sums.iter_mut().zip(input) {
                    *sum = weight.mul_add(input, *sum);
                }
            }
        }
        sums
    }

    /// Writes the sums of the outputs from `channel` on into row `y` from `x` on, up to the end of
    /// the row.
    #[inline(always)]
    fn write<S: Simd, const TOGETHER: usize, const VECTORS: usize>(
        &self,
        sums: [[S::f32s; VECTORS]; TOGETHER],
        (channel, y, x): (usize, usize, usize),
        out: &mut Maps,
    ) {
        for (channel, sums) in (channel..out.channels).zip(sums) {
            let mut start = out.start(channel, y) + x;
            let end = start + out.width - x;
            for mut sum in sums {
                if self.rectified {
                    sum = sum.max(0.);
                }
                if start + S::f32s::LEN <= end {
                    sum.store_slice(&mut out.data[start..start + S::f32s::LEN]);
                } else {
                    let row = &mut out.data[start..end];
                    row.copy_from_slice(&sum.as_slice()[..row.len()]);
                }
                start += S::f32s::LEN;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::maps::textured;
    use super::*;

    #[test]
    fn a_convolution_equals_its_definition() {
        for (inputs, outputs, side, width) in
            [(1, 10, 7, 13), (3, 5, 3, 8), (2, 4, 3, 17), (6, 1, 1, 5), (3, 6, 5, 131), (8, 8, 3, 1)]
        {
            let weights: Vec<f32> =
                (0..outputs * inputs * side * side).map(|k| ((k * 13) % 17) as f32 / 8. - 1.).collect();
            let bias: Vec<f32> = (0..outputs).map(|k| k as f32).collect();
            let kernel = Kernel { outputs, inputs, side, weights, bias };
            let maps = textured(inputs, 9, width);
            let (out, rectified) = (maps.convolved(&kernel), maps.layer(&kernel));
            for o in 0..outputs {
                for y in 0..9 {
                    for x in 0..width {
                        let sum = defined(&maps, &kernel, (o, y, x));
                        assert!((out.row(o, y)[x] - sum).abs() < 1e-3);
                        assert!((rectified.row(o, y)[x] - sum.max(0.)).abs() < 1e-3);
                    }
                }
            }
        }
    }

    /// Returns the convolution at one pixel by its definition.
    fn defined(maps: &Maps, kernel: &Kernel, (o, y, x): (usize, usize, usize)) -> f32 {
        let (side, half) = (kernel.side, kernel.side / 2);
        let mut sum = kernel.bias[o];
        for i in 0..kernel.inputs {
            let taps = &kernel.weights[(o * kernel.inputs + i) * side * side..][..side * side];
            for (tap, w) in taps.iter().enumerate() {
                let (yy, xx) = (y + tap / side, x + tap % side);
                if (half..maps.height + half).contains(&yy) && (half..maps.width + half).contains(&xx) {
                    sum += w * maps.row(i, yy - half)[xx - half];
                }
            }
        }
        sum
    }
}
