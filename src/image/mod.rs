//! Reading PNG and TIFF as one grey plane, padding, filters. Knows nothing of cones.

/// Grey values, one `f32` a pixel, indexed `[[y, x]]`; (0, 0) is the top-left pixel. Stored row by row.
pub type Plane = ndarray::Array2<f32>;
