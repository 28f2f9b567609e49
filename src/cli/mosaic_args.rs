use super::args::CoordinateArgs;
use anyhow::Result;
use clap::Args;
use conemosaic::batch::{CoordinatesOptions, Crop, Plan, Region};
use conemosaic::mosaic::io::ReadOptions;
use std::path::PathBuf;

/// Options for the area of a mosaic and for reading its coordinates.
#[derive(Args)]
pub struct MosaicArgs {
    /// Area in which points could have been seen
    ///
    /// Density and edge corrections depend on it.
    ///
    /// auto         the imaged part, without black margins, of the image with
    ///              the same name, which lies beside the file or in --images
    /// image        all of that image
    /// unit         the unit square
    /// WxH          an image of W × H; in px it reaches from −0.5 to W − 0.5
    ///              and from −0.5 to H − 0.5
    /// X0,Y0,X1,Y1  left, upper, right and lower edge, in the unit of the
    ///              coordinates
    /// FILE         a file of the corners of one or more polygons, read with
    ///              the same --origin and --flip-y as the coordinates: CSV
    ///              with columns x,y, a WebPlotDigitizer project or CSV file,
    ///              or an ImageJ ROI
    ///
    /// In CSV a blank line or a new value in a column “ring” begins a new
    /// polygon. A polygon inside another is a hole.
    #[arg(
        long,
        verbatim_doc_comment,
        value_name = "WINDOW",
        default_value = "auto",
        allow_hyphen_values = true
    )]
    window: Region,
    /// Rectangle to which the window is cut; points outside it are left out [default: no cut]
    ///
    /// WxH (centred in the window) or X0,Y0,X1,Y1, in the unit of the coordinates, or in another
    /// unit with the suffix px or um, such as 55x55um.
    #[arg(long, value_name = "RECT", allow_hyphen_values = true, conflicts_with = "torus")]
    crop: Option<Crop>,
    /// Folder of the images NAME.png or NAME.tif, or one image [default: beside the files]
    ///
    /// The windows auto and image, and the size of a pixel with --field-um or --field-degrees, are
    /// taken from the images.
    #[arg(long, value_name = "PATH")]
    images: Option<PathBuf>,
    /// Treat opposite edges of the window as connected (periodic boundaries); rectangles only
    #[arg(long)]
    torus: bool,
    #[command(flatten)]
    coordinates: CoordinateArgs,
}

impl MosaicArgs {
    /// Returns the options for reading the files.
    ///
    /// # Errors
    /// Fails if a value is out of its range.
    pub fn read(&self) -> Result<ReadOptions> {
        self.coordinates.options()
    }

    /// Returns the options of a command that reads coordinate files.
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
