//! Power diagrams (Aurenhammer 1987): the cell of a site holds the places whose squared distance to the site, less the
//! site's weight, is least. With equal weights that is the Voronoi diagram.
//!
//! Every cell is cut on its own out of the domain, by the bisectors of sites near enough to matter: sites are found by a
//! grid, and a bound on their reach says when none is missing. So cells need no triangulation, are made in parallel, and
//! coincident, collinear or hidden sites are no special cases. The work per site is constant where sites are spread evenly.

mod cell;
mod diagram;
mod domain;
mod grid;
mod raster;

pub use diagram::{Facet, PowerCell, PowerDiagram, PowerSites};
pub use domain::Domain;
pub use raster::{Raster, RasterError};

#[cfg(test)]
mod tests;
