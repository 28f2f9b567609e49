//! Grid search for all pairs of points that are no farther apart than a cut-off distance.
//!
//! 1. Sort the points by cell of a grid whose cells are at least a third of the cut-off distance
//!    wide.
//! 2. For each point, scan the rest of its cell, the cells to its right and the rows below, up to
//!    the cut-off distance. Only one half of the plane is searched, so every pair is visited once.
//! 3. On a torus, cells beyond an edge are the cells at the opposite edge, shifted by the window's
//!    width or height.

use crate::geometry::{Point, Window};

/// Number of grid cells per cut-off distance along either axis.
///
/// More cells follow the disk around a point more closely, so that fewer points beyond the cut-off
/// distance are tried; fewer cells are looked up faster.
const CELLS_PER_REACH: f64 = 3.;

/// Points sorted by grid cell, so that all pairs up to a cut-off distance can be visited in time
/// linear in the number of pairs.
///
/// On a torus, a point is paired with every periodic image of another point within the cut-off
/// distance. The entire disk around each point is therefore covered, even if the cut-off distance
/// exceeds half the window. A point is not paired with its own images.
pub(super) struct PairGrid {
    /// Left edge of the window's bounds.
    x0: f64,
    /// Upper edge of the window's bounds.
    y0: f64,
    width: f64,
    height: f64,
    /// `true` if points are also paired across the edges of the window.
    torus: bool,
    /// Number of grid cells per row.
    columns: usize,
    /// Number of rows of grid cells.
    rows: usize,
    /// Index of each cell's first point in sorted order, followed by the number of points.
    starts: Vec<usize>,
    /// Coordinates x of the points in sorted order.
    xs: Vec<f64>,
    /// Coordinates y of the points in sorted order.
    ys: Vec<f64>,
    /// Original index of each sorted point.
    given: Vec<usize>,
    /// Cut-off distance: the largest distance of a pair.
    reach: f64,
}

