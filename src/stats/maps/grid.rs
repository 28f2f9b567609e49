use super::surface::{Surface, weighted};
use super::{LocalFlag, LocalValues};
use crate::geometry::{Point, Rectangle};

/// Map sampled at the centres of square grid cells that cover the bounding box of a window.
///
/// Grid cells are stored row by row, from the upper left.
#[derive(Clone, Debug)]
pub struct MapGrid {
    /// Number of grid cells per row.
    pub columns: usize,
    /// Number of rows of the grid.
    pub rows: usize,
    /// Side of a grid cell, in units of the coordinates.
    pub step: f64,
    /// Value of the map in each grid cell; NaN where the map is not defined.
    ///
    /// The map is interpolated in triangles between cones. It is not defined outside the convex
    /// hull of the cones, outside the window, and in triangles of which a corner has no value.
    pub values: Vec<f64>,
    /// Flag of each grid cell: `true` if its value is interpolated between three cones whose local
    /// windows all lie inside the window of the mosaic.
    pub whole: Vec<bool>,
}

/// Samples the map of the local value that `value` selects on a square grid over `bounds`.
///
/// `longer` is the number of grid cells along the longer side of `bounds`.
pub(super) fn grid(
    surface: &Surface,
    bounds: &Rectangle,
    local: &[LocalValues],
    value: impl Fn(&LocalValues) -> Option<f64>,
    longer: usize,
) -> MapGrid {
    let step = bounds.width().max(bounds.height()) / longer.max(1) as f64;
    let count = |length: f64| (length / step).ceil().clamp(1., longer.max(1) as f64) as usize;
    let (columns, rows) = (count(bounds.width()), count(bounds.height()));
    let mut values = vec![f64::NAN; columns * rows];
    let mut whole = vec![false; columns * rows];
    let map: Vec<Option<f64>> = local.iter().map(value).collect();
    // Indices of the grid cells whose centres lie between `from` and `to`, along an axis on which
    // the grid starts at `low`.
    let span = |from: f64, to: f64, low: f64, count: usize| {
        let first = ((from - low) / step - 0.5).ceil().max(0.) as usize;
        let last = ((to - low) / step - 0.5).floor();
        first..if last < 0. { 0 } else { (last as usize + 1).min(count) }
    };
    for triangle in &surface.triangles {
        let all = triangle.corners.iter().all(|&k| local[k].flag == LocalFlag::Whole);
        let [left, upper, right, lower] = surface.extent(triangle);
        for row in span(upper, lower, bounds.y0(), rows) {
            for column in span(left, right, bounds.x0(), columns) {
                let place = Point::new(
                    bounds.x0() + (column as f64 + 0.5) * step,
                    bounds.y0() + (row as f64 + 0.5) * step,
                );
                let found = surface.shares(triangle, place).and_then(|s| weighted(&map, triangle, s));
                if let Some(found) = found {
                    values[row * columns + column] = found;
                    whole[row * columns + column] = all;
                }
            }
        }
    }
    MapGrid { columns, rows, step, values, whole }
}
