use super::significant;
use crate::geometry::Point;
use crate::mosaic::{LengthUnit, Mosaic};
use crate::stats::{Ellipse, LocalWindow, Maps};
use serde::{Deserialize, Serialize};

/// The landmarks of the density map of one mosaic: a row of `landmarks.csv`.
///
/// Lengths are in the unit of the mosaic.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LandmarkRecord {
    /// Path of the file, as set by the user.
    pub file: String,
    /// Unit of all lengths in this record whose name ends in no unit.
    pub unit: LengthUnit,
    /// Micrometres per unit, if known.
    pub um_per_unit: Option<f64>,
    /// Size of the window around each cone: “100 cells”, or the length of its side.
    pub window: String,
    /// Number of cones in the mosaic.
    pub n: usize,
    /// Number of cones whose window lies inside the window of the mosaic; the landmarks are taken
    /// from these cones.
    pub whole: usize,
    /// Peak cone density, per squared unit.
    pub peak: Option<f64>,
    /// Position of the peak density.
    pub peak_at: Option<Point>,
    /// Cone density centroid: the density-weighted centroid of the region in which the density is
    /// at least `isodensity` × `peak`.
    pub centroid: Option<Point>,
    /// Value of the density map at the centroid, per squared unit.
    pub centroid_density: Option<f64>,
    /// Share of the peak density that bounds the region, 0–1.
    pub isodensity: f64,
    /// Area of the region, in squared units.
    pub isodensity_area: Option<f64>,
    /// Ellipse fitted to the contour of the region.
    pub ellipse: Option<Ellipse>,
    /// Remark on why landmarks are missing or distorted; empty if they are neither.
    pub note: String,
}

impl LandmarkRecord {
    /// Records the landmarks that the maps of a mosaic show.
    pub fn new(file: &str, mosaic: &Mosaic, maps: &Maps) -> Self {
        let found = &maps.landmarks;
        let (window, few) = match maps.options.window {
            LocalWindow::Cells(n) => (format!("{n} cells"), "ask for fewer cells per window"),
            LocalWindow::Side(side) => (side.to_string(), "choose another side of the windows"),
        };
        let note = match (found.peak, found.cut) {
            (None, _) => {
                format!("no map: no window of {window} with bound cells lies wholly in the mosaic; {few}")
            }
            (Some(_), true) => format!(
                "the region above {} % of the peak is cut off by the edge of the map, so that its area is too small and \
                 its centroid lies too far inwards",
                100. * maps.options.isodensity
            ),
            (Some(_), false) if found.centroid.is_none() => {
                format!(
                    "no region: no three neighbouring cones have windows of {window} that lie wholly in the mosaic; {few}"
                )
            }
            (Some(_), false) => String::new(),
        };
        Self {
            file: file.to_owned(),
            unit: mosaic.unit(),
            um_per_unit: mosaic.micrometres_per_unit(),
            window,
            n: mosaic.len(),
            whole: found.whole,
            peak: found.peak,
            peak_at: found.peak_at,
            centroid: found.centroid,
            centroid_density: found.centroid_density,
            isodensity: maps.options.isodensity,
            isodensity_area: found.isodensity_area,
            ellipse: found.ellipse,
            note,
        }
    }

    /// Returns a density per squared unit in cones/mm², if the scale is known.
    pub(super) fn per_mm2(&self, density: Option<f64>) -> Option<f64> {
        density.zip(self.um_per_unit).map(|(d, um)| d * 1e6 / (um * um))
    }

    /// Returns the area of the region in mm², if the scale is known.
    pub(super) fn isodensity_area_mm2(&self) -> Option<f64> {
        self.isodensity_area.zip(self.um_per_unit).map(|(area, um)| area * um * um / 1e6)
    }

    /// Returns peak, centroid and note as sentences.
    pub fn words(&self) -> String {
        let number = |v: f64| significant(v, 4);
        let density = |d: f64| match self.per_mm2(Some(d)) {
            Some(d) => format!("{} cones/mm²", number(d)),
            None => format!("{} cones/{}²", number(d), self.unit.symbol()),
        };
        let place = |p: Point| format!("({}, {}) {}", number(p.x), number(p.y), self.unit.symbol());
        let peak = self
            .peak
            .zip(self.peak_at)
            .map(|(d, at)| format!("Peak density {} at {}.", density(d), place(at)));
        let centroid = self.centroid.zip(self.centroid_density).map(|(at, d)| {
            format!(
                "Density at the centroid of the region above {} % of the peak: {} at {}.",
                100. * self.isodensity,
                density(d),
                place(at)
            )
        });
        let note = (!self.note.is_empty()).then(|| format!("Note: {}.", self.note));
        [peak, centroid, note].into_iter().flatten().collect::<Vec<_>>().join(" ")
    }
}
