use super::Domain;
use thiserror::Error;

/// Reason why values do not make a density.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RasterError {
    /// Number of values that is not columns × rows.
    #[error("a density of {columns} × {rows} cells was given {values} values: expected one value per cell")]
    Shape {
        /// Number of cells along x.
        columns: usize,
        /// Number of cells along y.
        rows: usize,
        /// Number of values passed.
        values: usize,
    },
    /// Value that is negative or not finite.
    #[error(
        "the density at column {column}, row {row} (counted from 0) is {value}: expected a finite number, \
         0 or more"
    )]
    Value {
        /// Column of the value, from 0.
        column: usize,
        /// Row of the value, from 0.
        row: usize,
        /// Value that was passed.
        value: f64,
    },
    /// Density that is 0 everywhere.
    #[error(
        "the density is 0 everywhere, so no point can be placed: give a density that is above 0 somewhere"
    )]
    Empty,
}

/// Density over the bounds of a domain, constant within each cell of a raster.
///
/// Integrals over polygons are exact. By Green's theorem they are integrals of F(x, y) = ∫₀ˣ ρ and
/// similar functions along the outline; these functions are tabulated at the edges of the columns
/// and are polynomials in between.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    columns: usize,
    rows: usize,
    /// Width and height of a cell of the raster.
    size: [f64; 2],
    /// Smallest coordinates of the domain.
    low: [f64; 2],
    torus: bool,
    /// Densities row by row, divided by the largest one.
    density: Vec<f64>,
    /// Integrals ∫ρ dx and ∫ρ x dx from the left edge of the domain to each edge of a column; there
    /// are (columns + 1) entries per row.
    ahead: Vec<[f64; 2]>,
}

impl Raster {
    /// Creates a density from values in row order over the bounds of `domain`.
    ///
    /// The unit of the values is arbitrary, as only their ratios count.
    ///
    /// # Errors
    /// Fails if the number of values is not columns × rows, a value is negative or not finite, or
    /// all values are 0.
    pub fn new(domain: &Domain, columns: usize, rows: usize, density: Vec<f64>) -> Result<Self, RasterError> {
        if density.len() != columns.saturating_mul(rows) || density.is_empty() {
            return Err(RasterError::Shape { columns, rows, values: density.len() });
        }
        if let Some(at) = density.iter().position(|v| !v.is_finite() || *v < 0.) {
            return Err(RasterError::Value { column: at % columns, row: at / columns, value: density[at] });
        }
        let greatest = density.iter().copied().fold(0., f64::max);
        if greatest == 0. {
            return Err(RasterError::Empty);
        }
        let density: Vec<f64> = density.iter().map(|v| v / greatest).collect();
        let [low, high] = domain.bounds();
        let size = [(high[0] - low[0]) / columns as f64, (high[1] - low[1]) / rows as f64];
        let mut ahead = Vec::with_capacity((columns + 1) * rows);
        for row in density.chunks_exact(columns) {
            let mut sum = [0.; 2];
            ahead.push(sum);
            for (column, value) in row.iter().enumerate() {
                sum[0] += value * size[0];
                sum[1] += value * size[0] * size[0] * (column as f64 + 0.5);
                ahead.push(sum);
            }
        }
        Ok(Self { columns, rows, size, low, torus: domain.is_torus(), density, ahead })
    }

    /// Returns the numbers of columns and rows.
    pub const fn shape(&self) -> (usize, usize) {
        (self.columns, self.rows)
    }

    /// Returns the densities in row order, divided by the largest density.
    pub fn values(&self) -> &[f64] {
        &self.density
    }

