use crate::batch::output::{OutputFolder, write_figure};
use crate::batch::{BatchError, Length};
use crate::detect::{FourierEstimate, FourierMapOptions, fourier_map};
use crate::image::Plane;
use crate::mosaic::{Mosaic, Scale};
use crate::report::{FigureFormat, LandmarkRecord, maps_figure, tables};
use crate::stats::{LocalWindow, MapOptions, Maps};
use serde::Serialize;
use std::path::Path;

/// Rule for the size of the square around each cone in which local values of a map are computed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum MapWindow {
    /// The square grows until it contains this number of bound cells (Voronoi cells strictly inside
    /// the window of the mosaic); see [`LocalWindow::Cells`].
    Cells(usize),
    /// The square has a side of this length.
    Side(Length),
}

/// Options of maps, the same for every mosaic of a batch; see [`MapOptions`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MapRequest {
    /// Rule for the size of the square around each cone in which local values are computed.
    pub window: MapWindow,
    /// Density of the isodensity contour, as a fraction of the peak density, 0.01 to 0.99. The
    /// region inside the contour gives the isodensity area and the cone density centroid.
    pub isodensity: f64,
    /// Distance between neighbouring rows of the profiles. `None` for the default, two [hexagonal
    /// spacings](crate::mosaic::hexagonal_spacing).
    pub profile_step: Option<Length>,
}

impl Default for MapRequest {
    fn default() -> Self {
        let MapOptions { window, isodensity, .. } = MapOptions::default();
        let cells = match window {
            LocalWindow::Cells(n) => n,
            LocalWindow::Side(_) => 100,
        };
        Self { window: MapWindow::Cells(cells), isodensity, profile_step: None }
    }
}

impl MapRequest {
    /// Checks that every field is in its range.
    ///
    /// # Errors
    /// Fails if a field is out of its range. The error names the first such field and its range.
    pub fn validate(&self) -> Result<(), BatchError> {
        let window = match self.window {
            MapWindow::Cells(n) => LocalWindow::Cells(n),
            // a `Length` is always positive and so always valid: any positive side will do here
            MapWindow::Side(_) => LocalWindow::Side(1.),
        };
        Ok(MapOptions { window, isodensity: self.isodensity, profile_step: None }.validate()?)
    }

    /// Returns the options for one mosaic, with lengths in the unit of its coordinates.
    ///
    /// # Errors
    /// Fails if a length is in µm and no scale is known.
    pub(super) fn of(&self, mosaic: &Mosaic, file: &Path) -> Result<MapOptions, BatchError> {
        let window = match self.window {
            MapWindow::Cells(n) => LocalWindow::Cells(n),
            MapWindow::Side(side) => {
                LocalWindow::Side(side.of("the side of the maps' windows", mosaic, file)?)
            }
        };
        let step =
            self.profile_step.map(|step| step.of("the step of the profiles", mosaic, file)).transpose()?;
        Ok(MapOptions { window, isodensity: self.isodensity, profile_step: step })
    }
}

/// Writes the maps of one mosaic: `maps.csv` (one row per cone), `maps.svg` and `profiles.csv`.
/// Each name begins with `prefix`.
pub(super) fn write(
    folder: &OutputFolder,
    prefix: &str,
    title: &str,
    (mosaic, found): (&Mosaic, &Maps),
    figures: &[FigureFormat],
) -> Result<(), BatchError> {
    let [table, figure, profiles] =
        ["maps.csv", "maps", "profiles.csv"].map(|name| format!("{prefix}{name}"));
    folder.write(&table, &tables::maps_csv(mosaic, found)?)?;
    write_figure(folder, &figure, &maps_figure(title, mosaic, found)?, figures)?;
    folder.write(&profiles, &tables::profiles_csv(mosaic, found)?)
}

/// Writes `landmarks.csv`, one row per mosaic.
pub(in crate::batch) fn write_landmarks<'a>(
    out: &OutputFolder,
    records: impl IntoIterator<Item = &'a LandmarkRecord>,
) -> Result<(), BatchError> {
    out.write(tables::LANDMARKS.file, &tables::LANDMARKS.csv(records)?)
}

/// Writes `fourier_map.csv`: the cone spacing in overlapping tiles of the image, estimated from the
/// spectrum of each tile.
///
/// `whole` is the estimate from the spectrum of the entire image; without it, the table has no
/// rows.
pub(super) fn write_fourier(
    folder: &OutputFolder,
    image: &Plane,
    whole: Option<&FourierEstimate>,
    scale: Option<Scale>,
) -> Result<(), BatchError> {
    let map = whole.and_then(|whole| fourier_map(image, whole, &FourierMapOptions::default()).ok());
    let um_per_px = scale.map(|s| s.micrometres_per_pixel());
    folder.write(tables::FOURIER_MAP.file, &tables::fourier_map_csv(map.as_ref(), um_per_px)?)
}
