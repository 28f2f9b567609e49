use super::{OutputTable, column};

/// Local values.
pub static MAPS: OutputTable = OutputTable {
    file: "NAME.maps.csv",
    commands: "measure --maps, run --maps (images/NAME/maps.csv)",
    about: "A row a cone. Values are taken over the bound Voronoi cells that lie wholly in a square window about it; empty where there \
            are none, in µm or mm² without a scale.",
    columns: &[
        column("x", "unit", "Its place."),
        column("y", "unit", "Its place."),
        column("side", "unit", "Side of the window."),
        column("bound", "count", "Bound cells in it."),
        column(
            "flag",
            "text",
            "Empty; edge: the window reaches beyond the mosaic; few: the mosaic has not the cells asked for.",
        ),
        column("density", "1/unit²", "Cells over their total area."),
        column("icd", "unit", "Mean distance to the Delaunay neighbours."),
        column("nnd", "unit", "Mean distance to the nearest neighbour."),
        column("ri", "ratio", "Regularity index of these: mean over standard deviation."),
        column("psi6", "0–1", "Mean |ψ6|."),
        column("six_sided_percent", "%", "Cells with six sides."),
        column("density_per_mm2", "1/mm²", "Cells over their total area."),
        column("icd_um", "µm", "Mean distance to the Delaunay neighbours."),
        column("nnd_um", "µm", "Mean distance to the nearest neighbour."),
    ],
};

/// By distance from the centroid of density.
pub static PROFILES: OutputTable = OutputTable {
    file: "NAME.profiles.csv",
    commands: "measure --maps, run --maps (images/NAME/profiles.csv)",
    about: "A row a distance from the cone density centroid, in rings (bound cells whose cones lie in them) and along four meridians \
            (the maps).",
    columns: &[
        column("along", "text", "ring, or right, down, left, up."),
        column("r", "unit", "Distance; of a ring the middle of its width."),
        column("bound", "count", "Bound cells of the ring."),
        column("share", "0–1", "Share of the circle through the middle of the ring that lies in the window."),
        column("density", "1/unit²", "Of a ring its bound cells over their area; on a meridian the map."),
        column("spacing", "unit", "Hexagonal spacing of that density."),
        column("icd", "unit", "Mean distance to the Delaunay neighbours."),
        column("nnd", "unit", "Mean distance to the nearest neighbour."),
        column("r_um", "µm", "Distance; of a ring the middle of its width."),
        column(
            "density_per_mm2",
            "1/mm²",
            "Of a ring its bound cells over their area; on a meridian the map.",
        ),
        column("spacing_um", "µm", "Hexagonal spacing of that density."),
    ],
};

/// Spacing by spectra.
pub static FOURIER_MAP: OutputTable = OutputTable {
    file: "fourier_map.csv",
    commands: "run --maps (images/NAME/fourier_map.csv)",
    about: "A row a place of the image: the ring of the spectrum of overlapping tiles (after Cooper et al. 2019); no rows where the \
            image has none.",
    columns: &[
        column("x_px", "px", "To the right from the centre of the first pixel."),
        column("y_px", "px", "Down from the centre of the first pixel."),
        column("spacing_px", "px", "Distance of neighbours by the ring."),
        column("spacing_um", "µm", "The same; empty without a scale."),
        column("confidence", "0–1", "How clearly the ring stands out of the spectrum's background."),
    ],
};

/// Read off the maps.
pub static LANDMARKS: OutputTable = OutputTable {
    file: "landmarks.csv",
    commands: "measure --maps, run --maps",
    about: "A row a file: what its density map says. Only windows that lie in the mosaic count.",
    columns: &[
        column("file", "text", "The file, as given."),
        column("unit", "text", "Unit of the coordinates (px, um, unit): “unit” below."),
        column("um_per_unit", "µm", "Micrometres of retina per unit; empty if not known."),
        column("local_window", "text", "The window around each cone: so many bound cells, or its side."),
        column("n", "count", "Cones."),
        column("n_whole", "count", "Cones whose window lies in the mosaic: the map is made of these."),
        column("pcd", "1/unit²", "Peak cone density: the greatest value of the map."),
        column("pcd_per_mm2", "1/mm²", "Peak cone density: the greatest value of the map."),
        column("pcd_x", "unit", "Where it is."),
        column("pcd_y", "unit", "Where it is."),
        column(
            "cdc_x",
            "unit",
            "Cone density centroid: of the region of at least isodensity_share of the peak, weighted by density (Reiniger et al. 2021).",
        ),
        column("cdc_y", "unit", "Cone density centroid."),
        column("cdc_density", "1/unit²", "The map there."),
        column("cdc_density_per_mm2", "1/mm²", "The map there."),
        column("isodensity_share", "0–1", "Share of the peak that bounds the region."),
        column("isodensity_area", "unit²", "Area of the region."),
        column("isodensity_area_mm2", "mm²", "Area of the region."),
        column("ellipse_x", "unit", "Centre of the ellipse fitted to the contour of the region."),
        column("ellipse_y", "unit", "Centre of that ellipse."),
        column("ellipse_semi_major", "unit", "Its longer half axis."),
        column("ellipse_semi_minor", "unit", "Its shorter half axis."),
        column(
            "ellipse_degrees",
            "degrees",
            "Direction of its longer axis, 0–180° from +x towards +y (down in a picture).",
        ),
        column(
            "note",
            "text",
            "Why there is no map or region, or that the region is cut by the edge of the map.",
        ),
    ],
};
