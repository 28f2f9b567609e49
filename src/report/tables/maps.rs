use super::EdgeRule::Bound;
use super::{Row, Table, column};
use crate::detect::FourierMap;
use crate::geometry::Point;
use crate::mosaic::Mosaic;
use crate::report::ReportError;
use crate::stats::{LocalValues, Maps, ProfileRow};

/// A cone and the local values of the mosaic around it.
#[derive(Clone, Copy, Debug)]
pub struct MapRow {
    at: Point,
    local: LocalValues,
    um_per_unit: Option<f64>,
}

impl Row for MapRow {
    type Of<'a> = Self;
}

/// Returns a length in µm; `None` without a scale.
fn length(value: Option<f64>, um_per_unit: Option<f64>) -> Option<f64> {
    value.zip(um_per_unit).map(|(length, um)| length * um)
}

/// Returns a density per squared unit in cones/mm²; `None` without a scale.
fn per_mm2(density: Option<f64>, um_per_unit: Option<f64>) -> Option<f64> {
    density.zip(um_per_unit).map(|(d, um)| d * 1e6 / (um * um))
}

/// The table of local values of a mosaic.
pub static MAPS: Table<MapRow> = Table {
    file: "NAME.maps.csv",
    commands: "measure --maps, run --maps (images/NAME/maps.csv)",
    about: "One row per cone. Values are taken over the bound Voronoi cells that lie wholly in a \
            square window around the cone; they are empty if there are no such cells.",
    columns: &[
        column("x", "unit", "x of the cone.").of(|m| m.at.x.into()),
        column("y", "unit", "y of the cone.").of(|m| m.at.y.into()),
        column("side", "unit", "Side of the window.").of(|m| m.local.side.into()),
        column("bound", "count", "Number of bound cells in the window.")
            .edge(Bound)
            .of(|m| m.local.bound.into()),
        column(
            "flag",
            "text",
            "Empty, or “edge”: the window reaches beyond the mosaic, or “few”: the mosaic has fewer \
             bound cells than asked for.",
        )
        .of(|m| m.local.flag.name().into()),
        column("density", "1/unit²", "Number of these cells over their total area.")
            .edge(Bound)
            .of(|m| m.local.density.into()),
        column("icd", "unit", "Inter-cell distance: mean distance to the Delaunay neighbours.")
            .edge(Bound)
            .of(|m| m.local.inter_cell.into()),
        column("nnd", "unit", "Mean distance to the nearest neighbour.")
            .edge(Bound)
            .of(|m| m.local.nearest.into()),
        column(
            "ri",
            "ratio",
            "Regularity index of the nearest-neighbour distances: mean over \
                               standard deviation.",
        )
        .edge(Bound)
        .of(|m| m.local.nearest_ri.into()),
        column("psi6", "0–1", "Mean modulus of ψ6.").edge(Bound).of(|m| m.local.psi6.into()),
        column("six_sided_percent", "%", "Share of the cells that have six sides.")
            .edge(Bound)
            .of(|m| m.local.six_sided_percent.into()),
        column("density_per_mm2", "1/mm²", "density in cones/mm²; empty without a scale.")
            .edge(Bound)
            .of(|m| per_mm2(m.local.density, m.um_per_unit).into()),
        column("icd_um", "µm", "icd in µm; empty without a scale.")
            .edge(Bound)
            .of(|m| length(m.local.inter_cell, m.um_per_unit).into()),
        column("nnd_um", "µm", "nnd in µm; empty without a scale.")
            .edge(Bound)
            .of(|m| length(m.local.nearest, m.um_per_unit).into()),
    ],
};

/// Returns `NAME.maps.csv` of a mosaic.
///
/// # Errors
/// Fails if the table cannot be written as CSV.
pub fn maps_csv(mosaic: &Mosaic, maps: &Maps) -> Result<Vec<u8>, ReportError> {
    let um_per_unit = mosaic.micrometres_per_unit();
    let row = |(&at, &local)| MapRow { at, local, um_per_unit };
    MAPS.csv(mosaic.points().iter().zip(&maps.local).map(row))
}

/// One distance from the cone density centroid, in one direction or all around.
#[derive(Clone, Copy, Debug)]
pub struct DistanceRow {
    profile: ProfileRow,
    um_per_unit: Option<f64>,
}

impl Row for DistanceRow {
    type Of<'a> = Self;
}

