use anyhow::Result;
use clap::Args;
use conemosaic::mosaic::io::{Origin, ReadOptions};

/// How coordinate files are to be understood.
#[derive(Args)]
pub struct CoordinateArgs {
    /// What the file calls the centre of the top-left pixel: 0, 0.5 (ImageJ, WebPlotDigitizer) or 1 (MATLAB)
    /// [default: as the kind of file says, otherwise 0]
    #[arg(long, value_name = "O", value_parser = origin, help_heading = "Coordinates")]
    origin: Option<Origin>,
    /// y points up, as in WebPlotDigitizer's XY axes: the height of the image in the unit of the file
    #[arg(long, value_name = "HEIGHT", help_heading = "Coordinates")]
    flip_y: Option<f64>,
    /// Take only the dataset (WebPlotDigitizer) or region (ImageJ) of this name
    #[arg(long, value_name = "NAME", help_heading = "Coordinates")]
    dataset: Option<String>,
}

fn origin(text: &str) -> Result<Origin, String> {
    text.parse().map_err(|_| "expected 0, 0.5 or 1".to_owned())
}

impl CoordinateArgs {
    pub fn options(&self) -> Result<ReadOptions> {
        let options = ReadOptions { origin: self.origin, flip_y: self.flip_y, dataset: self.dataset.clone() };
        options.validate()?;
        Ok(options)
    }
}
