use rayon::prelude::*;

/// Zeros around every channel, in px: no layer reaches further, so none has to ask where the image ends.
pub(super) const MARGIN: usize = 4;
/// Pixels of a row that are summed at once, for four or five channels: as many sums as the registers of any 64-bit processor
/// hold.
const LANES: usize = 8;

/// Feature maps: planes of one size, one a channel, each inside a frame of zeros.
#[derive(Clone, Debug)]
pub(super) struct Maps {
    channels: usize,
    height: usize,
    width: usize,
    stride: usize,
    data: Vec<f32>,
}

/// The weights of one convolution, out × in × side × side, and its bias, one an output channel.
#[derive(Clone, Debug)]
pub(super) struct Kernel {
    pub outputs: usize,
    pub inputs: usize,
    pub side: usize,
    pub weights: Vec<f32>,
    pub bias: Vec<f32>,
}

impl Kernel {
    /// Weights in the order in which they are used: for blocks of outputs, by input, row and column, the block's outputs
    /// side by side. Outputs that fill the last block are zero.
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

impl Maps {
    pub(super) fn zeros(channels: usize, height: usize, width: usize) -> Self {
        let stride = 2 * MARGIN + width.next_multiple_of(LANES);
        Self { channels, height, width, stride, data: vec![0.; channels * (height + 2 * MARGIN) * stride] }
    }

    fn start(&self, channel: usize, y: usize) -> usize {
        (channel * (self.height + 2 * MARGIN) + y + MARGIN) * self.stride + MARGIN
    }

    pub(super) fn row(&self, channel: usize, y: usize) -> &[f32] {
        let start = self.start(channel, y);
        &self.data[start..start + self.width]
    }

    pub(super) fn row_mut(&mut self, channel: usize, y: usize) -> &mut [f32] {
        let start = self.start(channel, y);
        &mut self.data[start..start + self.width]
    }

    /// What `kernel` makes of these maps: each output Σ weight · input + bias, taps `dilation` px apart, zeros outside.
    pub(super) fn convolved(&self, kernel: &Kernel, dilation: usize) -> Self {
        match kernel.outputs {
            1 => self.convolved_by::<1>(kernel, dilation),
            n if n.is_multiple_of(5) => self.convolved_by::<5>(kernel, dilation),
            _ => self.convolved_by::<4>(kernel, dilation),
        }
    }

    fn convolved_by<const TOGETHER: usize>(&self, kernel: &Kernel, dilation: usize) -> Self {
        let mut out = Self::zeros(kernel.outputs, self.height, self.width);
        let blocks = kernel.blocks(TOGETHER);
        let taps = self.offsets(kernel, dilation);
        let (stride, width) = (out.stride, out.width);
        let plane = (self.height + 2 * MARGIN) * stride;
        let per_block = TOGETHER * taps.len();
        out.data.chunks_mut(TOGETHER * plane).zip(blocks.chunks(per_block)).enumerate().for_each(
            |(block, (planes, weights))| {
                let bias: [f32; TOGETHER] =
                    std::array::from_fn(|k| kernel.bias.get(block * TOGETHER + k).copied().unwrap_or(0.));
                for y in 0..self.height {
                    let row = (y + MARGIN) * stride + MARGIN;
                    for x in (0..width).step_by(LANES) {
                        let sums = self.weighted(weights, &taps, row + x, bias);
                        let lanes = LANES.min(width - x);
                        for (plane, sums) in planes.chunks_mut(plane).zip(&sums) {
                            plane[row + x..row + x + lanes].copy_from_slice(&sums[..lanes]);
                        }
                    }
                }
            },
        );
        out
    }

    /// How far before or after a pixel every tap reads, by input, row and column.
    fn offsets(&self, kernel: &Kernel, dilation: usize) -> Vec<isize> {
        let half = (kernel.side / 2) as isize;
        let (stride, plane) = (self.stride as isize, (self.height + 2 * MARGIN) * self.stride);
        let mut offsets = Vec::with_capacity(kernel.inputs * kernel.side * kernel.side);
        for input in 0..kernel.inputs {
            for j in -half..=half {
                for i in -half..=half {
                    offsets.push((input * plane) as isize + (j * stride + i) * dilation as isize);
                }
            }
        }
        offsets
    }

