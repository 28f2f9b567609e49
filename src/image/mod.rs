//! Reading PNG and TIFF as one grey plane, padding, Gaussian and Fourier filters. Knows nothing of cones.

mod fourier;
mod gaussian;
mod pad;

pub(crate) use fourier::signed_frequency;
pub use fourier::{Spectrum, fast_length};
pub use gaussian::gaussian;
pub use pad::{crop, mirror, reflect_pad};

/// Grey values, one `f32` a pixel, indexed `[[y, x]]`; (0, 0) is the top-left pixel. Stored row by row.
pub type Plane = ndarray::Array2<f32>;

/// From this many pixels on, a filter spreads one image over all cores. Smaller images travel side by side instead.
pub(crate) const PARALLEL_PIXELS: usize = 1 << 18;
