//! A mosaic against samplers: curves, their distance and the verdict of a test.

mod curves;
mod l_infinity;
mod reference;
mod verdict;

pub use curves::mean_curve;
pub(crate) use curves::{curve, draw, of_sampler};
pub use l_infinity::{CompareError, l_infinity};
pub use reference::{ReferenceCurve, References};
pub use verdict::{Envelope, SamplerVerdict, VerdictOptions, verdict};
