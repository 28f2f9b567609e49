use super::{OutputTable, column};

/// Cones that the detector found.
pub static DETECTIONS: OutputTable = OutputTable {
    file: "points.csv",
    commands: "run (images/NAME/points.csv), detect (NAME.csv; NAME.rejected.csv: candidates that were rejected)",
    about: "A row a cone, the best score first.",
    columns: &[
        column("x_px", "px", "To the right from the centre of the first pixel."),
        column("y_px", "px", "Down from the centre of the first pixel."),
        column("score", "0–1", "Probability that a person would mark it (cross-validated calibration)."),
        column("x_um", "µm", "The same as x_px, on the retina; without a scale there is no such column."),
        column("y_um", "µm", "The same as y_px, on the retina; without a scale there is no such column."),
    ],
};

/// What every point of a mosaic is.
pub static POINTS: OutputTable = OutputTable {
    file: "NAME.points.csv",
    commands: "measure --functions",
    about: "A row a point of the window, in the order of the file. A cell is empty where it is not defined: no neighbour, an infinite \
            Voronoi cell, a point that coincides with an earlier one.",
    columns: &[
        column("x", "unit", "Its place."),
        column("y", "unit", "Its place."),
        column("nndist", "unit", "Distance to the nearest neighbour."),
        column("nnwhich", "row", "The nearest neighbour, rows counted from 1."),
        column("bdist", "unit", "Distance to the border of the window; infinite on a torus."),
        column("dirichlet_area", "unit²", "Area of the Voronoi cell within the window."),
        column("cell_area", "unit²", "Area of the whole Voronoi cell; empty where it is infinite."),
        column("sides", "count", "Sides of the Voronoi cell."),
        column(
            "bound",
            "0 or 1",
            "Whether the cell is finite with every vertex strictly inside the window (Cooper et al. 2016).",
        ),
        column("icd", "unit", "Mean distance to the Delaunay neighbours."),
        column("furthest", "unit", "Distance to the furthest Delaunay neighbour."),
        column(
            "psi6",
            "0–1",
            "|ψ6|, modulus of the mean of exp(6iθ) over Delaunay neighbours: 1 in a triangular lattice.",
        ),
        column(
            "nn_direction_deg",
            "degrees",
            "Direction of the nearest neighbour as an axis, 0–180°, counter-clockwise from the right as one sees the picture.",
        ),
        column(
            "hexagon_direction_deg",
            "degrees",
            "Direction of the hexagon of neighbours, 0–60° likewise: phase of ψ6 over 6.",
        ),
    ],
};
