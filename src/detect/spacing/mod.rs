//! Cone spacing: first from Yellott's ring, then from the density of the detections, and from place
//! to place where it varies.

mod bins;
mod fourier;
mod map;
mod refine;
mod ring;
mod ring_network;
mod rings;

pub use fourier::{
    FourierEstimate, FourierMap, FourierMapOptions, FourierSpacing, Sector, fourier_map, fourier_spacing,
};
pub use map::SpacingMap;
pub use refine::BORDER;
pub(super) use refine::{Start, refined_map};
pub(in crate::detect) use ring::{AROUND, CLEAR, PERIODS};
pub use ring::{RingEstimate, RingProfile};
pub(super) use ring_network::weights as ring_weights;
pub(super) use rings::Rings;

/// Smallest and largest spacing that is looked for, in px.
///
/// Closer cones are not resolved. Wider ones are looked for in means of pixels (see
/// [`WIDEST_SPACING`](super::WIDEST_SPACING)).
pub const SPACING_RANGE: (f64, f64) = (4., 40.);
