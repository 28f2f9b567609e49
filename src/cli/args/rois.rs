use anyhow::Result;
use clap::Args;
use conemosaic::batch::{Length, RoiRequest, RoiSource};
use conemosaic::mosaic::io::{ReadOptions, RoiTable};
use std::path::PathBuf;

/// Options for regions of interest, each measured as a mosaic of its own.
#[derive(Args)]
#[command(next_help_heading = "Regions of interest")]
pub struct RoiArgs {
    /// CSV file of rectangles; each is measured as a mosaic of its own
    ///
    /// Columns: x0,y0,x1,y1 (edges) or x,y,width,height, in the unit of the coordinates and with
    /// the same --origin and --flip-y, or with the suffix _um (x0_um,…) in µm; optionally name; and
    /// optionally file, if the rectangles differ from file to file. A row then belongs to the files
    /// whose name contains the text in column file; of several such texts the longest counts.
    #[arg(long, value_name = "FILE", group = "roi_source")]
    rois: Option<PathBuf>,
    /// Side of square regions laid in rows over the window, instead of --rois
    ///
    /// The unit is that of the coordinates, or µm with the suffix um, such as 40um.
    #[arg(long, value_name = "SIDE", group = "roi_source")]
    roi_side: Option<Length>,
    /// Distance from one square to the next [default: their side, so that they tile the window]
    ///
    /// The unit is that of the coordinates, or µm with the suffix um.
    #[arg(long, value_name = "STEP", requires = "roi_side", conflicts_with = "rois")]
    roi_step: Option<Length>,
    /// Number of bound cells at which each region stops growing (1–100000)
    ///
    /// Regions grow about their centre and keep their proportions. A region that reaches the border
    /// of the window before it contains N bound cells is flagged “few”. [default: regions do not
    /// grow]
    #[arg(long, value_name = "N", requires = "roi_source")]
    roi_cells: Option<usize>,
}

impl RoiArgs {
    /// Returns the regions to be measured, or `None` if no option asks for any.
    ///
    /// `read` has the options for reading the coordinates of a table of regions.
    ///
    /// # Errors
    /// Fails if the table cannot be read or a value is out of its range.
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
