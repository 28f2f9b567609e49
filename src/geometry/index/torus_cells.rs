/// Points on the torus `[0, width) × [0, height)`, sorted into cells to find whether any point is
/// near a position.
///
/// Cells are no smaller than the largest distance of a query, so only the cells around a position
/// are searched.
pub(crate) struct TorusCells {
    /// Width and height of the torus.
    sides: [f64; 2],
    columns: usize,
    rows: usize,
    /// Points of each cell, row by row.
    cells: Vec<Vec<[f64; 2]>>,
}

impl TorusCells {
    /// Creates empty cells for queries up to the distance `reach`, with at most `most` cells per
    /// side.
    pub(crate) fn new(sides: [f64; 2], reach: f64, most: usize) -> Self {
        // more cells than points along a side would only cost memory
        let along = |side: f64| ((side / reach) as usize).clamp(1, most.max(1));
        let (columns, rows) = (along(sides[0]), along(sides[1]));
        Self { sides, columns, rows, cells: vec![Vec::new(); columns * rows] }
    }

    /// Returns the column and row of the cell that contains a point.
    fn cell(&self, [x, y]: [f64; 2]) -> (usize, usize) {
        let along = |v: f64, side: f64, number: usize| ((v / side * number as f64) as usize).min(number - 1);
        (along(x, self.sides[0], self.columns), along(y, self.sides[1], self.rows))
    }

    /// Adds a point of the torus.
    pub(crate) fn insert(&mut self, point: [f64; 2]) {
        let (column, row) = self.cell(point);
        self.cells[row * self.columns + column].push(point);
    }

    /// Returns whether any point is nearer to `place` than `distance`, by the shortest way round.
    ///
    /// `distance` must be at most the `reach` for which the cells were created.
    pub(crate) fn any_nearer(&self, place: [f64; 2], distance: f64) -> bool {
        let (column, row) = self.cell(place);
        let around = |at: usize, number: usize| {
            // with fewer than three cells around the torus, each is searched once
            let (from, count) = if number < 3 { (0, number) } else { (at + number - 1, 3) };
            (from..from + count).map(move |k| k % number)
        };
        let apart = |a: f64, b: f64, side: f64| {
            let d = (a - b).abs();
            d.min(side - d)
        };
        around(row, self.rows).any(|row| {
            around(column, self.columns).any(|column| {
                self.cells[row * self.columns + column].iter().any(|p| {
                    let (dx, dy) =
                        (apart(p[0], place[0], self.sides[0]), apart(p[1], place[1], self.sides[1]));
                    dx * dx + dy * dy < distance * distance
                })
            })
        })
    }
}
