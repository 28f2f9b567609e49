use super::{Layout, Row, Table, column, sheet};
use crate::geometry::Rectangle;
use crate::report::{Cell, CoordinatesRecord, ReportError, Subject, Summary};
use serde::{Deserialize, Serialize};

/// A region of interest of a mosaic.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RoiRow {
    /// The file of the mosaic, as given.
    pub file: String,
    /// Name of the region.
    pub roi: String,
    /// The box, after it has grown.
    pub frame: Rectangle,
    /// Remarks: `edge`, `few`, `outside`, or several.
    pub flag: String,
    /// The points in it as a mosaic of their own; `None` outside the window.
    pub record: Option<CoordinatesRecord>,
}

impl Row for RoiRow {
    type Of<'a> = &'a Self;
}

/// Regions of interest; the columns of a summary follow behind.
pub static ROIS: Table<RoiRow> = Table {
    file: "rois.csv",
    commands: "measure --rois, measure --roi-side",
    about: "One row per region, measured as a mosaic of its own: behind these columns come those of \
            summary.csv for the points in it, by their own Voronoi cells, bound by the region.",
    columns: &[
        column("file", "text", "The file, as given.").of(|r| r.file.as_str().into()),
        column("roi", "text", "Name of the region; rROWcCOLUMN of sliding ones.")
            .of(|r| r.roi.as_str().into()),
        column("x0", "unit", "Left edge, after it has grown.").of(|r| r.frame.x0().into()),
        column("y0", "unit", "Upper edge, after it has grown.").of(|r| r.frame.y0().into()),
        column("x1", "unit", "Right edge, after it has grown.").of(|r| r.frame.x1().into()),
        column("y1", "unit", "Lower edge, after it has grown.").of(|r| r.frame.y1().into()),
        column(
            "flag",
            "text",
            "Empty; edge: it reaches beyond the window and is cut; few: not enough bound cells; outside: \
                none of the window.",
        )
        .of(|r| r.flag.as_str().into()),
    ],
};

/// Returns `rois.csv`: where the regions are, then the columns of a summary but for the file.
///
/// # Errors
/// If it cannot be written as CSV.
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
