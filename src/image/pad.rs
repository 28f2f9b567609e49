use super::{Plane, fill_rows, values};
use ndarray::{Axis, Zip};

/// Returns the index inside `0..length` that a mirror at the edges shows at `index`.
///
/// The edge pixel is repeated (… 1 0 | 0 1 2 … n−1 | n−1 …), as in OpenCV's BORDER_REFLECT.
/// `length` must not be 0.
pub fn mirror(index: isize, length: usize) -> usize {
    let period = 2 * length;
    let i = index.rem_euclid(period as isize) as usize;
    if i < length { i } else { period - 1 - i }
}

/// Returns `row` between `before` and `after` elements of its own mirror image (see [`mirror`]).
///
/// `row` must not be empty.
pub(super) fn framed(row: &[f32], before: usize, after: usize) -> Vec<f32> {
    let length = row.len() as isize;
    let end = length + after as isize;
    let mut framed = Vec::with_capacity(before + row.len() + after);
    let mut i = -(before as isize);
    while i < end {
        // the mirror shows copies of the row, every other one backwards
        let within = i.rem_euclid(length);
        let run = (length - within).min(end - i);
        if i.div_euclid(length) % 2 == 0 {
            framed.extend_from_slice(&row[within as usize..(within + run) as usize]);
        } else {
            framed.extend(row[(length - within - run) as usize..(length - within) as usize].iter().rev());
        }
        i += run;
    }
    framed
}

/// Returns `plane` inside a frame of its own mirror image, `height` × `width` px in all.
///
/// The frame has `top` rows above the plane and `left` columns to its left; the rest lies below and
/// to the right. `height` and `width` must be large enough for all of this.
pub fn reflect_pad(plane: &Plane, top: usize, left: usize, height: usize, width: usize) -> Plane {
    let (h, w) = plane.dim();
    let data = values(plane);
    fill_rows(height, width, |y, out| {
        let y = mirror(y as isize - top as isize, h);
        out.copy_from_slice(&framed(&data[y * w..(y + 1) * w], left, width - left - w));
    })
}

/// Returns the part of `plane` that is `height` × `width` px large and begins in row `top` and
/// column `left`.
pub fn crop(plane: &Plane, top: usize, left: usize, height: usize, width: usize) -> Plane {
    let rows = plane.slice_axis(Axis(0), (top..top + height).into());
    rows.slice_axis(Axis(1), (left..left + width).into()).to_owned()
}

/// Returns a coarser plane, whose pixels are the means over blocks of `block` × `block` px.
///
/// Pixels at the right and at the bottom that do not fill a block are left out. `block` must not be
/// 0.
pub fn block_means(plane: &Plane, block: usize) -> Plane {
    let share = 1. / (block * block) as f32;
    Zip::from(plane.exact_chunks((block, block))).map_collect(|pixels| share * pixels.sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mirror_repeats_the_edge_pixel() {
        let seen: Vec<usize> = (-4..7).map(|i| mirror(i, 3)).collect();
        assert_eq!(seen, [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
    }

    #[test]
    fn blocks_hold_their_means_and_the_rest_is_left_out() {
        let plane = Plane::from_shape_fn((5, 7), |(y, x)| (10 * y + x) as f32);
        let means = block_means(&plane, 2);
        assert_eq!(means.dim(), (2, 3));
        assert_eq!(means[[1, 2]], 29.5);
    }

    #[test]
    fn frames_are_mirror_images_however_wide() {
        for (before, after) in [(0, 0), (2, 1), (3, 4), (8, 11)] {
            let expected: Vec<f32> =
                (-(before as isize)..3 + after as isize).map(|i| mirror(i, 3) as f32).collect();
            assert_eq!(framed(&[0., 1., 2.], before, after), expected);
        }
    }

    #[test]
    fn padding_keeps_the_image_in_the_middle() {
        let plane = Plane::from_shape_fn((2, 3), |(y, x)| (10 * y + x) as f32);
        let padded = reflect_pad(&plane, 1, 2, 4, 6);
        assert_eq!(padded.row(1).to_vec(), [1., 0., 0., 1., 2., 2.]);
        assert_eq!(padded.row(0), padded.row(1));
    }
}
