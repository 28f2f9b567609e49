//! Models of the cone mosaic from the literature.
//!
//! The documentation of each model tells what is published, what is understood from the source, and
//! what is chosen here.

mod ahumada;
mod curcio_sloan;
mod deering;
mod minimal_spacing;
mod outward;
mod retina;
mod wang;

pub use ahumada::Ahumada;
pub use curcio_sloan::CurcioSloan;
pub use deering::Deering;
pub use minimal_spacing::MinimalSpacing;
pub use wang::Wang;
