use super::{OutputTable, column};

/// Regions of interest.
pub static ROIS: OutputTable = OutputTable {
    file: "rois.csv",
    commands: "measure --rois, measure --roi-side",
    about: "A row a region, measured as a mosaic of its own: behind these columns come those of summary.csv for the points in it, by \
            their own Voronoi cells, bound by the region.",
    columns: &[
        column("file", "text", "The file, as given."),
        column("roi", "text", "Name of the region; rROWcCOLUMN of sliding ones."),
        column("x0", "unit", "Left edge, after it has grown."),
        column("y0", "unit", "Upper edge."),
        column("x1", "unit", "Right edge."),
        column("y1", "unit", "Lower edge."),
        column(
            "flag",
            "text",
            "Empty; edge: it reaches beyond the window and is cut; few: not enough bound cells; outside: none of the window.",
        ),
    ],
};

/// Means by group.
pub static GROUPS: OutputTable = OutputTable {
    file: "groups.csv",
    commands: "measure --group-by, run --group-by",
    about: "A row a group and column of summary.csv; every image counts once.",
    columns: &[
        column("group", "text", "The group; the values of several columns of the manifest by commas."),
        column("images", "count", "Images (files) of the group."),
        column("column", "text", "The column of summary.csv."),
        column("unit", "text", "Its unit."),
        column("n", "count", "Images of the group that have a value there."),
        column("mean", "column “unit”", "Mean of these."),
        column("sd", "column “unit”", "Standard deviation (n − 1) of these; empty for fewer than two."),
    ],
};

/// Files without results.
pub static FAILURES: OutputTable = OutputTable {
    file: "failures.csv",
    commands: "all that take several files",
    about: "A row a file that failed; there is no such table if none did.",
    columns: &[
        column("file", "text", "The file, as given."),
        column("reason", "text", "Why, and what helps."),
    ],
};