impl PairGrid {
    /// Sorts the points into cells, to find pairs that are no farther apart than `reach`.
    ///
    /// The points must lie in the window. `torus` is `true` if points are to be paired across the
    /// edges of the window.
    pub(super) fn new(points: &[Point], window: &Window, torus: bool, reach: f64) -> Self {
        let bounds = window.bounds();
        let (x0, y0, width, height) = (bounds.x0(), bounds.y0(), bounds.width(), bounds.height());
        // More cells than points would only cost time, hence the second lower bound on the side of
        // a cell.
        let side = (reach / CELLS_PER_REACH).max((width * height / points.len().max(1) as f64).sqrt());
        let cells_along = |length: f64| ((length / side) as usize).clamp(1, points.len().max(1));
        let (columns, rows) = (cells_along(width), cells_along(height));
        let cell_of = |p: &Point| {
            let column = ((p.x - x0) / width * columns as f64) as usize;
            let row = ((p.y - y0) / height * rows as f64) as usize;
            row.min(rows - 1) * columns + column.min(columns - 1)
        };
        let mut starts = vec![0; columns * rows + 1];
        for p in points {
            starts[cell_of(p) + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        let (mut xs, mut ys) = (vec![0.; points.len()], vec![0.; points.len()]);
        let mut given = vec![0; points.len()];
        for (index, p) in points.iter().enumerate() {
            let slot = &mut next[cell_of(p)];
            xs[*slot] = p.x;
            ys[*slot] = p.y;
            given[*slot] = index;
            *slot += 1;
        }
        Self { x0, y0, width, height, torus, columns, rows, starts, xs, ys, given, reach }
    }

    /// Returns the number of rows of cells.
    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// Returns one value per point in the sorted order of the grid, from `of_points`, the values in
    /// the original order.
    pub(super) fn sorted<T: Copy>(&self, of_points: &[T]) -> Vec<T> {
        self.given.iter().map(|&index| of_points[index]).collect()
    }

    /// Returns the point with index `i` in sorted order.
    pub(super) fn point(&self, i: usize) -> Point {
        Point::new(self.xs[i], self.ys[i])
    }

    /// Visits the pairs whose first point lies in one of the cell rows `rows`, each pair once.
    ///
    /// `pair` receives the indices of both points in sorted order and the vector from the first to
    /// the second.
    pub(super) fn visit(&self, rows: std::ops::Range<usize>, mut pair: impl FnMut(usize, usize, f64, f64)) {
        let (cell_width, cell_height) = (self.width / self.columns as f64, self.height / self.rows as f64);
        // Cells are searched slightly farther than `reach`, because rounding must not exclude a
        // pair at exactly that distance.
        let reach = self.reach * (1. + 1e-9);
        let reach2 = self.reach * self.reach;
        let mut scan = |from: usize, first: usize, last: usize, shift_x: f64, shift_y: f64| {
            let (x, y) = (self.xs[from] - shift_x, self.ys[from] - shift_y);
            for (k, (px, py)) in self.xs[first..last].iter().zip(&self.ys[first..last]).enumerate() {
                let (dx, dy) = (px - x, py - y);
                if dx * dx + dy * dy <= reach2 {
                    pair(from, first + k, dx, dy);
                }
            }
        };
        let rows_down = (reach / cell_height).floor() as usize + 1;
        for row in rows {
            for column in 0..self.columns {
                let cell = row * self.columns + column;
                for i in self.starts[cell]..self.starts[cell + 1] {
                    let (x, y) = (self.xs[i] - self.x0, self.ys[i] - self.y0);
                    // Half of the plane suffices: the rest of this row to the right, then the rows
                    // below.
                    scan(i, i + 1, self.starts[cell + 1], 0., 0.);
                    let right = ((x + reach) / cell_width).floor() as isize;
                    self.segments(row, column as isize + 1, right, |first, last, shift| {
                        self.scan_others(i, first, last, shift, 0., &mut scan);
                    });
                    for down in 1..=rows_down {
                        let below = row + down;
                        if !self.torus && below >= self.rows {
                            break;
                        }
                        let gap = (below as f64 * cell_height - y).max(0.);
                        if gap > reach {
                            break;
                        }
                        let half = (reach * reach - gap * gap).sqrt();
                        let left = ((x - half) / cell_width).floor() as isize;
                        let right = ((x + half) / cell_width).floor() as isize;
                        let shift_y = (below / self.rows) as f64 * self.height;
                        self.segments(below % self.rows, left, right, |first, last, shift| {
                            self.scan_others(i, first, last, shift, shift_y, &mut scan);
                        });
                    }
                }
            }
        }
    }

    /// Scans the sorted points `first..last` except point `i`, because a point is not paired with
    /// its own image.
    #[inline]
    fn scan_others(
        &self,
        i: usize,
        first: usize,
        last: usize,
        shift_x: f64,
        shift_y: f64,
        scan: &mut impl FnMut(usize, usize, usize, f64, f64),
    ) {
        if (first..last).contains(&i) {
            scan(i, first, i, shift_x, shift_y);
            scan(i, i + 1, last, shift_x, shift_y);
        } else {
            scan(i, first, last, shift_x, shift_y);
        }
    }

    /// Calls `run` for each contiguous range of sorted points in the columns `left..=right` of a
    /// row.
    ///
    /// `run` receives the first index, the end index and the shift along x. On a torus the shift is
    /// a multiple of the window's width, otherwise it is 0.
    #[inline]
    fn segments(&self, row: usize, left: isize, right: isize, mut run: impl FnMut(usize, usize, f64)) {
        let columns = self.columns as isize;
        let begin = row * self.columns;
        if !self.torus || (left >= 0 && right < columns) {
            let (left, right) = (left.max(0), right.min(columns - 1));
            if left <= right {
                run(self.starts[begin + left as usize], self.starts[begin + right as usize + 1], 0.);
            }
            return;
        }
        let mut at = left;
        while at <= right {
            let turn = at.div_euclid(columns);
            let last = right.min((turn + 1) * columns - 1);
            let (a, b) = ((at - turn * columns) as usize, (last - turn * columns) as usize);
            run(self.starts[begin + a], self.starts[begin + b + 1], turn as f64 * self.width);
            at = last + 1;
        }
    }
}
