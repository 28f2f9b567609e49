//! Points by place, to find those near another one: one index for each way of asking that a measured loop needs.

mod hash_grid;
mod torus_cells;
mod torus_grid;

pub(crate) use hash_grid::{HashGrid, distance};
pub(crate) use torus_cells::TorusCells;
pub(crate) use torus_grid::{Nearby, TorusGrid};
