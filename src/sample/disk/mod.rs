//! Samplers that keep points at least a minimal distance apart: dart throwing and its faster
//! variants.

mod bridson;
mod dart_throwing;
mod darts;
mod poisson_disk;

pub use bridson::Bridson;
pub use dart_throwing::DartThrowing;
pub use poisson_disk::PoissonDisk;
