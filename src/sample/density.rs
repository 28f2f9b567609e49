use crate::geometry::power::{Domain, Raster, RasterError};
use crate::geometry::{Point, Polygon};
use std::sync::Arc;

/// Lower limit of the density, as a fraction of its largest value; smaller values are raised to it.
///
/// A region of density 0 would separate the cells on its two sides.
const LEAST: f64 = 1e-3;

/// Relative density of points over the bounds of a window.
///
/// The density is a raster, constant within each cell; the first cell is the upper left one. Values
/// below 1/1000 of the largest value are raised to that limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Density {
    columns: usize,
    rows: usize,
    /// Densities row by row, divided by the largest one.
    values: Arc<[f64]>,
}

impl Density {
    /// Creates a density from values row by row, in any unit.
    ///
    /// # Errors
    /// Fails if the number of values is not `columns` × `rows`, a value is negative or not finite,
    /// or all values are 0.
    pub fn new(columns: usize, rows: usize, values: &[f64]) -> Result<Self, RasterError> {
        let greatest = values.iter().copied().fold(0., f64::max);
        // the values are checked on a unit square here, so that `over` cannot fail for them later
        Raster::new(&Domain::rectangle(1., 1.), columns, rows, values.to_vec())?;
        let values = values.iter().map(|v| (v / greatest).max(LEAST)).collect();
        Ok(Self { columns, rows, values })
    }

    /// Creates a density from a function of (x, y), evaluated at the centres of the cells of a
    /// raster of `columns` × `rows` cells.
    ///
    /// x and y run from 0 to 1 across the bounds of the window.
    ///
    /// # Errors
    /// Fails if [`Density::new`] fails.
    pub fn from_fn(columns: usize, rows: usize, f: impl Fn(f64, f64) -> f64) -> Result<Self, RasterError> {
        let middle = |i: usize, count: usize| (i as f64 + 0.5) / count as f64;
        let values: Vec<f64> = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (column, row)))
            .map(|(column, row)| f(middle(column, columns), middle(row, rows)))
            .collect();
        Self::new(columns, rows, &values)
    }

    /// Returns the density as a raster over `domain`.
    pub(super) fn over(&self, domain: &Domain) -> Option<Raster> {
        Raster::new(domain, self.columns, self.rows, self.values.to_vec()).ok()
    }

    /// Returns the fraction of the density's mass that lies inside a polygon.
    ///
    /// The density is spread over the polygon's bounds, and a cell counts as inside if its centre
    /// lies inside. The result is at least 1 divided by the number of cells, so that it is never 0
    /// and can be divided by.
    pub(super) fn share(&self, polygon: &Polygon) -> f64 {
        let b = polygon.bounds();
        let middle = |i: usize, count: usize, side: f64| (i as f64 + 0.5) / count as f64 * side;
        let within = |at: usize| {
            let x = b.x0() + middle(at % self.columns, self.columns, b.width());
            let y = b.y0() + middle(at / self.columns, self.rows, b.height());
            polygon.contains(Point::new(x, y))
        };
        let inside: f64 = (0..self.values.len()).filter(|&at| within(at)).map(|at| self.values[at]).sum();
        (inside / self.values.iter().sum::<f64>()).max(1. / self.values.len() as f64)
    }
}
