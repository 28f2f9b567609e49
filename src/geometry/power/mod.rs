//! Power diagrams (Aurenhammer 1987, <https://doi.org/10.1137/0216006>): the cell of a site
//! contains the points whose squared distance to that site, less the weight of the site, is less
//! than for any other site. With equal weights this is the Voronoi diagram.
//!
//! 1. Each cell starts as the entire domain.
//! 2. It is cut by the bisectors of the sites near enough to matter, which a grid finds.
//! 3. A bound on the distance of sites that could still cut the cell tells when all sites that
//!    matter have been used.
//!
//! Cells thus need no triangulation and are made in parallel, and coincident, collinear or hidden
//! sites are no special cases. The work per site is constant where sites are spread evenly.
//!
//! # Examples
//! ```
//! use conemosaic::geometry::power::{Domain, PowerSites};
//!
//! let square = Domain::rectangle(4., 4.);
//! let mut sites = PowerSites::new(&square, None, &[[1., 2.], [3., 2.]]);
//! let even = sites.diagram(&[0., 0.], None);
//! assert_eq!(even.cells()[0].mass, 8.); // half of the square: without weights a Voronoi diagram
//! let heavier = sites.diagram(&[1., 0.], Some(&even));
//! assert!(heavier.cells()[0].mass > 8.); // a site of more weight has a larger cell
//! ```

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
