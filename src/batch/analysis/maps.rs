use crate::batch::output::OutputFolder;
use crate::batch::{BatchError, Length};
use crate::detect::{FourierEstimate, FourierMapOptions, fourier_map};
use crate::geometry::Point;
use crate::image::Plane;
use crate::mosaic::{Mosaic, Scale};
use crate::report::{Cell, LandmarkRecord, maps_figure, tables};
use crate::stats::{LocalWindow, MapOptions, Maps};
use serde::Serialize;
use std::path::Path;

/// What [`write`] writes, after the name of the mosaic.
const FILES: [&str; 3] = ["maps.csv", "maps.svg", "profiles.csv"];
/// What [`write_fourier`] writes.
const FOURIER: &str = "fourier_map.csv";
/// What the folder of an image holds of its maps.
pub(super) const OF_IMAGE: [&str; 4] = [FILES[0], FILES[1], FILES[2], FOURIER];
/// What was read off the maps, one row a file.
const LANDMARKS: &str = "landmarks.csv";

/// The window around each cone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum MapWindow {
    /// Grown until it holds this many bound cells; see [`LocalWindow::Cells`].
    Cells(usize),
    /// Of this side.
    Side(Length),
}

/// Maps of every mosaic of a batch; see [`MapOptions`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MapRequest {
    /// The window around each cone.
    pub window: MapWindow,
    /// Density of the contour whose inside is averaged, as a share of the peak, 0.01 to 0.99.
    pub isodensity: f64,
    /// Distance between rows of the profiles; `None`: two hexagonal spacings.
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
    /// Whether every field is in its range.
    ///
    /// # Errors
    /// The first field that is not, with its range.
    pub fn validate(&self) -> Result<(), BatchError> {
        let window = match self.window {
            MapWindow::Cells(n) => LocalWindow::Cells(n),
            // a length is positive
            MapWindow::Side(_) => LocalWindow::Side(1.),
        };
        Ok(MapOptions { window, isodensity: self.isodensity, profile_step: None }.validate()?)
    }

    /// Returns the options for one mosaic, lengths in its unit.
    ///
    /// # Errors
    /// If a length is in µm and no scale is known.
    pub(super) fn of(&self, mosaic: &Mosaic, file: &Path) -> Result<MapOptions, BatchError> {
        let window = match self.window {
            MapWindow::Cells(n) => LocalWindow::Cells(n),
            MapWindow::Side(side) => LocalWindow::Side(side.of("the side of the maps' windows", mosaic, file)?),
        };
        let step = self.profile_step.map(|step| step.of("the step of the profiles", mosaic, file)).transpose()?;
        Ok(MapOptions { window, isodensity: self.isodensity, profile_step: step })
    }
}

/// Writes the maps of one mosaic: `maps.csv` (one row per cone), `maps.svg` and `profiles.csv`,
/// each with `prefix` before it.
pub(super) fn write(
    folder: &OutputFolder,
    prefix: &str,
    title: &str,
    mosaic: &Mosaic,
    found: &Maps,
) -> Result<(), BatchError> {
    let [table, figure, profiles] = FILES.map(|name| format!("{prefix}{name}"));
    let (header, rows) = map_table(mosaic, found);
    folder.write_table(&table, &header, &rows)?;
    folder.write(&figure, maps_figure(title, mosaic, found)?.as_bytes())?;
    let (header, rows) = profile_table(mosaic, found);
    folder.write_table(&profiles, &header, &rows)
}

/// Writes `landmarks.csv`.
pub(in crate::batch) fn write_landmarks<'a>(
    out: &OutputFolder,
    records: impl IntoIterator<Item = &'a LandmarkRecord>,
) -> Result<(), BatchError> {
    let rows: Vec<_> = records.into_iter().map(LandmarkRecord::row).collect();
    out.write_table(LANDMARKS, &LandmarkRecord::header(), &rows)
}

/// Lengths in the unit of the coordinates where the column does not say otherwise. What is not defined is empty.
fn map_table(mosaic: &Mosaic, maps: &Maps) -> (Vec<String>, Vec<Vec<Cell>>) {
    let um = mosaic.micrometres_per_unit();
    let row = |(p, v): (&crate::geometry::Point, &crate::stats::LocalValues)| -> Vec<Cell> {
        vec![
            p.x.into(),
            p.y.into(),
            v.side.into(),
            v.bound.into(),
            v.flag.name().into(),
            v.density.into(),
            v.inter_cell.into(),
            v.nearest.into(),
            v.nearest_ri.into(),
            v.psi6.into(),
            v.six_sided_percent.into(),
            per_mm2(v.density, um),
            v.inter_cell.zip(um).map(|(d, um)| d * um).into(),
            v.nearest.zip(um).map(|(d, um)| d * um).into(),
        ]
    };
    let rows = mosaic.points().iter().zip(&maps.local).map(row).collect();
    (tables::MAPS.header(), rows)
}

fn profile_table(mosaic: &Mosaic, maps: &Maps) -> (Vec<String>, Vec<Vec<Cell>>) {
    let um = mosaic.micrometres_per_unit();
    let row = |p: &crate::stats::ProfileRow| -> Vec<Cell> {
        vec![
            p.along.name().into(),
            p.r.into(),
            p.bound.into(),
            p.share.into(),
            p.density.into(),
            p.spacing.into(),
            p.inter_cell.into(),
            p.nearest.into(),
            um.map(|um| p.r * um).into(),
            per_mm2(p.density, um),
            p.spacing.zip(um).map(|(s, um)| s * um).into(),
        ]
    };
    (tables::PROFILES.header(), maps.profile.iter().map(row).collect())
}

fn per_mm2(density: Option<f64>, um: Option<f64>) -> Cell {
    density.zip(um).map(|(d, um)| d * 1e6 / (um * um)).into()
}

/// Spacing by the spectra of overlapping tiles of the image; no rows where its spectrum has no ring.
pub(super) fn write_fourier(
    folder: &OutputFolder,
    image: &Plane,
    whole: Option<&FourierEstimate>,
    scale: Option<Scale>,
) -> Result<(), BatchError> {
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    if let Some(Ok(map)) = whole.map(|whole| fourier_map(image, whole, &FourierMapOptions::default())) {
        for &y in &map.y {
            for &x in &map.x {
                let middle = Point::new(x, y);
                let spacing = map.spacing.at(middle);
                let um = scale.map(|s| spacing * s.micrometres_per_pixel());
                rows.push(vec![
                    x.into(),
                    y.into(),
                    spacing.into(),
                    um.into(),
                    map.confidence_at(middle).into(),
                ]);
            }
        }
    }
    folder.write_table(FOURIER, &tables::FOURIER_MAP.header(), &rows)
}
