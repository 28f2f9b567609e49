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
    about: "One row per file: landmarks of its density map. Only local windows that lie inside the \
        window of the mosaic count.",
    columns: &[
        column("file", "text", "Path of the file, as given.").of(|r| r.file.as_str().into()),
        column("unit", "text", "Unit of the coordinates (px, um or unit), called “unit” in the rows below.")
            .of(|r| r.unit.symbol().into()),
        column(
            "um_per_unit",
            "µm",
            "Scale in micrometres of retina per unit of the coordinates; empty if unknown.",
        )
        .of(|r| r.um_per_unit.into()),
        column(
            "local_window",
            "text",
            "Local window around each cone: the number of bound cells that it holds, or its side.",
        )
        .of(|r| r.window.as_str().into()),
        column("n", "count", "Number of cones.").of(|r| r.n.into()),
        column(
            "n_whole",
            "count",
            "Number of cones whose local window lies inside the window of the mosaic; the map is \
                made of these.",
        )
        .edge(Bound)
        .of(|r| r.whole.into()),
        column("pcd", "1/unit²", "Peak cone density: largest value of the density map.")
            .edge(Bound)
            .of(|r| r.peak.into()),
        column("pcd_per_mm2", "1/mm²", "pcd in cones/mm²; empty without a scale.")
            .edge(Bound)
            .of(|r| r.per_mm2(r.peak).into()),
        column("pcd_x", "unit", "x coordinate of the peak.")
            .edge(Bound)
            .of(|r| r.peak_at.map(|p| p.x).into()),
        column("pcd_y", "unit", "y coordinate of the peak.")
            .edge(Bound)
            .of(|r| r.peak_at.map(|p| p.y).into()),
        column(
            "cdc_x",
            "unit",
            "x coordinate of the cone density centroid: the centroid, weighted by density, of the \
                region whose density is at least isodensity_share of the peak.",
        )
        .edge(Bound)
        .source("Reiniger et al. 2021")
        .of(|r| r.centroid.map(|p| p.x).into()),
        column("cdc_y", "unit", "y coordinate of the cone density centroid.")
            .edge(Bound)
            .source("Reiniger et al. 2021")
            .of(|r| r.centroid.map(|p| p.y).into()),
        column("cdc_density", "1/unit²", "Value of the density map at the cone density centroid.")
            .edge(Bound)
            .of(|r| r.centroid_density.into()),
        column("cdc_density_per_mm2", "1/mm²", "cdc_density in cones/mm²; empty without a scale.")
            .edge(Bound)
            .of(|r| r.per_mm2(r.centroid_density).into()),
        column(
            "isodensity_share",
            "0–1",
            "Share of the peak density that bounds the region of the centroid.",
        )
        .of(|r| r.isodensity.into()),
        column(
            "isodensity_area",
            "unit²",
            "Area of the region whose density is at least isodensity_share of the peak.",
        )
        .edge(Bound)
        .of(|r| r.isodensity_area.into()),
        column("isodensity_area_mm2", "mm²", "isodensity_area in mm²; empty without a scale.")
            .edge(Bound)
            .of(|r| r.isodensity_area_mm2().into()),
        column(
            "ellipse_x",
            "unit",
            "x coordinate of the centre of the ellipse that is fitted to the contour of the \
                region.",
        )
        .edge(Bound)
        .of(|r| r.ellipse.map(|e| e.centre.x).into()),
        column("ellipse_y", "unit", "y coordinate of the centre of the fitted ellipse.")
            .edge(Bound)
            .of(|r| r.ellipse.map(|e| e.centre.y).into()),
        column("ellipse_semi_major", "unit", "Longer semi-axis of the fitted ellipse.")
            .edge(Bound)
            .of(|r| r.ellipse.map(|e| e.semi_major).into()),
        column("ellipse_semi_minor", "unit", "Shorter semi-axis of the fitted ellipse.")
            .edge(Bound)
            .of(|r| r.ellipse.map(|e| e.semi_minor).into()),
        column(
            "ellipse_degrees",
            "degrees",
            "Direction of the longer semi-axis of the fitted ellipse, 0–180° from +x towards +y \
                (downwards in the image).",
        )
        .edge(Bound)
        .of(|r| r.ellipse.map(|e| e.degrees).into()),
        column(
            "note",
            "text",
            "Reason why there is no map or no region, or a note that the edge of the map cuts the \
                region off.",
        )
        .of(|r| r.note.as_str().into()),
    ],
};
