use anyhow::Result;
use clap::Args;
use conemosaic::batch::{Length, MapRequest, MapWindow};

/// Maps of local density, spacing and regularity.
#[derive(Args)]
#[command(next_help_heading = "Maps")]
pub struct MapArgs {
    /// Also map density, inter-cell distance, nearest neighbour, regularity, |ψ6| and six-sided share: each is taken over the
    /// bound cells in a square window around every cone; and read off the density map: peak (PCD), centroid (CDC),
    /// isodensity area, profiles
    #[arg(long)]
    maps: bool,
    /// Each window grows until it holds this many bound cells (3–100000) [default: 100]; one that reaches beyond the mosaic
    /// first is flagged “edge”, and no landmark is read off it
    #[arg(long, value_name = "N", requires = "maps", conflicts_with = "map_side")]
    map_cells: Option<usize>,
    /// Windows of this side instead: in the unit of the coordinates, or in µm with um behind it, such as 37.5um
    #[arg(long, value_name = "SIDE", requires = "maps")]
    map_side: Option<Length>,
    /// The CDC is the density-weighted centroid of the region in which density is at least this share of the peak (0.01–0.99)
    #[arg(long, value_name = "SHARE", requires = "maps", default_value_t = MapRequest::default().isodensity)]
    isodensity: f64,
    /// Distance between rows of the profiles, in the unit of the coordinates or with um behind it [default: two hexagonal
    /// spacings]
    #[arg(long, value_name = "STEP", requires = "maps")]
    profile_step: Option<Length>,
}

impl MapArgs {
    /// Whether maps are asked for.
    pub const fn asked(&self) -> bool {
        self.maps
    }

    /// The maps asked for, if any are.
    pub fn request(&self) -> Result<Option<MapRequest>> {
        if !self.asked() {
            return Ok(None);
        }
        let window = match (self.map_cells, self.map_side) {
            (_, Some(side)) => MapWindow::Side(side),
            (Some(n), None) => MapWindow::Cells(n),
            (None, None) => MapRequest::default().window,
        };
        let request = MapRequest { window, isodensity: self.isodensity, profile_step: self.profile_step };
        request.validate()?;
        Ok(Some(request))
    }
}
