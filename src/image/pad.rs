use super::Plane;
use ndarray::Axis;

/// The index inside `0..length` that a mirror at the edges shows at `index`, the edge pixel repeated
/// (… 1 0 | 0 1 2 … n−1 | n−1 …): OpenCV's BORDER_REFLECT. `length` must not be 0.
pub fn mirror(index: isize, length: usize) -> usize {
    let period = 2 * length;
    let i = index.rem_euclid(period as isize) as usize;
    if i < length { i } else { period - 1 - i }
}

/// `plane` inside a frame of its own mirror image: `top` and `left` pixels before it, and as many behind it as make
/// `height` × `width`.
pub fn reflect_pad(plane: &Plane, top: usize, left: usize, height: usize, width: usize) -> Plane {
    let (h, w) = plane.dim();
    let columns: Vec<usize> = (0..width).map(|x| mirror(x as isize - left as isize, w)).collect();
    Plane::from_shape_fn((height, width), |(y, x)| plane[[mirror(y as isize - top as isize, h), columns[x]]])
}

/// The part of `plane` of `height` × `width` px whose first pixel is at (`left`, `top`).
pub fn crop(plane: &Plane, top: usize, left: usize, height: usize, width: usize) -> Plane {
    let rows = plane.slice_axis(Axis(0), (top..top + height).into());
    rows.slice_axis(Axis(1), (left..left + width).into()).to_owned()
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
    fn padding_keeps_the_image_in_the_middle() {
        let plane = Plane::from_shape_fn((2, 3), |(y, x)| (10 * y + x) as f32);
        let padded = reflect_pad(&plane, 1, 2, 4, 6);
        assert_eq!(padded.row(1).to_vec(), [1., 0., 0., 1., 2., 2.]);
        assert_eq!(padded.row(0), padded.row(1));
    }
}
