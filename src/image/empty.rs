//! Pixels that were not imaged: counting them in rectangles, and filling them in.
//!
//! 1. A summed-area table gives the count in any rectangle by four look-ups.
//! 2. Pull–push (Gortler et al. 1996, <https://doi.org/10.1145/237170.237200>) fills them in: the
//!    plane is averaged to ever coarser versions until all pixels are known, and each version then
//!    fills in the next finer one.

use super::{Plane, fill_rows, imaged_mask};

/// Pixels of an image that were not imaged, see [`imaged_mask`].
#[derive(Clone, Debug, PartialEq)]
pub struct EmptyPixels {
    /// Width of the image in px.
    width: usize,
    /// Height of the image in px.
    height: usize,
    /// Mask of the image, row by row: `true` for a pixel that was imaged.
    imaged: Vec<bool>,
    /// Summed-area table: the number of empty pixels above and to the left of every corner of a
    /// pixel, (height + 1) × (width + 1) values row by row.
    sums: Vec<u32>,
}

impl EmptyPixels {
    /// Finds the empty pixels of an image, or returns `None` if every pixel was imaged.
    pub fn of(plane: &Plane) -> Option<Self> {
        let (height, width) = plane.dim();
        imaged_mask(plane).map(|imaged| Self::not(imaged, height, width))
    }

    /// Returns the blocks of `block` × `block` px that contain an empty pixel, as empty pixels of a
    /// coarser image, or `None` if there are none.
    ///
    /// Pixels at the right and at the bottom that do not fill a block are left out.
    pub fn in_blocks(&self, block: usize) -> Option<Self> {
        let (height, width) = (self.height / block, self.width / block);
        let whole = |k: usize| {
            let (left, top) = (k % width * block, k / width * block);
            self.part(left, top, left + block, top + block) == 0.
        };
        let imaged: Vec<bool> = (0..height * width).map(whole).collect();
        imaged.contains(&false).then(|| Self::not(imaged, height, width))
    }

    /// Returns the empty pixels of an image of `height` × `width` px: those outside the mask
    /// `imaged`.
    pub(crate) fn not(imaged: Vec<bool>, height: usize, width: usize) -> Self {
        let mut sums = vec![0u32; (height + 1) * (width + 1)];
        for y in 0..height {
            let mut in_row = 0;
            for x in 0..width {
                in_row += u32::from(!imaged[y * width + x]);
                sums[(y + 1) * (width + 1) + x + 1] = sums[y * (width + 1) + x + 1] + in_row;
            }
        }
        Self { width, height, imaged, sums }
    }

    /// Returns the fraction (0–1) of a rectangle that was not imaged: the columns `left..right` and
    /// rows `top..bottom`.
    ///
    /// Pixels beyond the image do not count. If the rectangle contains no pixel of the image, the
    /// fraction is 0.
    pub fn part(&self, left: usize, top: usize, right: usize, bottom: usize) -> f64 {
        let (right, bottom) = (right.min(self.width), bottom.min(self.height));
        let (left, top) = (left.min(right), top.min(bottom));
        let sum = |x: usize, y: usize| i64::from(self.sums[y * (self.width + 1) + x]);
        let count = sum(right, bottom) - sum(left, bottom) - sum(right, top) + sum(left, top);
        count as f64 / ((right - left) * (bottom - top)).max(1) as f64
    }

    /// Returns whether the pixel in column `x` and row `y` was not imaged; pixels beyond the image
    /// count as not imaged.
    pub fn contains(&self, x: usize, y: usize) -> bool {
        x >= self.width || y >= self.height || !self.imaged[y * self.width + x]
    }

    /// Returns `plane` with the empty pixels filled in smoothly from the pixels around them, so
    /// that filters meet no edge there.
    ///
    /// The method is pull–push (Gortler et al. 1996, <https://doi.org/10.1145/237170.237200>).
    pub fn filled(&self, plane: &Plane) -> Plane {
        let weight = Plane::from_shape_fn(plane.dim(), |(y, x)| if self.contains(x, y) { 0. } else { 1. });
        let mut value = plane.clone();
        pull_push(&mut value, &weight);
        value
    }
}