    #[inline(always)]
    fn weighted<const TOGETHER: usize>(
        &self,
        weights: &[f32],
        taps: &[isize],
        at: usize,
        bias: [f32; TOGETHER],
    ) -> [[f32; LANES]; TOGETHER] {
        let mut sums = bias.map(|b| [b; LANES]);
        for (weights, &offset) in weights.as_chunks::<TOGETHER>().0.iter().zip(taps) {
            let Some(input) =
                self.data.get(at.wrapping_add_signed(offset)..).and_then(|d| d.first_chunk::<LANES>())
            else {
                continue;
            };
            for (sum, &weight) in sums.iter_mut().zip(weights) {
                for (s, v) in sum.iter_mut().zip(input) {
                    *s += weight * v;
                }
            }
        }
        sums
    }

    /// What is below zero becomes zero.
    pub(super) fn rectified(mut self) -> Self {
        self.data.iter_mut().for_each(|v| *v = v.max(0.));
        self
    }

    /// Both of the same size.
    pub(super) fn plus(mut self, other: &Self) -> Self {
        self.data.iter_mut().zip(&other.data).for_each(|(a, b)| *a += b);
        self
    }

    /// Means of 2 × 2 px. Height and width must be even.
    pub(super) fn halved(&self) -> Self {
        let mut out = Self::zeros(self.channels, self.height / 2, self.width / 2);
        for channel in 0..out.channels {
            for y in 0..out.height {
                let (upper, lower) = (self.row(channel, 2 * y), self.row(channel, 2 * y + 1));
                let pairs = upper.as_chunks::<2>().0.iter().zip(lower.as_chunks::<2>().0);
                for (o, (a, b)) in out.row_mut(channel, y).iter_mut().zip(pairs) {
                    *o = 0.25 * ((a[0] + a[1]) + (b[0] + b[1]));
                }
            }
        }
        out
    }

    /// Every pixel as 2 × 2 px.
    pub(super) fn doubled(&self) -> Self {
        let mut out = Self::zeros(self.channels, 2 * self.height, 2 * self.width);
        for channel in 0..out.channels {
            for y in 0..out.height {
                let row = self.row(channel, y / 2);
                for (pair, &v) in out.row_mut(channel, y).as_chunks_mut::<2>().0.iter_mut().zip(row) {
                    *pair = [v; 2];
                }
            }
        }
        out
    }
}

/// Runs `part` for every item, over all cores if there is more than one.
pub(super) fn for_all<T: Sync, R: Send>(items: &[T], part: impl Fn(&T) -> R + Sync + Send) -> Vec<R> {
    if items.len() < 2 { items.iter().map(part).collect() } else { items.par_iter().map(part).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn textured(channels: usize, height: usize, width: usize) -> Maps {
        let mut maps = Maps::zeros(channels, height, width);
        for c in 0..channels {
            for y in 0..height {
                for (x, v) in maps.row_mut(c, y).iter_mut().enumerate() {
                    *v = ((c * 7 + y * 3 + x * 5) % 11) as f32 - 4.;
                }
            }
        }
        maps
    }

    #[test]
    fn a_convolution_equals_its_definition() {
        for (inputs, outputs, side, dilation, width) in
            [(1, 10, 7, 1, 13), (3, 5, 3, 4, 8), (2, 4, 3, 2, 17), (6, 1, 1, 1, 5)]
        {
            let weights: Vec<f32> =
                (0..outputs * inputs * side * side).map(|k| ((k * 13) % 17) as f32 / 8. - 1.).collect();
            let bias: Vec<f32> = (0..outputs).map(|k| k as f32).collect();
            let kernel = Kernel { outputs, inputs, side, weights, bias };
            let maps = textured(inputs, 9, width);
            let out = maps.convolved(&kernel, dilation);
            let half = (side / 2 * dilation) as isize;
            for o in 0..outputs {
                for y in 0..9isize {
                    for x in 0..width as isize {
                        let mut sum = kernel.bias[o];
                        for i in 0..inputs {
                            for (tap, w) in kernel.weights[(o * inputs + i) * side * side..][..side * side]
                                .iter()
                                .enumerate()
                            {
                                let yy = y + (tap / side * dilation) as isize - half;
                                let xx = x + (tap % side * dilation) as isize - half;
                                if (0..9).contains(&yy) && (0..width as isize).contains(&xx) {
                                    sum += w * maps.row(i, yy as usize)[xx as usize];
                                }
                            }
                        }
                        assert!((out.row(o, y as usize)[x as usize] - sum).abs() < 1e-3);
                    }
                }
            }
        }
    }

    #[test]
    fn doubling_and_halving_give_the_same_maps_back() {
        let maps = textured(2, 5, 7);
        assert_eq!(maps.doubled().halved().data, maps.data);
    }
}
