//! Points and the windows in which they could have been seen. Knows nothing of cones, images or files.

mod neighbours;
mod point;
mod window;

pub use neighbours::{NearestNeighbours, nearest_neighbours};
pub use point::Point;
pub use window::{Rectangle, Window, WindowError};
