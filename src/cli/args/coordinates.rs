use anyhow::Result;
use clap::Args;
use conemosaic::mosaic::io::{Origin, ReadOptions};

/// Options for reading coordinate files.
#[derive(Args)]
pub struct CoordinateArgs {
    /// Coordinate that the file gives to the centre of the top-left pixel: 0, 0.5 or 1
    ///
    /// 0.5 is the convention of ImageJ and WebPlotDigitizer, 1 that of MATLAB. [default: 0.5 for
    /// WebPlotDigitizer projects and for sub-pixel ImageJ regions from before version 1.52t,
    /// otherwise 0]
    #[arg(long, value_name = "O", value_parser = origin, help_heading = "Coordinates")]
    origin: Option<Origin>,
    /// Height of the image, for text files whose y axis points up
    ///
    /// The unit is that of the file; in px, the height is the number of pixel rows.
    /// WebPlotDigitizer's XY axes point up. In WebPlotDigitizer projects and ImageJ regions y
    /// always points down, so they are read as they are. [default: y points down]
    #[arg(long, value_name = "HEIGHT", help_heading = "Coordinates")]
    flip_y: Option<f64>,
    /// Read only the dataset (WebPlotDigitizer) or region (ImageJ) of this name [default: all]
    #[arg(long, value_name = "NAME", help_heading = "Coordinates")]
    dataset: Option<String>,
}

/// Parses the value of `--origin`.
fn origin(text: &str) -> Result<Origin, String> {
    text.parse().map_err(|_| "expected 0, 0.5 or 1".to_owned())
}

impl CoordinateArgs {
    /// Returns the options for reading after checking them.
    ///
    /// # Errors
    /// Fails if the height is not a positive number.
    pub fn options(&self) -> Result<ReadOptions> {
        let options = ReadOptions { origin: self.origin, flip_y: self.flip_y, dataset: self.dataset.clone() };
        options.validate()?;
        Ok(options)
    }
}
