//! From an image to cone centres: flatten → spacing → filter → maxima → refine → score.

mod types;

pub use types::{Detection, Detections, Modality, Polarity};
