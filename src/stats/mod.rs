//! Statistics of point patterns. Knows nothing of samplers or files.
//!
//! Every statistic takes the points and the window they could have been seen in; points must be finite and inside
//! it, as those of a [`Mosaic`](crate::mosaic::Mosaic) are.

mod edge_weight;
mod error;
mod histogram;
mod measure;
mod nearest;
mod pairs;
mod pcf;
mod polygon_waves;
mod spectrum;
mod trend;
mod voronoi;

pub use crate::geometry::{NearestNeighbours, nearest_neighbours};
pub use error::StatsError;
pub use histogram::Histogram;
pub use measure::{MeasureOptions, Measures, measure};
pub use nearest::{Deviation, Moments, interior, moments};
pub(crate) use pcf::pcf_on_one_thread;
pub use pcf::{EdgeCorrection, Kernel, Pcf, PcfOptions, pcf};
pub use spectrum::{PowerSpectrum, SpectrumOptions, spectrum};
pub use trend::{TREND_LEVEL, Trend, trend};
pub use voronoi::{Cell, Voronoi, VoronoiSummary, voronoi};
