//! Points, the windows in which they could have been observed, and searches for neighbours. This
//! module knows nothing of cones, images or files.

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
