//! Lattices as point patterns, with or without jitter.

mod rows;
mod square;
mod triangular;

pub(super) use rows::Lattice;
pub use square::Square;
pub use triangular::Triangular;
