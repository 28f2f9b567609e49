use super::EdgeRule::Bound;
use super::{Row, Table, column};
use crate::report::LandmarkRecord;

impl Row for LandmarkRecord {
    type Of<'a> = &'a Self;
}

/// Landmarks of density maps.
pub static LANDMARKS: Table<LandmarkRecord> = Table {
    file: "landmarks.csv",
    commands: "measure --maps, run --maps",
    about: "One row per file: what its density map says. Only windows that lie in the mosaic count.",
    columns: &[
        column("file", "text", "The file, as given.").of(|r| r.file.as_str().into()),
        column("unit", "text", "Unit of the coordinates (px, um, unit): “unit” below.")
            .of(|r| r.unit.symbol().into()),
        column("um_per_unit", "µm", "Micrometres of retina per unit; empty if not known.")
            .of(|r| r.um_per_unit.into()),
        column("local_window", "text", "The window around each cone: so many bound cells, or its side.")
            .of(|r| r.window.as_str().into()),
        column("n", "count", "Cones.").of(|r| r.n.into()),
        column("n_whole", "count", "Cones whose window lies in the mosaic: the map is made of these.")
            .edge(Bound)
            .of(|r| r.whole.into()),
        column("pcd", "1/unit²", "Peak cone density: the greatest value of the map.")
            .edge(Bound)
            .of(|r| r.peak.into()),
        column("pcd_per_mm2", "1/mm²", "pcd in cones/mm²; empty without a scale.")
            .edge(Bound)
            .of(|r| r.per_mm2(r.peak).into()),
        column("pcd_x", "unit", "x of the peak.").edge(Bound).of(|r| r.peak_at.map(|p| p.x).into()),
        column("pcd_y", "unit", "y of the peak.").edge(Bound).of(|r| r.peak_at.map(|p| p.y).into()),
        column(
            "cdc_x",
            "unit",
            "x of the cone density centroid: of the region of at least isodensity_share of the \
                peak, weighted by density.",
        )
        .edge(Bound)
        .source("Reiniger et al. 2021")
        .of(|r| r.centroid.map(|p| p.x).into()),
        column("cdc_y", "unit", "y of the cone density centroid.")
            .edge(Bound)
            .source("Reiniger et al. 2021")
            .of(|r| r.centroid.map(|p| p.y).into()),
        column("cdc_density", "1/unit²", "The map at the cone density centroid.")
            .edge(Bound)
            .of(|r| r.centroid_density.into()),
        column("cdc_density_per_mm2", "1/mm²", "cdc_density in cones/mm²; empty without a scale.")
            .edge(Bound)
            .of(|r| r.per_mm2(r.centroid_density).into()),
        column("isodensity_share", "0–1", "Share of the peak that bounds the region.")
            .of(|r| r.isodensity.into()),
        column("isodensity_area", "unit²", "Area of the region.")
            .edge(Bound)
            .of(|r| r.isodensity_area.into()),
        column("isodensity_area_mm2", "mm²", "isodensity_area in mm²; empty without a scale.")
            .edge(Bound)
            .of(|r| r.isodensity_area_mm2().into()),
        column("ellipse_x", "unit", "x of the centre of the ellipse fitted to the contour of the region.")
            .edge(Bound)
            .of(|r| r.ellipse.map(|e| e.centre.x).into()),
        column("ellipse_y", "unit", "y of the centre of that ellipse.")
            .edge(Bound)
            .of(|r| r.ellipse.map(|e| e.centre.y).into()),
        column("ellipse_semi_major", "unit", "Longer half axis of that ellipse.")
            .edge(Bound)
            .of(|r| r.ellipse.map(|e| e.semi_major).into()),
        column("ellipse_semi_minor", "unit", "Shorter half axis of that ellipse.")
            .edge(Bound)
            .of(|r| r.ellipse.map(|e| e.semi_minor).into()),
        column(
            "ellipse_degrees",
            "degrees",
            "Direction of the longer axis, 0–180° from +x towards +y (down in a picture).",
        )
        .edge(Bound)
        .of(|r| r.ellipse.map(|e| e.degrees).into()),
        column(
            "note",
            "text",
            "Reason why there is no map or region, or that the region is cut by the edge of the map.",
        )
        .of(|r| r.note.as_str().into()),
    ],
};
