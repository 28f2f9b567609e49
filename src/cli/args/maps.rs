use anyhow::Result;
use clap::Args;
use conemosaic::batch::{Length, MapRequest, MapWindow};

/// Options for maps of local density, spacing and regularity.
#[derive(Args)]
#[command(next_help_heading = "Maps")]
pub struct MapArgs {
    /// Also write maps of density, spacing and regularity, and landmarks of the density
    ///
    /// Mapped are density, inter-cell distance, nearest-neighbour distance, regularity, |ψ6| (order
    /// of the hexagons) and the share of six-sided cells. Each is computed, for every cone, over
    /// the bound cells in a square window around it; a cell is bound if its Voronoi polygon lies
    /// wholly inside the window. Read off the density map are the peak (peak cone density, PCD),
    /// the centroid (cone density centroid, CDC), the isodensity area and profiles.
    #[arg(long)]
    maps: bool,
    /// Number of bound cells at which each local window stops growing (3–100000) [default: 100]
    ///
    /// A local window that extends beyond the mosaic before it contains N bound cells is flagged
    /// “edge”, and no landmark is taken from it.
    #[arg(long, value_name = "N", requires = "maps", conflicts_with = "map_side")]
    map_cells: Option<usize>,
    /// Side of the windows, instead of a number of cells
    ///
    /// The unit is that of the coordinates, or µm with the suffix um, such as 37.5um.
    #[arg(long, value_name = "SIDE", requires = "maps")]
    map_side: Option<Length>,
    /// Density of the isodensity contour, as a share of the peak density (0.01–0.99)
    ///
    /// The CDC is the density-weighted centroid of the region in which the density reaches this
    /// share.
    #[arg(long, value_name = "SHARE", requires = "maps", default_value_t = MapRequest::default().isodensity)]
    isodensity: f64,
    /// Distance between the rows of the profiles [default: two hexagonal spacings]
    ///
    /// The unit is that of the coordinates, or µm with the suffix um.
    #[arg(long, value_name = "STEP", requires = "maps")]
    profile_step: Option<Length>,
}

impl MapArgs {
    /// Returns whether `--maps` is set.
    pub const fn asked(&self) -> bool {
        self.maps
    }

    /// Returns the maps to be made, or `None` without `--maps`.
    ///
    /// # Errors
    /// Fails if a value is out of its range.
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
