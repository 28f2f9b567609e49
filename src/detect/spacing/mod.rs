//! How far apart the cones are: first from Yellott's ring, then from the density of what was found.

mod kernels;
mod refine;
mod ring;

pub use refine::{BORDER, refined};
pub use ring::{RingEstimate, RingProfile};

/// Smallest and largest spacing looked for, in px: closer cones are not resolved, wider ones are too few in a field.
pub const SPACING_RANGE: (f64, f64) = (4., 40.);
