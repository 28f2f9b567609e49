use std::collections::HashMap;

/// Column and row of a cell, which may be negative.
type Cell = (i64, i64);

/// Points of the unbounded plane, sorted into square cells to find the points nearer than a cell's
/// side.
pub(crate) struct HashGrid {
    /// Side of a cell.
    side: f64,
    /// Index and position of each point, by cell.
    cells: HashMap<Cell, Vec<(usize, [f64; 2])>>,
}

impl HashGrid {
    /// Creates an empty grid that finds points up to the distance `reach`.
    pub(crate) fn new(reach: f64) -> Self {
        Self { side: reach, cells: HashMap::new() }
    }

    /// Returns the cell that contains a point.
    fn cell(&self, [x, y]: [f64; 2]) -> Cell {
        ((x / self.side).floor() as i64, (y / self.side).floor() as i64)
    }

    /// Adds a point with an index by which the caller knows it.
    pub(crate) fn insert(&mut self, index: usize, point: [f64; 2]) {
        self.cells.entry(self.cell(point)).or_default().push((index, point));
    }

    /// Returns all points at most a cell's side away from `point`, and some that are farther away.
    ///
    /// The order depends only on the cells and on the order of insertion.
    pub(crate) fn near(&self, point: [f64; 2]) -> impl Iterator<Item = (usize, [f64; 2])> {
        let (column, row) = self.cell(point);
        (-1..=1)
            .flat_map(move |dy| (-1..=1).map(move |dx| (column + dx, row + dy)))
            .filter_map(|cell| self.cells.get(&cell))
            .flatten()
            .copied()
    }
}

/// Returns the distance between two points.
pub(crate) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
    // lengths here are in spacings, so no square can overflow
    (dx * dx + dy * dy).sqrt()
}
