use super::StatsError;
use serde::{Deserialize, Serialize};

/// Size of the square around a cone in which local values are taken.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LocalWindow {
    /// Square that grows until it contains this number of bound cells, 3 to 100 000.
    ///
    /// A bound cell is a Voronoi cell that lies strictly inside the window of the mosaic.
    Cells(usize),
    /// Square with this side, in the unit of the coordinates.
    Side(f64),
}

/// Options of maps and of the landmarks read from them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MapOptions {
    /// Size of the square around each cone in which local values are taken.
    ///
    /// The default square grows until it contains 100 bound cells, which are Voronoi cells strictly
    /// inside the window of the mosaic.
    pub window: LocalWindow,
    /// Lowest density of the isodensity region, as a share of the peak density: 0.01 to 0.99,
    /// default 0.8.
    ///
    /// The cone density centroid is the centroid of this region.
    pub isodensity: f64,
    /// Distance between successive rows of the profiles, in the unit of the coordinates.
    ///
    /// `None` gives twice the hexagonal spacing, which is the spacing of the triangular lattice
    /// that has the density of the mosaic.
    pub profile_step: Option<f64>,
}

impl Default for MapOptions {
    fn default() -> Self {
        Self { window: LocalWindow::Cells(100), isodensity: 0.8, profile_step: None }
    }
}

impl MapOptions {
    /// Checks that every field is in its range.
    ///
    /// # Errors
    /// Fails if a field is out of its range; the error names the first such field.
    pub fn validate(&self) -> Result<(), StatsError> {
        let check = |option, value: f64, ok: bool, range| {
            if ok { Ok(()) } else { Err(StatsError::Option { option, value, range }) }
        };
        let positive = |v: f64| v.is_finite() && v > 0.;
        match self.window {
            LocalWindow::Cells(n) => {
                let ok = (3..=100_000).contains(&n);
                check("number of cells of the local windows", n as f64, ok, "3 to 100000")?;
            }
            LocalWindow::Side(side) => {
                check("side of the local windows", side, positive(side), "a positive length")?;
            }
        }
        let share = self.isodensity;
        check("isodensity", share, (0.01..=0.99).contains(&share), "a share of 0.01 to 0.99")?;
        let step = self.profile_step.unwrap_or(1.);
        check("step of the profiles", step, positive(step), "a positive length")
    }
}
