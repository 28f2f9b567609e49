use super::Plane;
use rayon::prelude::*;

/// From this many pixels on, a filter spreads one image over all cores. Smaller images travel side by side instead.
pub(crate) const PARALLEL_PIXELS: usize = 1 << 18;

/// Runs `fill(y, row)` for every row of a new plane, over all cores if it is large.
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
    Plane::from_shape_vec((height, width), data).unwrap_or_default()
}
