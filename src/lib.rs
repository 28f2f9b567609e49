//! Finds the cones in images of the human retina, measures their mosaic and compares it with point
//! samplers.
//!
//! # Examples
//! An image becomes cones, and the cones become numbers:
//! ```
//! use conemosaic::prelude::*;
//!
//! let image = read("fixtures/images/confocal_dense.png".as_ref())?;
//! let found = detect(&image, &DetectOptions::default())?;
//! let scale = Scale::new(0.5, 288.)?; // µm per px, µm per degree of visual angle
//! let mosaic = found.mosaic(&image, Some(scale))?;
//! let measures = measure(&mosaic, &MeasureOptions::default());
//!
//! println!("{} cones, {:.4} per px²", mosaic.len(), mosaic.density());
//! println!("regularity index {:.2}", measures.summary.nearest.ri.ok_or("no neighbours")?);
//! println!("g(r) in {} bins", measures.pcf?.g.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Where to find what
//!
//! | to … | use |
//! |---|---|
//! | begin, with the usual names in scope | [`prelude`] |
//! | read an image, filter it, find what was imaged | [`image`] |
//! | find cones | [`detect::detect`], or its stages in [`detect`] |
//! | read coordinates of any program; state window, unit and scale | [`mosaic::io`], [`mosaic`] |
//! | compute statistics of a mosaic, all at once or one by one | [`stats::measure()`], [`stats`] |
//! | compare a mosaic with samplers | [`compare::References`], [`compare::l_infinity`], [`compare::verdict`] |
//! | score detections against marks | [`compare::validate`], [`compare::match_points`] |
//! | compare graders or sessions | [`compare::agreement()`], [`compare::intraclass`] |
//! | draw points, or write a sampler | [`sample::sampler()`], [`sample::Sampler`] |
//! | simulate images whose cones are known | [`render::simulate`] |
//! | write tables, figures and pages | [`report`] |
//! | process whole folders, as the program does | [`batch`] |
//! | handle points, windows and neighbours | [`geometry`] |
//!
//! Data flows one way: `image` → `detect` → `mosaic` → `stats` → `compare` → `report` → `batch`.
//!
//! # Conventions
//!
//! - Coordinates count from (0, 0) at the centre of the top-left pixel, x to the right, y down.
//! - Images are planes of `f32` indexed as [row, column], but sizes are given as width, height.
//! - Lengths are in the unit of the coordinates unless a name ends in `_px`, `_um` or `_s`
//!   (hexagonal spacings).
//! - Everything random takes a seed or a generator; the same seed gives the same bytes for any
//!   number of threads.
//!
//! # Features
//!
//! `cli` (the program), `report` (the modules [`report`] and [`batch`]) and `archives` (coordinates
//! in `.zip` and `.tar`) are on by default; `onnx` runs networks in ONNX format.
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
