use super::EdgeRule::{All, Bound};
use super::{Part, Row, Table, column};
use crate::geometry::Point;
use crate::mosaic::Mosaic;
use crate::report::ReportError;
use crate::stats::{Cell as VoronoiCell, Measures};

/// A cone that the detector found.
#[derive(Clone, Copy, Debug)]
pub struct DetectedCone {
    /// Centre of the cone, px.
    pub centre: Point,
    /// Probability that a person would mark it.
    pub score: f64,
    /// Micrometres per pixel, if known.
    pub um_per_px: Option<f64>,
}

impl Row for DetectedCone {
    type Of<'a> = Self;
}

/// The table of detected cones.
///
/// These files are written as coordinates, by [`write_points`](crate::mosaic::io::write_points); a
/// test checks that the function writes these columns.
pub static DETECTIONS: Table<DetectedCone> = Table {
    file: "points.csv",
    commands: "run (images/NAME/points.csv), detect (NAME.csv; NAME.rejected.csv: candidates that \
        were rejected)",
    about: "One row per cone, in falling order of the score.",
    columns: &[
        column("x_px", "px", "Distance to the right of the centre of the top-left pixel.")
            .of(|d| d.centre.x.into()),
        column("y_px", "px", "Distance below the centre of the top-left pixel.").of(|d| d.centre.y.into()),
        column(
            "score",
            "0–1",
            "Probability that a person would mark the cone (cross-validated calibration).",
        )
        .of(|d| d.score.into()),
        column("x_um", "µm", "x_px in µm of retina; the column is missing without a scale.")
            .only(Part::Scaled)
            .of(|d| d.um_per_px.map(|um| d.centre.x * um).into()),
        column("y_um", "µm", "y_px in µm of retina; the column is missing without a scale.")
            .only(Part::Scaled)
            .of(|d| d.um_per_px.map(|um| d.centre.y * um).into()),
    ],
};

/// One point of a mosaic, by its index.
#[derive(Clone, Copy, Debug)]
pub struct PointRow<'a> {
    index: usize,
    point: Point,
    cell: VoronoiCell,
    measures: &'a Measures,
}

impl Row for PointRow<'static> {
    type Of<'a> = PointRow<'a>;
}

impl PointRow<'_> {
    /// Returns the value of this point in a series.
    fn of<T: Copy>(&self, series: &[T]) -> Option<T> {
        series.get(self.index).copied()
    }
}

/// The table of the neighbours and the Voronoi cell of every point of a mosaic.
pub static POINTS: Table<PointRow> = Table {
    file: "NAME.points.csv",
    commands: "measure --functions",
    about: "One row per point in the window, in the order of the file. A cell is empty where the \
            value is not defined: without a neighbour, for an infinite Voronoi cell, or for a point \
            that coincides with an earlier one.",
    columns: &[
        column("x", "unit", "x of the point.").of(|p| p.point.x.into()),
        column("y", "unit", "y of the point.").of(|p| p.point.y.into()),
        column("nndist", "unit", "Distance to the nearest neighbour.")
            .edge(All)
            .of(|p| p.of(&p.measures.neighbours.distances).into()),
        column("nnwhich", "row", "Row of the nearest neighbour, counted from 1.")
            .edge(All)
            .of(|p| p.of(&p.measures.neighbours.indices).map(|j| j + 1).into()),
        column(
            "bdist",
            "unit",
            "Distance to the border of the window; empty on a torus, which has \
                                 no border.",
        )
        .of(|p| p.of(&p.measures.borders).into()),
        column("dirichlet_area", "unit²", "Area of the Voronoi cell within the window.")
            .of(|p| p.cell.clipped_area.into()),
        column("cell_area", "unit²", "Area of the whole Voronoi cell; empty where it is infinite.")
            .edge(All)
            .of(|p| p.cell.area.into()),
        column("sides", "count", "Number of sides of the Voronoi cell.")
            .edge(All)
            .of(|p| p.cell.sides.into()),
        column(
            "bound",
            "0 or 1",
            "1 if the Voronoi cell is finite and has every vertex strictly \
                                   inside the window.",
        )
        .source("Cooper et al. 2016")
        .of(|p| usize::from(p.cell.bound).into()),
        column("icd", "unit", "Inter-cell distance: mean distance to the Delaunay neighbours.")
            .edge(All)
            .of(|p| p.cell.inter_cell.into()),
        column("furthest", "unit", "Distance to the furthest Delaunay neighbour.")
            .edge(All)
            .of(|p| p.cell.furthest.into()),
        column(
            "psi6",
            "0–1",
            "Modulus of ψ6, the mean of exp(6iθ) over the Delaunay neighbours: 1 in a triangular lattice.",
        )
        .edge(All)
        .of(|p| p.cell.psi6.map(|[re, im]| re.hypot(im)).into()),
        column(
            "nn_direction_deg",
            "degrees",
            "Direction of the axis to the nearest neighbour, 0–180°, counter-clockwise from the \
             right as seen in the picture.",
        )
        .edge(All)
        .of(|p| p.of(&p.measures.orientation.nearest.degrees).flatten().into()),
        column(
            "hexagon_direction_deg",
            "degrees",
            "Direction of the hexagon of neighbours, 0–60°, counter-clockwise likewise: phase of ψ6 over 6.",
        )
        .edge(Bound)
        .of(|p| p.of(&p.measures.orientation.hexagons).flatten().into()),
    ],
};

/// Returns `NAME.points.csv` of a mosaic.
///
/// # Errors
/// Fails if the table cannot be written as CSV.
pub fn points_csv(mosaic: &Mosaic, measures: &Measures) -> Result<Vec<u8>, ReportError> {
    let cells = mosaic.points().iter().zip(&measures.cells.cells).enumerate();
    POINTS.csv(cells.map(|(index, (&point, &cell))| PointRow { index, point, cell, measures }))
}