/// Changes the values of pixels of weight 0 in `value` to those of a coarser version of the plane,
/// in which all pixels are known.
fn pull_push(value: &mut Plane, weight: &Plane) {
    let (h, w) = value.dim();
    if weight.iter().all(|v| *v > 0.) || h.max(w) == 1 {
        return;
    }
    let (height, width) = (h.div_ceil(2), w.div_ceil(2));
    let cells = |y: usize, x: usize| {
        (2 * y..(2 * y + 2).min(h)).flat_map(move |j| (2 * x..(2 * x + 2).min(w)).map(move |i| [j, i]))
    };
    let coarse_weight = fill_rows(height, width, |y, out| {
        for (x, o) in out.iter_mut().enumerate() {
            *o = cells(y, x).map(|at| weight[at]).fold(0., f32::max);
        }
    });
    let mut coarse = fill_rows(height, width, |y, out| {
        for (x, o) in out.iter_mut().enumerate() {
            let (sum, total) =
                cells(y, x).fold((0., 0.), |(s, t), at| (s + weight[at] * value[at], t + weight[at]));
            *o = if total > 0. { sum / total } else { 0. };
        }
    });
    pull_push(&mut coarse, &coarse_weight);
    // linear interpolation between the centres of the coarse pixels
    let ends = |k: usize, length: usize| {
        let place = (k as f32 + 0.5) / 2. - 0.5;
        let first = place.floor().max(0.) as usize;
        (first, (first + 1).min(length - 1), (place - first as f32).max(0.))
    };
    for ((y, x), v) in value.indexed_iter_mut().filter(|(at, _)| weight[*at] == 0.) {
        let ((j, k, t), (i, l, s)) = (ends(y, height), ends(x, width));
        let along = |row: usize| coarse[[row, i]] + s * (coarse[[row, l]] - coarse[[row, i]]);
        *v = along(j) + t * (along(k) - along(j));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn half_empty() -> Plane {
        Plane::from_shape_fn((60, 80), |(y, x)| if x + y < 50 { 0. } else { 1. + 0.01 * x as f32 })
    }

    #[test]
    fn the_empty_part_of_any_rectangle_is_its_count() {
        let empty = EmptyPixels::of(&half_empty()).unwrap();
        for (left, top, right, bottom) in [(0, 0, 80, 60), (3, 7, 31, 22), (70, 50, 200, 200), (5, 5, 5, 9)] {
            let (right_end, bottom_end) = (right.min(80), bottom.min(60));
            let all = (right_end - left) * (bottom_end - top);
            let count = (top..bottom_end)
                .flat_map(|y| (left..right_end).map(move |x| x + y < 50))
                .filter(|e| *e)
                .count();
            assert_eq!(empty.part(left, top, right, bottom), count as f64 / all.max(1) as f64);
        }
    }

    #[test]
    fn blocks_with_empty_pixels_are_empty() {
        let empty = EmptyPixels::of(&half_empty()).unwrap();
        let blocks = empty.in_blocks(7).unwrap();
        for (x, y) in (0..80 / 7).flat_map(|x| (0..60 / 7).map(move |y| (x, y))) {
            assert_eq!(blocks.contains(x, y), 7 * x + 7 * y < 50);
        }
        assert!(
            blocks.contains(11, 0) && blocks.contains(0, 8),
            "what does not fill a block is beyond the image"
        );
    }

    #[test]
    fn filling_continues_the_image_and_changes_nothing_that_was_imaged() {
        let plane = half_empty();
        let filled = EmptyPixels::of(&plane).unwrap().filled(&plane);
        for ((at, v), f) in plane.indexed_iter().zip(&filled) {
            if *v > 0. {
                assert_eq!(v, f);
            } else {
                assert!((1.0..1.9).contains(f), "{at:?}: {f}");
            }
        }
    }

    #[test]
    fn a_whole_image_has_no_empty_pixels() {
        assert!(EmptyPixels::of(&Plane::ones((30, 30))).is_none());
    }
}