/// The table of density and spacing by distance from the cone density centroid.
pub static PROFILES: Table<DistanceRow> = Table {
    file: "NAME.profiles.csv",
    commands: "measure --maps, run --maps (images/NAME/profiles.csv)",
    about: "One row per distance from the cone density centroid: first in rings (from the bound \
            cells whose cones lie in the ring), then along four meridians (from the maps).",
    columns: &[
        column("along", "text", "“ring”, or the meridian: “right”, “down”, “left”, “up”.")
            .of(|d| d.profile.along.name().into()),
        column("r", "unit", "Distance from the centroid; for a ring, of the middle of its width.")
            .of(|d| d.profile.r.into()),
        column("bound", "count", "Number of bound cells in the ring.")
            .edge(Bound)
            .of(|d| d.profile.bound.into()),
        column("share", "0–1", "Share of the circle through the middle of the ring that lies in the window.")
            .of(|d| d.profile.share.into()),
        column(
            "density",
            "1/unit²",
            "For a ring, number of its bound cells over their area; on a \
                                      meridian, value of the density map.",
        )
        .edge(Bound)
        .of(|d| d.profile.density.into()),
        column("spacing", "unit", "Hexagonal spacing of that density.")
            .edge(Bound)
            .of(|d| d.profile.spacing.into()),
        column("icd", "unit", "Inter-cell distance: mean distance to the Delaunay neighbours.")
            .edge(Bound)
            .of(|d| d.profile.inter_cell.into()),
        column("nnd", "unit", "Mean distance to the nearest neighbour.")
            .edge(Bound)
            .of(|d| d.profile.nearest.into()),
        column("r_um", "µm", "r in µm; empty without a scale.")
            .of(|d| length(Some(d.profile.r), d.um_per_unit).into()),
        column("density_per_mm2", "1/mm²", "density in cones/mm²; empty without a scale.")
            .edge(Bound)
            .of(|d| per_mm2(d.profile.density, d.um_per_unit).into()),
        column("spacing_um", "µm", "spacing in µm; empty without a scale.")
            .edge(Bound)
            .of(|d| length(d.profile.spacing, d.um_per_unit).into()),
    ],
};

/// Returns `NAME.profiles.csv` of a mosaic.
///
/// # Errors
/// Fails if the table cannot be written as CSV.
pub fn profiles_csv(mosaic: &Mosaic, maps: &Maps) -> Result<Vec<u8>, ReportError> {
    let um_per_unit = mosaic.micrometres_per_unit();
    PROFILES.csv(maps.profile.iter().map(|&profile| DistanceRow { profile, um_per_unit }))
}

/// Spacing at one position of the image, from the spectra of tiles.
#[derive(Clone, Copy, Debug)]
pub struct FourierRow {
    at: Point,
    spacing: f64,
    confidence: f64,
    um_per_px: Option<f64>,
}

impl Row for FourierRow {
    type Of<'a> = Self;
}

/// The table of spacings from the spectra of tiles.
pub static FOURIER_MAP: Table<FourierRow> = Table {
    file: "fourier_map.csv",
    commands: "run --maps (images/NAME/fourier_map.csv)",
    about: "One row per place in the image: spacing by the ring in the spectra of overlapping tiles \
            (after Cooper et al. 2019). There are no rows if the spectrum of the image has no ring.",
    columns: &[
        column("x_px", "px", "Distance of the place to the right of the centre of the top-left pixel.")
            .of(|f| f.at.x.into()),
        column("y_px", "px", "Distance of the place below the centre of the top-left pixel.")
            .of(|f| f.at.y.into()),
        column("spacing_px", "px", "Distance between neighbouring cones, by the radius of the ring.")
            .of(|f| f.spacing.into()),
        column("spacing_um", "µm", "spacing_px in µm; empty without a scale.")
            .of(|f| length(Some(f.spacing), f.um_per_px).into()),
        column("confidence", "0–1", "Share of the variance of the spectrum that the ring explains.")
            .of(|f| f.confidence.into()),
    ],
};

/// Returns `fourier_map.csv` of an image; there are no rows if its spectrum has no ring.
///
/// # Errors
/// Fails if the table cannot be written as CSV.
pub fn fourier_map_csv(map: Option<&FourierMap>, um_per_px: Option<f64>) -> Result<Vec<u8>, ReportError> {
    let rows = map.into_iter().flat_map(|map| {
        let places = map.y.iter().flat_map(|&y| map.x.iter().map(move |&x| Point::new(x, y)));
        places.map(move |at| FourierRow {
            at,
            spacing: map.spacing.at(at),
            confidence: map.confidence_at(at),
            um_per_px,
        })
    });
    FOURIER_MAP.csv(rows)
}
