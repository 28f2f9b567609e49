//! Cone spacing: first from Yellott's ring in the power spectrum, then from the density of the
//! detections. If the spacing varies across the image, the result is a map.

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

/// Smallest and largest cone spacing that is looked for, in px.
///
/// Closer cones are not resolved. Cones farther apart are looked for in means over blocks of pixels
/// (see [`WIDEST_SPACING`](super::WIDEST_SPACING)).
pub const SPACING_RANGE: (f64, f64) = (4., 40.);
