use super::Plane;
use rayon::prelude::*;
use std::borrow::Cow;

/// Smallest number of pixels of an image that a filter spreads over all cores.
///
/// Smaller images are each filtered by one core, several of them side by side.
pub(crate) const PARALLEL_PIXELS: usize = 1 << 18;

/// Fills a new plane by `fill(y, row)` for every row, over all cores if it is large.
pub(crate) fn fill_rows(height: usize, width: usize, fill: impl Fn(usize, &mut [f32]) + Sync) -> Plane {
    let mut data = vec![0f32; height * width];
    if data.is_empty() {
        return Plane::zeros((height, width));
    }
    if data.len() >= PARALLEL_PIXELS {
        data.par_chunks_mut(width).enumerate().for_each(|(y, row)| fill(y, row));
    } else {
        data.chunks_mut(width).enumerate().for_each(|(y, row)| fill(y, row));
    }
    plane_of(height, width, data)
}

/// Returns the grey values of a plane row by row; they are copied only if the plane is stored in
/// another order.
pub(crate) fn values(plane: &Plane) -> Cow<'_, [f32]> {
    plane.as_slice().map_or_else(|| plane.iter().copied().collect(), Cow::Borrowed)
}

/// Returns the plane whose grey values, row by row, are `values`.
///
/// `values` must contain exactly `height` × `width` numbers.
pub(crate) fn plane_of(height: usize, width: usize, values: Vec<f32>) -> Plane {
    // a plane of another size would be a silent fault of the filter that made it
    assert_eq!(values.len(), height * width, "grey values of a plane of {height} × {width} px");
    Plane::from_shape_vec((height, width), values).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_run_row_by_row_however_a_plane_is_stored() {
        let plane = Plane::from_shape_fn((2, 3), |(y, x)| (10 * y + x) as f32);
        let by_columns = plane.t().as_standard_layout().into_owned().reversed_axes();
        assert_eq!(*values(&plane), [0., 1., 2., 10., 11., 12.]);
        assert_eq!(values(&by_columns), values(&plane));
    }
}
