//! A mosaic against samplers; detections against reference marks.

mod l_infinity;
mod reference;

pub use l_infinity::{CompareError, l_infinity};
pub use reference::{ReferenceCurve, References};