    /// Starts the integrals over a polygon around a site, to which edges are then added.
    pub(super) fn sums(&self, site: [f64; 2]) -> Sums<'_> {
        let origin = [site[0] - self.low[0], site[1] - self.low[1]];
        Sums { raster: self, origin, mass: 0., x: 0., y: 0. }
    }

    /// Returns ρ, ∫ρ dx and ∫ρ x dx at `x`, which lies in the cell (`column`, `row`) of the raster.
    ///
    /// The integrals begin at the left edge of the domain. On a torus, the cell may lie beyond the
    /// domain.
    #[inline]
    fn primitives(&self, column: isize, row: isize, x: f64) -> (f64, f64, f64) {
        let (columns, rows) = (self.columns as isize, self.rows as isize);
        let (turns, row) = if self.torus {
            (column.div_euclid(columns), row.rem_euclid(rows) as usize)
        } else {
            (0, row.clamp(0, rows - 1) as usize)
        };
        let column = (column - turns * columns).clamp(0, columns - 1) as usize;
        let width = self.columns as f64 * self.size[0];
        let shift = turns as f64 * width;
        let density = self.density[row * self.columns + column];
        let ahead = self.ahead[row * (self.columns + 1) + column];
        let left = column as f64 * self.size[0];
        let here = x - shift;
        let mass = ahead[0] + density * (here - left);
        let moment = ahead[1] + density * (here * here - left * left) / 2.;
        if turns == 0 {
            return (density, mass, moment);
        }
        // all earlier turns round the torus: Σ over t < turns of (moment of a turn + t · width ·
        // mass of a turn)
        let whole = self.ahead[row * (self.columns + 1) + self.columns];
        let t = turns as f64;
        let before = [t * whole[0], t * whole[1] + width * whole[0] * t * (t - 1.) / 2.];
        (density, before[0] + mass, before[1] + moment + shift * mass)
    }
}

/// Integrals over a polygon, summed along its outline; the coordinates of edges are relative to the
/// site.
pub(super) struct Sums<'a> {
    raster: &'a Raster,
    /// Position of the site relative to the corner of the domain's bounds with the smallest
    /// coordinates.
    origin: [f64; 2],
    mass: f64,
    x: f64,
    y: f64,
}

impl Sums<'_> {
    /// Adds an edge, with coordinates relative to the site, and returns the integral of the density
    /// along it.
    pub(super) fn edge(&mut self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let (a, b) = (self.absolute(from), self.absolute(to));
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        let mut along = 0.;
        let mut t = 0.;
        // every pass ends at the next line of the raster; the bound on passes stops a loop that
        // rounding keeps from advancing
        let lines = |axis: usize, d: f64| (d.abs() / self.raster.size[axis]).ceil() as usize + 2;
        for _ in 0..lines(0, dx) + lines(1, dy) {
            let place = [a[0] + t * dx, a[1] + t * dy];
            let next = self.next_line(0, place[0], a[0], dx).min(self.next_line(1, place[1], a[1], dy));
            let end = if next > t { next.min(1.) } else { 1. };
            along += self.piece(place, [a[0] + end * dx, a[1] + end * dy]) * (end - t) * length;
            t = end;
            if t >= 1. {
                break;
            }
        }
        along
    }

    /// Converts a point relative to the site to one relative to that corner.
    fn absolute(&self, p: [f64; 2]) -> [f64; 2] {
        [self.origin[0] + p[0], self.origin[1] + p[1]]
    }

    /// Returns the fraction of the edge at which the edge meets the next line of the raster across
    /// `axis`.
    fn next_line(&self, axis: usize, at: f64, start: f64, d: f64) -> f64 {
        if d == 0. {
            return f64::INFINITY;
        }
        let size = self.raster.size[axis];
        let line = at / size;
        // the margin skips a line that rounding has put just behind
        let slack = 1e-9;
        let next = if d > 0. { (line + slack).floor() + 1. } else { (line - slack).ceil() - 1. };
        (next * size - start) / d
    }

    /// Adds a piece of an edge that lies within one cell of the raster, and returns the density
    /// there.
    fn piece(&mut self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let raster = self.raster;
        let middle = [(from[0] + to[0]) / 2., (from[1] + to[1]) / 2.];
        let cell = |axis: usize| (middle[axis] / raster.size[axis]).floor() as isize;
        let (column, row) = (cell(0), cell(1));
        let (density, f1, g1) = raster.primitives(column, row, middle[0]);
        let dy = to[1] - from[1];
        if dy != 0. {
            let (_, f0, g0) = raster.primitives(column, row, from[0]);
            let (_, f2, g2) = raster.primitives(column, row, to[0]);
            let [x, y] = self.origin;
            // F is linear along the piece, x F and y F quadratic: Simpson's rule is exact
            self.mass += f1 * dy;
            self.x += dy / 6. * ((g0 - x * f0) + 4. * (g1 - x * f1) + (g2 - x * f2));
            self.y += dy / 6. * ((from[1] - y) * f0 + 4. * (middle[1] - y) * f1 + (to[1] - y) * f2);
        }
        density
    }

    /// Returns the mass and the centre of mass relative to the site, or `None` if there is no mass.
    pub(super) fn mass_and_centroid(&self) -> Option<(f64, [f64; 2])> {
        (self.mass > 0.).then(|| (self.mass, [self.x / self.mass, self.y / self.mass]))
    }
}
