use anyhow::Result;
use clap::Args;
use conemosaic::batch::{Length, RoiRequest, RoiSource};
use conemosaic::mosaic::io::{ReadOptions, RoiTable};
use std::path::PathBuf;

/// Regions to be measured as mosaics of their own.
#[derive(Args)]
#[command(next_help_heading = "Regions of interest")]
pub struct RoiArgs {
    /// CSV of boxes, each measured as a mosaic of its own: a header of x0,y0,x1,y1 or x,y,width,height in the unit of the
    /// coordinates (or x0_um,…: in µm), counted from where they are (--origin, --flip-y); a column name; and a column file,
    /// if boxes differ from file to file: its longest part of the file name counts
    #[arg(long, value_name = "FILE", group = "roi_source")]
    rois: Option<PathBuf>,
    /// Squares of this side instead, which slide over the bounds of the window: in the unit of the coordinates, or in µm with um
    /// behind it
    #[arg(long, value_name = "SIDE", group = "roi_source")]
    roi_side: Option<Length>,
    /// From one of these squares to the next [default: their side, so that they tile the window]
    #[arg(long, value_name = "STEP", requires = "roi_side", conflicts_with = "rois")]
    roi_step: Option<Length>,
    /// Each region grows about its centre, in proportion, until it holds this many bound cells (1–100000); one that ends at the
    /// border of the window first is flagged “few”
    #[arg(long, value_name = "N", requires = "roi_source")]
    roi_cells: Option<usize>,
}

impl RoiArgs {
    /// The regions asked for, if any are; `read`: how coordinates are to be understood.
    pub fn request(&self, read: &ReadOptions) -> Result<Option<RoiRequest>> {
        let source = match (&self.rois, self.roi_side) {
            (Some(path), _) => RoiSource::Table(RoiTable::read(path, read)?),
            (None, Some(side)) => RoiSource::Sliding { side, step: self.roi_step },
            (None, None) => return Ok(None),
        };
        let request = RoiRequest { source, cells: self.roi_cells };
        request.validate()?;
        Ok(Some(request))
    }
}
