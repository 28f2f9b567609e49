//! Names that most programs using this library need: `use conemosaic::prelude::*;`.
//!
//! # Examples
//! ```
//! use conemosaic::prelude::*;
//!
//! let image = read("fixtures/images/confocal_parafovea.png".as_ref())?;
//! let mosaic = detect(&image, &DetectOptions::default())?.mosaic(&image, None)?;
//! println!("{} cones, {:.5} per px²", mosaic.len(), mosaic.density());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use crate::compare::{MatchOptions, match_points};
pub use crate::detect::{DetectError, DetectOptions, Detection, Detections, Detector, detect};
pub use crate::geometry::{Point, Window};
pub use crate::image::{Modality, Plane, Polarity, read};
pub use crate::mosaic::{LengthUnit, Mosaic, Scale};
pub use crate::render::{MosaicOptions, RenderOptions, simulate};
pub use crate::sample::Sampler;
pub use crate::stats::{MeasureOptions, Measures, PcfOptions, measure, pcf};
