//! Points, the windows in which they could have been observed, and searches for neighbours. This
//! module does not depend on cones, images or files.
//!
//! # Examples
//! ```
//! use conemosaic::geometry::{Rectangle, nearest_neighbours};
//! use conemosaic::prelude::*;
//!
//! let ring = |corners: [(f64, f64); 4]| corners.map(|(x, y)| Point::new(x, y)).to_vec();
//! let outer = ring([(0., 0.), (10., 0.), (10., 10.), (0., 10.)]);
//! let hole = ring([(4., 4.), (6., 4.), (6., 6.), (4., 6.)]);
//! let window = Window::polygon(vec![outer, hole])?;
//! assert_eq!(window.area(), 96.);
//! assert!(!window.contains(Point::new(5., 5.)));
//!
//! // on a torus distances go around the edges
//! let torus = Window::Torus(Rectangle::new(0., 0., 10., 10.)?);
//! let points = [Point::new(0.5, 5.), Point::new(9.5, 5.), Point::new(5., 5.)];
//! assert_eq!(nearest_neighbours(&points, &torus).distances, [1., 1., 4.5]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod cell_area;
mod covariance;
mod edge_tree;
pub(crate) mod index;
mod lattice;
mod neighbours;
mod point;
mod polygon;
mod polygon_identity;
pub mod power;
mod ring;
mod window;

pub use cell_area::clipped_cell_area;
pub use covariance::SetCovariance;
pub use lattice::lattice_dual;
pub use neighbours::{NearestNeighbours, distances_to_nearest, nearest_neighbours};
pub use point::Point;
pub use polygon::{Polygon, PolygonError};
pub use ring::Ring;
pub use window::{Rectangle, Window, WindowError};
