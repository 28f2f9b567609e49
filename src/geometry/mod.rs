//! Points and the windows in which they could have been seen. Knows nothing of cones, images or files.

mod covariance;
mod edge_tree;
mod neighbours;
mod point;
mod polygon;
mod polygon_identity;
pub mod power;
mod ring;
mod window;

pub use covariance::SetCovariance;
pub use neighbours::{NearestNeighbours, nearest_neighbours};
pub use point::Point;
pub use polygon::{Polygon, PolygonError};
pub use ring::Ring;
pub use window::{Rectangle, Window, WindowError};
