//! Pictures made of pixels: the image in grey, marks drawn on it, the plane of a spectrum.

mod grey;
mod ink;
mod overlay;
mod spectrum;

pub(super) use grey::{png, stretched};
pub(super) use ink::Shape;
pub use overlay::{MarkKind, OverlayMark, encode_png, overlay, overlay_with_border};
pub(super) use spectrum::{Plane, plane};
pub use spectrum::{PowerScale, spectrum_plane};
