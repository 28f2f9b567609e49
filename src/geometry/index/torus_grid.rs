/// Points on the torus `[0, width) × [0, height)` in the cells of a grid, at most one per cell.
///
/// The diagonal of a cell is at most the smallest distance between two points, so no cell can
/// contain two points. The coordinates of an empty cell are infinite, so it is farther away than
/// any distance asked for and needs no test of its own.
pub(crate) struct TorusGrid {
    width: f64,
    height: f64,
    columns: usize,
    rows: usize,
    cell_width: f64,
    cell_height: f64,
    /// Point of each cell, row by row, or [`EMPTY`].
    cells: Vec<[f64; 2]>,
}

/// Coordinates that mark a cell without a point.
const EMPTY: [f64; 2] = [f64::INFINITY; 2];

impl TorusGrid {
    /// Creates an empty grid for points no two of which are nearer to each other than `radius`.
    pub(crate) fn new(width: f64, height: f64, radius: f64) -> Self {
        let cells_along = |side: f64| ((side * 2f64.sqrt() / radius).ceil() as usize).max(1);
        let (columns, rows) = (cells_along(width), cells_along(height));
        Self {
            width,
            height,
            columns,
            rows,
            cell_width: width / columns as f64,
            cell_height: height / rows as f64,
            cells: vec![EMPTY; columns * rows],
        }
    }

    pub(crate) fn columns(&self) -> usize {
        self.columns
    }

    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    pub(crate) fn cell_size(&self) -> (f64, f64) {
        (self.cell_width, self.cell_height)
    }

    pub(crate) fn clear(&mut self) {
        self.cells.fill(EMPTY);
    }

    /// Adds a point to its cell, which must be empty.
    pub(crate) fn insert(&mut self, x: f64, y: f64) {
        let column = ((x / self.cell_width) as usize).min(self.columns - 1);
        let row = ((y / self.cell_height) as usize).min(self.rows - 1);
        self.cells[row * self.columns + column] = [x, y];
    }

    /// Collects in `near` all points nearer to (x, y) than `reach`.
    ///
    /// The torus is repeated periodically in the plane, and a point is collected at each position
    /// at which it is repeated.
    #[inline]
    pub(crate) fn gather(&self, x: f64, y: f64, reach: f64, near: &mut Nearby) {
        let reach2 = reach * reach;
        let cells_from = |low: f64, size: f64| (low / size).floor() as isize;
        let (left, right) = (cells_from(x - reach, self.cell_width), cells_from(x + reach, self.cell_width));
        let (top, bottom) =
            (cells_from(y - reach, self.cell_height), cells_from(y + reach, self.cell_height));
        near.clear(((right - left + 1) * (bottom - top + 1)) as usize);
        let (columns, rows) = (self.columns as isize, self.rows as isize);
        for unwrapped_row in top..=bottom {
            let turns = if (0..rows).contains(&unwrapped_row) { 0 } else { unwrapped_row.div_euclid(rows) };
            let row = (unwrapped_row - turns * rows) as usize;
            let shift_y = turns as f64 * self.height;
            let cells = &self.cells[row * self.columns..(row + 1) * self.columns];
            let mut keep = |p: [f64; 2], shift_x: f64| {
                let (px, py) = (p[0] + shift_x, p[1] + shift_y);
                near.push_if((px - x) * (px - x) + (py - y) * (py - y) < reach2, px, py);
            };
            if left >= 0 && right < columns {
                for &p in &cells[left as usize..=right as usize] {
                    keep(p, 0.);
                }
            } else {
                for unwrapped in left..=right {
                    let turns = unwrapped.div_euclid(columns);
                    keep(cells[(unwrapped - turns * columns) as usize], turns as f64 * self.width);
                }
            }
        }
        near.pad();
    }
}

/// Number of points that are tested at once, without a branch, so that the processor's vector
/// instructions can be used.
const LANES: usize = 16;

/// Points gathered around a position, padded with infinity so that [`LANES`] of them are tested at
/// once.
#[derive(Default)]
pub(crate) struct Nearby {
    /// Horizontal coordinates; only the first `length` count.
    xs: Vec<f64>,
    /// Vertical coordinates; only the first `length` count.
    ys: Vec<f64>,
    /// Number of points, without the padding.
    length: usize,
}

impl Nearby {
    /// Empties the list and makes room for `most` points.
    #[inline]
    fn clear(&mut self, most: usize) {
        self.length = 0;
        if self.xs.len() < most + LANES {
            self.xs.resize(most + LANES, f64::INFINITY);
            self.ys.resize(most + LANES, f64::INFINITY);
        }
    }

    /// Writes the point in any case, but counts it only if `kept` is `true`.
    ///
    /// This avoids a branch that would be mispredicted: few cells contain a point that is near
    /// enough, and it is unpredictable which cells do.
    #[inline]
    fn push_if(&mut self, kept: bool, x: f64, y: f64) {
        self.xs[self.length] = x;
        self.ys[self.length] = y;
        self.length += usize::from(kept);
    }

    /// Fills the list with infinity up to a multiple of [`LANES`].
    #[inline]
    fn pad(&mut self) {
        let padded = self.length..self.length.next_multiple_of(LANES);
        self.xs[padded.clone()].fill(f64::INFINITY);
        self.ys[padded].fill(f64::INFINITY);
    }

    /// Returns whether any of the points is nearer to (x, y) than the square root of `radius2`.
    #[inline]
    pub(crate) fn any_nearer(&self, x: f64, y: f64, radius2: f64) -> bool {
        let padded = self.length.next_multiple_of(LANES);
        let lanes = self.xs[..padded].chunks_exact(LANES).zip(self.ys[..padded].chunks_exact(LANES));
        for (xs, ys) in lanes {
            let mut hit = false;
            for (px, py) in xs.iter().zip(ys) {
                hit |= (px - x) * (px - x) + (py - y) * (py - y) < radius2;
            }
            if hit {
                return true;
            }
        }
        false
    }

    /// Returns whether a rectangle lies in the disk around a single point; `radius2` is the squared
    /// radius of the disks.
    ///
    /// The rectangle is centred on (x, y), and its sides are 2 × `half`.
    #[inline]
    pub(crate) fn any_covers(&self, x: f64, y: f64, half: [f64; 2], radius2: f64) -> bool {
        self.xs[..self.length].iter().zip(&self.ys[..self.length]).any(|(px, py)| {
            let (dx, dy) = ((px - x).abs() + half[0], (py - y).abs() + half[1]);
            dx * dx + dy * dy < radius2
        })
    }
}
