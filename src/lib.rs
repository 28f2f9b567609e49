//! conemosaic: cones of the human retina, found, measured and compared with point samplers.
//!
//! An image becomes a mosaic, a mosaic becomes numbers, numbers are compared with models, and all of it
//! becomes a report. Data flows one way: [`image`] → [`detect`] → [`mosaic`] → [`stats`] → [`compare`] →
//! [`report`]; [`batch`] does that for a folder. [`sample`] makes the models, [`render`] makes images of
//! known truth, [`geometry`] is the ground they all stand on.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod batch;
pub mod compare;
pub mod detect;
pub mod files;
pub mod geometry;
pub mod image;
pub mod mosaic;
mod numeric;
pub mod render;
pub mod report;
pub mod sample;
pub mod stats;
