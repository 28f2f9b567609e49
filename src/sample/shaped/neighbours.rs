/// List of the pairs of points on a torus that are nearer than the cut-off distance `reach`.
///
/// Each pair is listed at the first of its two points. Pairs up to `reach` + `margin` apart are
/// listed, so the list stays complete until a point has moved by half the margin.
///
/// Source: Verlet (1967), <https://doi.org/10.1103/PhysRev.159.98>.
pub(super) struct NeighbourList {
    /// Index in `partners` at which the partners of each point start; one more entry is the end of
    /// `partners`.
    starts: Vec<usize>,
    /// Indices of the second points of all pairs.
    partners: Vec<u32>,
    /// Positions of the points when the list was made.
    made_at: Vec<[f64; 2]>,
    /// Sides of the torus.
    sides: [f64; 2],
    /// Distance below which pairs are visited.
    reach: f64,
    /// Distance beyond `reach` up to which pairs are listed too.
    margin: f64,
}

impl NeighbourList {
    /// Creates the list for pairs nearer than `reach`; `reach` is at most half of the torus's
    /// shorter side.
    ///
    /// `margin` is the distance by which the list extends beyond `reach`.
    pub(super) fn new(points: &[[f64; 2]], sides: [f64; 2], reach: f64, margin: f64) -> Self {
        let mut list =
            Self { starts: Vec::new(), partners: Vec::new(), made_at: Vec::new(), sides, reach, margin };
        list.make(points);
        list
    }

    /// Makes the list anew if a point has moved by more than half the margin.
    pub(super) fn follow(&mut self, points: &[[f64; 2]]) {
        let most = self.margin * self.margin / 4.;
        let moved = points.iter().zip(&self.made_at).any(|(p, q)| {
            let [dx, dy] = self.shortest(*q, *p);
            dx * dx + dy * dy > most
        });
        if moved {
            self.make(points);
        }
    }

    /// Returns the vector from `p` to the nearest periodic image of `q` on the torus.
    #[inline]
    pub(super) fn shortest(&self, p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
        let wrap = |d: f64, side: f64| {
            let half = 0.5 * side;
            if d > half {
                d - side
            } else if d < -half {
                d + side
            } else {
                d
            }
        };
        [wrap(q[0] - p[0], self.sides[0]), wrap(q[1] - p[1], self.sides[1])]
    }

    /// Calls `pair(i, j, dx, dy, d²)` once for every pair nearer than `reach`.
    ///
    /// (dx, dy) is the vector from point i to point j, and d its length.
    #[inline]
    pub(super) fn visit(&self, points: &[[f64; 2]], mut pair: impl FnMut(usize, usize, f64, f64, f64)) {
        let reach2 = self.reach * self.reach;
        for (i, &p) in points.iter().enumerate() {
            for &j in &self.partners[self.starts[i]..self.starts[i + 1]] {
                let j = j as usize;
                let [dx, dy] = self.shortest(p, points[j]);
                let d2 = dx * dx + dy * dy;
                if d2 < reach2 {
                    pair(i, j, dx, dy, d2);
                }
            }
        }
    }

    /// Makes the list for `points`, with a grid of cells.
    fn make(&mut self, points: &[[f64; 2]]) {
        let far = self.reach + self.margin;
        // at most 4096 cells along a side, which bounds the memory
        let along = |side: f64| ((2. * side / far) as usize).clamp(1, 4096);
        let (columns, rows) = (along(self.sides[0]), along(self.sides[1]));
        let cell = |v: f64, side: f64, cells: usize| ((v / side * cells as f64) as usize).min(cells - 1);
        let mut cells = vec![Vec::new(); columns * rows];
        for (i, p) in points.iter().enumerate() {
            let at = cell(p[1], self.sides[1], rows) * columns + cell(p[0], self.sides[0], columns);
            cells[at].push(i as u32);
        }
        // Cells are at least half as wide as `far`, so two cells on either side are searched. On a
        // small torus all cells are searched, each once.
        let around = |at: usize, cells: usize| -> Vec<usize> {
            if cells <= 5 {
                (0..cells).collect()
            } else {
                (0..5).map(|k| (at + cells + k - 2) % cells).collect()
            }
        };
        self.partners.clear();
        self.starts.clear();
        self.starts.push(0);
        for (i, &p) in points.iter().enumerate() {
            let (row, column) = (cell(p[1], self.sides[1], rows), cell(p[0], self.sides[0], columns));
            let near_columns = around(column, columns);
            for r in around(row, rows) {
                for &c in &near_columns {
                    for &j in &cells[r * columns + c] {
                        if (j as usize) > i {
                            let [dx, dy] = self.shortest(p, points[j as usize]);
                            if dx * dx + dy * dy < far * far {
                                self.partners.push(j);
                            }
                        }
                    }
                }
            }
            self.starts.push(self.partners.len());
        }
        self.made_at.clear();
        self.made_at.extend_from_slice(points);
    }
}
