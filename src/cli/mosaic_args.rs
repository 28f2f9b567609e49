use super::args::CoordinateArgs;
use anyhow::Result;
use clap::Args;
use conemosaic::batch::{CoordinatesOptions, Crop, Plan, Region};
use conemosaic::mosaic::io::ReadOptions;
use std::path::PathBuf;

/// Where points could have been seen, and how they are measured.
#[derive(Args)]
pub struct MosaicArgs {
    /// Where points could have been seen: auto (what was imaged of the image of that name beside the file: without black
    /// margins), image (all of it), unit (square), WxH (an image of that size) or X0,Y0,X1,Y1 in the unit of the
    /// coordinates, or a FILE of corners, read as the coordinates are (--origin, --flip-y): CSV of x,y (a blank line or a
    /// column “ring” parts rings, rings within rings are holes), WebPlotDigitizer project or ImageJ ROI
    #[arg(long, value_name = "WINDOW", default_value = "auto", allow_hyphen_values = true)]
    window: Region,
    /// Of that window only this rectangle: WxH (centred in it) or X0,Y0,X1,Y1, in the unit of the coordinates, or with px or
    /// um behind it; points outside are left out
    #[arg(long, value_name = "RECT", allow_hyphen_values = true, conflicts_with = "torus")]
    crop: Option<Crop>,
    /// Folder of the images NAME.png or NAME.tif that windows and sizes are taken from, or one image [default: they lie beside
    /// the files]
    #[arg(long, value_name = "PATH")]
    images: Option<PathBuf>,
    /// Opposite edges of the window are the same place
    #[arg(long)]
    torus: bool,
    #[command(flatten)]
    coordinates: CoordinateArgs,
}

impl MosaicArgs {
    /// Returns how the files are to be understood.
    pub fn read(&self) -> Result<ReadOptions> {
        self.coordinates.options()
    }

    /// Returns the options of a command that reads coordinates.
    pub fn options(&self, plan: Plan, read: ReadOptions) -> CoordinatesOptions {
        CoordinatesOptions {
            plan,
            read,
            region: self.window.clone(),
            images: self.images.clone(),
            crop: self.crop,
            torus: self.torus,
        }
    }
}
