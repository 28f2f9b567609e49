//! Feature maps of the networks, and the memory they are kept in.

use rayon::prelude::*;
use std::cell::RefCell;

/// Width of the frame of zeros around every channel, in px.
///
/// No layer reads farther beyond the border, so no layer has to test where the image ends.
pub(super) const MARGIN: usize = 4;
/// Largest number of pixels that a SIMD register contains: 16 values of 32 bits in 512 bits.
///
/// Rows are padded so that entire registers can be read at their end.
pub(super) const LANES: usize = 16;

/// Feature maps: planes of one size, one per channel, each inside a frame of zeros.
#[derive(Debug)]
pub(super) struct Maps {
    /// Number of planes, one per channel.
    pub(super) channels: usize,
    /// Height in px, without the frame.
    pub(super) height: usize,
    /// Width in px, without the frame.
    pub(super) width: usize,
    /// Number of values from the start of one row in memory to the start of the next.
    pub(super) stride: usize,
    /// Values by channel, row and column, the frames included.
    pub(super) data: Vec<f32>,
}

/// Largest number of dropped maps whose memory a thread keeps: as many as a network has at once.
const KEPT: usize = 6;

thread_local! {
    /// Memory of dropped maps, kept for new maps.
    ///
    /// Layers follow each other so fast that allocating their memory anew takes as long as the
    /// convolutions.
    static MEMORY: RefCell<Vec<Vec<f32>>> = const { RefCell::new(Vec::new()) };
}

impl Drop for Maps {
    fn drop(&mut self) {
        let data = std::mem::take(&mut self.data);
        // fails only while the thread itself is ending
        let _ = MEMORY.try_with(|memory| {
            let mut memory = memory.borrow_mut();
            if memory.len() < KEPT {
                memory.push(data);
            }
        });
    }
}

/// Returns memory for `length` values, whose contents are arbitrary.
///
/// It is the smallest kept piece that is large enough; if there is none, it is newly allocated.
fn memory(length: usize) -> Vec<f32> {
    let kept = MEMORY.try_with(|memory| {
        let mut memory = memory.borrow_mut();
        let fits = (0..memory.len()).filter(|&k| memory[k].capacity() >= length);
        let best = fits.min_by_key(|&k| memory[k].capacity());
        // if no piece is large enough, one is taken out all the same: otherwise small pieces would
        // fill the store
        best.or_else(|| memory.len().checked_sub(1)).map(|k| memory.swap_remove(k))
    });
    let mut data = kept.ok().flatten().unwrap_or_default();
    if data.capacity() < length {
        return vec![0.; length];
    }
    data.resize(length, 0.);
    data
}

impl Maps {
    /// Returns maps in which every value is zero.
    pub(super) fn zeros(channels: usize, height: usize, width: usize) -> Self {
        let mut maps = Self::framed(channels, height, width);
        maps.data.fill(0.);
        maps
    }

    /// Returns maps with zeros in the frame and arbitrary values inside.
    pub(super) fn framed(channels: usize, height: usize, width: usize) -> Self {
        let stride = 2 * MARGIN + width.next_multiple_of(LANES);
        let length = channels * (height + 2 * MARGIN) * stride + LANES;
        let mut maps = Self { channels, height, width, stride, data: memory(length) };
        let plane = maps.plane();
        for data in maps.data.chunks_mut(plane) {
            for (y, row) in data.chunks_mut(stride).enumerate() {
                if (MARGIN..MARGIN + height).contains(&y) && row.len() == stride {
                    row[..MARGIN].fill(0.);
                    row[MARGIN + width..].fill(0.);
                } else {
                    row.fill(0.);
                }
            }
        }
        maps
    }

    /// Returns the number of values from the start of one channel in memory to the start of the
    /// next.
    pub(super) fn plane(&self) -> usize {
        (self.height + 2 * MARGIN) * self.stride
    }

    /// Returns the index in `data` of the first pixel of a row.
    pub(super) fn start(&self, channel: usize, y: usize) -> usize {
        channel * self.plane() + (y + MARGIN) * self.stride + MARGIN
    }

    /// Returns the pixels of a row.
    pub(super) fn row(&self, channel: usize, y: usize) -> &[f32] {
        let start = self.start(channel, y);
        &self.data[start..start + self.width]
    }

    /// Returns the pixels of a row, to be changed.
    pub(super) fn row_mut(&mut self, channel: usize, y: usize) -> &mut [f32] {
        let start = self.start(channel, y);
        &mut self.data[start..start + self.width]
    }

    /// Returns the maps at half the resolution: the means over 2 × 2 px. Height and width must be
    /// even.
    pub(super) fn halved(&self) -> Self {
        let mut out = Self::framed(self.channels, self.height / 2, self.width / 2);
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

    /// Returns the sum of `others` and of these maps at twice their resolution, with every pixel
    /// repeated as 2 × 2 px.
    ///
    /// `others` must have twice the height and width of these maps.
    pub(super) fn doubled_onto(&self, others: &Self) -> Self {
        let mut out = Self::framed(self.channels, 2 * self.height, 2 * self.width);
        for channel in 0..out.channels {
            for y in 0..out.height {
                let row = self.row(channel, y / 2).iter().zip(others.row(channel, y).as_chunks::<2>().0);
                for (pair, (v, other)) in out.row_mut(channel, y).as_chunks_mut::<2>().0.iter_mut().zip(row) {
                    *pair = [v + other[0], v + other[1]];
                }
            }
        }
        out
    }
}

/// Returns the result of `part` for every item; several items are spread over all cores.
pub(super) fn for_all<T: Sync, R: Send>(items: &[T], part: impl Fn(&T) -> R + Sync + Send) -> Vec<R> {
    if items.len() < 2 { items.iter().map(part).collect() } else { items.par_iter().map(part).collect() }
}

/// Returns maps with a value at every pixel.
#[cfg(test)]
pub(super) fn textured(channels: usize, height: usize, width: usize) -> Maps {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubling_and_halving_give_the_same_maps_back() {
        let maps = textured(2, 5, 7);
        assert_eq!(maps.doubled_onto(&Maps::zeros(2, 10, 14)).halved().data, maps.data);
    }

    #[test]
    fn memory_that_was_used_before_leaves_no_trace() {
        let fresh = textured(2, 5, 7).data.clone();
        let mut dirty = textured(3, 9, 30);
        dirty.data.fill(f32::NAN);
        drop(dirty);
        assert_eq!(textured(2, 5, 7).data, fresh);
        let mut framed = Maps::framed(2, 5, 7);
        (0..10).for_each(|k| framed.row_mut(k / 5, k % 5).fill(0.));
        assert!(framed.data.iter().all(|v| *v == 0.));
    }
}
