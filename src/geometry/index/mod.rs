//! Spatial indices that find the points near a position: one for each kind of query in a loop whose
//! speed matters.

mod bucket_grid;
mod hash_grid;
mod neighbour_tree;
mod torus_cells;
mod torus_grid;
mod window_grid;

pub(crate) use bucket_grid::BucketGrid;
pub(crate) use hash_grid::{HashGrid, distance};
pub(crate) use neighbour_tree::NeighbourTree;
pub(crate) use torus_cells::TorusCells;
pub(crate) use torus_grid::{Nearby, TorusGrid};
pub(crate) use window_grid::WindowGrid;
