use super::Domain;

/// Copy of a site with its weight, kept by the grid for fast access.
#[derive(Clone, Copy)]
pub(super) struct Entry {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) weight: f64,
    pub(super) site: u32,
}

/// Sites sorted into the cells of a grid, about one per cell. These are not the cells of the power
/// diagram.
pub(super) struct Grid {
    columns: usize,
    rows: usize,
    /// Smallest coordinates of the domain.
    low: [f64; 2],
    /// Sides of a cell of the grid.
    size: [f64; 2],
    torus: bool,
    /// Index in `entries` at which the sites of each cell start; one more entry is the end of
    /// `entries`.
    starts: Vec<u32>,
    /// Sites, cell by cell.
    entries: Vec<Entry>,
}

impl Grid {
    /// Sorts the sites into cells. Sites with a coordinate that is not finite are left out; sites
    /// outside the domain belong to the nearest cell.
    pub(super) fn new(domain: &Domain, sites: &[[f64; 2]]) -> Self {
        let [low, high] = domain.bounds();
        let (width, height) = (high[0] - low[0], high[1] - low[1]);
        let most = sites.len().max(1);
        let side = (width * height / most as f64).sqrt();
        let along = |length: f64| ((length / side).round() as usize).clamp(1, most);
        let (columns, rows) = (along(width), along(height));
        let mut grid = Self {
            columns,
            rows,
            low,
            size: [width / columns as f64, height / rows as f64],
            torus: domain.is_torus(),
            starts: vec![0; columns * rows + 1],
            entries: Vec::new(),
        };
        let finite = |s: &[f64; 2]| s[0].is_finite() && s[1].is_finite();
        let places: Vec<Option<usize>> = sites.iter().map(|s| finite(s).then(|| grid.place(*s))).collect();
        for place in places.iter().flatten() {
            grid.starts[place + 1] += 1;
        }
        for place in 0..columns * rows {
            grid.starts[place + 1] += grid.starts[place];
        }
        let mut next = grid.starts.clone();
        let none = Entry { x: 0., y: 0., weight: 0., site: u32::MAX };
        grid.entries = vec![none; grid.starts[columns * rows] as usize];
        for (i, place) in places.iter().enumerate() {
            if let Some(place) = place {
                let entry = Entry { x: sites[i][0], y: sites[i][1], weight: 0., site: i as u32 };
                grid.entries[next[*place] as usize] = entry;
                next[*place] += 1;
            }
        }
        grid
    }

    /// Returns the sites in the order of the grid.
    pub(super) fn order(&self) -> impl Iterator<Item = u32> + '_ {
        self.entries.iter().map(|e| e.site)
    }

    /// Sets the weights of the sites.
    pub(super) fn weigh(&mut self, weights: &[f64]) {
        for entry in &mut self.entries {
            entry.weight = weights[entry.site as usize];
        }
    }

    /// Returns the longer side of a cell of the grid.
    pub(super) fn step(&self) -> f64 {
        self.size[0].max(self.size[1])
    }

    /// Returns the index of the cell that contains a point, or of the nearest cell.
    fn place(&self, p: [f64; 2]) -> usize {
        let inside = |axis: usize, most: usize| {
            // casts saturate, so a point below the domain belongs to cell 0
            (((p[axis] - self.low[axis]) / self.size[axis]) as usize).min(most - 1)
        };
        inside(1, self.rows) * self.columns + inside(0, self.columns)
    }

    /// Calls `take` for all sites at most `reach` away from (x, y) along both axes, and for some
    /// that are farther away.
    ///
    /// The arguments of `take` are a slice of entries and the shifts to add to their x and y. On a
    /// torus, all images of a site are visited, each with its own shift, and (x, y) must lie in the
    /// domain. Only images in the domain and its eight neighbours are visited, as a cell can need
    /// no others.
    #[inline]
    pub(super) fn visit(&self, x: f64, y: f64, reach: f64, mut take: impl FnMut(&[Entry], f64, f64)) {
        let cells = |v: f64, axis: usize, count: usize| {
            let from = |v: f64| ((v - self.low[axis]) / self.size[axis]).floor() as isize;
            let count = count as isize;
            let (least, most) = if self.torus { (-count, 2 * count - 1) } else { (0, count - 1) };
            (from(v - reach).clamp(least, most), from(v + reach).clamp(least, most))
        };
        let (left, right) = cells(x, 0, self.columns);
        let (top, bottom) = cells(y, 1, self.rows);
        let (columns, rows) = (self.columns as isize, self.rows as isize);
        for unwrapped in top..=bottom {
            let turns = unwrapped.div_euclid(rows);
            let row = (unwrapped - turns * rows) as usize * self.columns;
            let shift_y = turns as f64 * self.size[1] * self.rows as f64;
            for image in left.div_euclid(columns)..=right.div_euclid(columns) {
                let begin = left.max(image * columns) - image * columns;
                let end = right.min((image + 1) * columns - 1) - image * columns;
                let stretch =
                    self.starts[row + begin as usize] as usize..self.starts[row + end as usize + 1] as usize;
                take(&self.entries[stretch], image as f64 * self.size[0] * self.columns as f64, shift_y);
            }
        }
    }
}
