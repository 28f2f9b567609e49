use super::StatsError;
use serde::{Deserialize, Serialize};

/// Square around a cone in which local values are taken.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LocalWindow {
    /// Square that grows until it holds this many bound cells, 3 to 100 000.
    Cells(usize),
    /// Square with this side, in the unit of the coordinates.
    Side(f64),
}

/// Options of maps and of the landmarks read from them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MapOptions {
    /// Window around each cone; default: 100 bound cells.
    pub window: LocalWindow,
    /// Density of the contour whose inside is averaged, as a share of the peak: 0.01 to 0.99,
    /// default 0.8.
    pub isodensity: f64,
    /// Distance between rows of the profiles, in the unit of the coordinates; `None` gives two
    /// hexagonal spacings.
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
    /// Returns [`StatsError::Option`] for the first field that is not, with its range.
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
