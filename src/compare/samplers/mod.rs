//! Comparison of a mosaic with samplers: reference curves of the samplers, l-infinity distances to
//! these curves, and the verdict of a Monte Carlo test.

mod curve_class;
mod curves;
mod l_infinity;
mod realisation;
mod reference;
mod shared_work;
mod shipped;
mod shipped_codec;
mod target_fit;
mod verdict;

pub use curves::mean_curve;
#[cfg(feature = "report")]
pub(crate) use curves::of_sampler;
pub(crate) use curves::{curve, draw};
pub use l_infinity::{CompareError, l_infinity};
pub use reference::{NotCompared, ReferenceCurve, References, SamplerCurves};
#[doc(hidden)]
pub use shipped::make_table;
pub use target_fit::{POOR_FIT, TargetFit, target_fit};
pub use verdict::{Envelope, SamplerVerdict, VerdictOptions, verdict};
