use super::{Layout, Row, Table, column, sheet};
use crate::geometry::Rectangle;
use crate::report::{Cell, CoordinatesRecord, ReportError, Subject, Summary};
use serde::{Deserialize, Serialize};

/// A region of interest of a mosaic.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RoiRow {
    /// Path of the mosaic's file, as set by the user.
    pub file: String,
    /// Name of the region.
    pub roi: String,
    /// Box of the region, after growing until it contains enough bound cells.
    pub frame: Rectangle,
    /// Remarks on the region: `edge`, `few`, `outside`, or several.
    pub flag: String,
    /// Record of the points in the region as a mosaic of their own; `None` outside the window.
    pub record: Option<CoordinatesRecord>,
}

impl Row for RoiRow {
    type Of<'a> = &'a Self;
}

/// The table of regions of interest; the columns of a summary follow its own.
pub static ROIS: Table<RoiRow> = Table {
    file: "rois.csv",
    commands: "measure --rois, measure --roi-side",
    about: "One row per region, measured as a mosaic of its own. After these columns come those of \
            summary.csv for the points in the region, by their own Voronoi cells, which are bound \
            if they lie in the region.",
    columns: &[
        column("file", "text", "Path of the file, as given.").of(|r| r.file.as_str().into()),
        column("roi", "text", "Name of the region; rROWcCOLUMN for sliding regions.")
            .of(|r| r.roi.as_str().into()),
        column("x0", "unit", "Left edge of the region, after it has grown.").of(|r| r.frame.x0().into()),
        column("y0", "unit", "Upper edge of the region, after it has grown.").of(|r| r.frame.y0().into()),
        column("x1", "unit", "Right edge of the region, after it has grown.").of(|r| r.frame.x1().into()),
        column("y1", "unit", "Lower edge of the region, after it has grown.").of(|r| r.frame.y1().into()),
        column(
            "flag",
            "text",
            "Empty, or “edge”: the region reaches beyond the window and is cut, “few”: it has too \
             few bound cells, “outside”: no part of it lies in the window.",
        )
        .of(|r| r.flag.as_str().into()),
    ],
};

/// Returns `rois.csv`: the columns of the regions, then those of a summary except `file`.
///
/// # Errors
/// Fails if the table cannot be written as CSV.
pub fn rois_csv(summary: &Summary, rows: &[RoiRow]) -> Result<Vec<u8>, ReportError> {
    let layout = Layout::default();
    let names = summary.header();
    let behind = || names.iter().filter(|name| *name != "file");
    let header: Vec<String> = ROIS.header(&layout).into_iter().chain(behind().cloned()).collect();
    let row = |roi: &RoiRow| -> Vec<Cell> {
        let values = match &roi.record {
            Some(record) => summary.row(&Subject::Coordinates(record)),
            None => vec![Cell::Missing; names.len()],
        };
        let values = names.iter().zip(values).filter(|(name, _)| *name != "file").map(|(_, cell)| cell);
        ROIS.cells(&layout, &roi).into_iter().chain(values).collect()
    };
    sheet(&header, &rows.iter().map(row).collect::<Vec<_>>())
}
