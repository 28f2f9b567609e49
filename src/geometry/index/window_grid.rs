use crate::geometry::{Point, Rectangle, Window};

/// Points sorted into the cells of a grid, about one per cell.
///
/// For evenly spread points, the grid finds the nearest point faster than a tree.
pub(crate) struct WindowGrid<'a> {
    points: &'a [Point],
    bounds: Rectangle,
    /// `true` if the pattern continues beyond the edges.
    torus: bool,
    columns: usize,
    rows: usize,
    /// Index in `indices` at which the points of each cell start; one more entry is the end of
    /// `indices`.
    starts: Vec<usize>,
    /// Indices of the points, cell by cell.
    indices: Vec<usize>,
}

impl<'a> WindowGrid<'a> {
    /// Sorts points, whose coordinates must be finite, into cells.
    pub(crate) fn new(points: &'a [Point], window: &Window) -> Self {
        let bounds = window.bounds();
        let side = (bounds.area() / points.len().max(1) as f64).sqrt();
        let along = |length: f64| ((length / side) as usize).clamp(1, points.len().max(1));
        let (columns, rows) = (along(bounds.width()), along(bounds.height()));
        let mut grid = Self {
            points,
            bounds,
            torus: window.is_torus(),
            columns,
            rows,
            starts: vec![0; columns * rows + 1],
            indices: Vec::new(),
        };
        let cells: Vec<usize> = points
            .iter()
            .map(|&p| {
                let (column, row) = grid.cell(p);
                row * columns + column
            })
            .collect();
        for cell in &cells {
            grid.starts[cell + 1] += 1;
        }
        for i in 1..grid.starts.len() {
            grid.starts[i] += grid.starts[i - 1];
        }
        let mut next = grid.starts.clone();
        grid.indices = vec![0; points.len()];
        for (index, cell) in cells.into_iter().enumerate() {
            grid.indices[next[cell]] = index;
            next[cell] += 1;
        }
        grid
    }

    /// Returns the column and row of the cell that contains a position, or of the nearest cell if
    /// the position lies outside.
    fn cell(&self, p: Point) -> (usize, usize) {
        let b = &self.bounds;
        let column = (p.x - b.x0()) / b.width() * self.columns as f64;
        let row = (p.y - b.y0()) / b.height() * self.rows as f64;
        ((column as usize).min(self.columns - 1), (row as usize).min(self.rows - 1))
    }

    /// Returns the index of the point nearest to `place`, if the search of the 5 × 5 cells around
    /// `place` proves that no other point is nearer.
    ///
    /// Returns `None` otherwise, and near the edges of a torus, beyond which the pattern continues.
    pub(crate) fn nearest(&self, place: Point) -> Option<usize> {
        let (column, row) = self.cell(place);
        let b = &self.bounds;
        let (width, height) = (b.width() / self.columns as f64, b.height() / self.rows as f64);
        let mut best = (f64::INFINITY, 0);
        for reach in 1..=2 {
            let beyond =
                [column < reach, column + reach >= self.columns, row < reach, row + reach >= self.rows];
            if self.torus && beyond.contains(&true) {
                return None;
            }
            let columns = column.saturating_sub(reach)..(column + reach + 1).min(self.columns);
            let rows = row.saturating_sub(reach)..(row + reach + 1).min(self.rows);
            for row in rows.clone() {
                let line = row * self.columns;
                for &index in
                    &self.indices[self.starts[line + columns.start]..self.starts[line + columns.end]]
                {
                    let (dx, dy) = (self.points[index].x - place.x, self.points[index].y - place.y);
                    let d2 = dx * dx + dy * dy;
                    if d2 < best.0 {
                        best = (d2, index);
                    }
                }
            }
            let sides = [
                place.x - (b.x0() + columns.start as f64 * width),
                b.x0() + columns.end as f64 * width - place.x,
                place.y - (b.y0() + rows.start as f64 * height),
                b.y0() + rows.end as f64 * height - place.y,
            ];
            // there are no points beyond the bounds
            let open = sides.into_iter().zip(beyond).filter(|(_, beyond)| !beyond);
            // the margin keeps rounding from hiding a nearer point
            let sure = open.map(|(side, _)| side).fold(f64::INFINITY, f64::min) * (1. - 1e-9);
            if sure > 0. && best.0.is_finite() && best.0 <= sure * sure {
                return Some(best.1);
            }
        }
        None
    }
}
