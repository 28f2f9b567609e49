//! conemosaic: cones of the human retina, found, measured and compared with point samplers.
//!
//! An image becomes a mosaic, a mosaic becomes numbers, numbers are compared with models, and all of it
//! becomes a report. Data flows one way: [`image`] → [`detect`] → [`mosaic`] → [`stats`] → [`compare`] →
//! [`report`]; [`batch`] does that for a folder. [`sample`] makes the models, [`render`] makes images of
//! known truth, [`geometry`] is the ground they all stand on.
//!
//! # Examples
//! An image, simulated here, becomes cones, and the cones become numbers:
//! ```
//! use conemosaic::prelude::*;
//! use rand::SeedableRng;
//!
//! let options = RenderOptions { width: 128, height: 128, ..RenderOptions::new(Modality::Confocal) };
//! let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
//! let image = simulate(&MosaicOptions::default(), &options, &mut rng)?.image;
//!
//! let found = detect(&image, &DetectOptions::default())?;
//! let scale = Scale::new(0.5, 288.)?; // µm per px, µm per degree
//! let mosaic = found.mosaic(&image, Some(scale))?;
//! let measures = measure(&mosaic, &MeasureOptions::default());
//!
//! let regularity = measures.nearest.ri.ok_or("all distances are equal")?;
//! let cones_per_px2 = mosaic.density();
//! let g = measures.pcf?.g;
//! assert!(regularity > 3. && cones_per_px2 > 0.005 && g.len() == PcfOptions::default().bins);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]
#![warn(missing_docs)]

#[cfg(feature = "report")]
pub mod batch;
pub mod choice;
pub mod compare;
pub mod detect;
pub mod files;
pub mod geometry;
pub mod image;
pub mod mosaic;
mod numeric;
pub mod prelude;
pub mod render;
#[cfg(feature = "report")]
pub mod report;
pub mod sample;
pub mod stats;
