//! Statistics of point patterns.
//!
//! Every statistic takes the points and the window in which they were observed. Points must be
//! finite and lie inside the window, as the points of a [`Mosaic`](crate::mosaic::Mosaic) always
//! do. The module does not depend on samplers or files.
//!
//! # Examples
//! ```
//! use conemosaic::prelude::*;
//! use conemosaic::sample::sampler;
//! use rand::SeedableRng;
//!
//! let window = Window::rectangle(0., 0., 300., 300.)?;
//! let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
//! let points = sampler("dart-throwing")?.sample(500, &window, &mut rng)?;
//! let (mosaic, _) = Mosaic::new(points, window, LengthUnit::Pixel, None)?;
//!
//! let measures = measure(&mosaic, &MeasureOptions::default());
//! let summary = &measures.summary;
//! println!("regularity index {:.2}", summary.nearest.ri.unwrap_or(f64::NAN));
//! println!("six-sided cells {:.0} %", summary.voronoi.six_sided_percent.unwrap_or(f64::NAN));
//! let g = measures.pcf?;
//! assert_eq!(g.options.radii().len(), g.g.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod clark_evans;
mod delaunay;
mod density_recovery;
mod edge_weight;
mod error;
mod functions;
mod histogram;
mod inhomogeneous;
mod intensity;
mod maps;
mod measure;
mod nearest;
mod orientation;
mod pairs;
mod pcf;
mod rank_correlation;
mod rank_envelope;
mod rois;
mod spectrum;
mod summary;
mod trend;
mod voronoi;

pub use crate::geometry::{NearestNeighbours, nearest_neighbours};
pub use clark_evans::ClarkEvans;
pub use density_recovery::{BinWidth, DensityRecovery, DensityRecoveryOptions, density_recovery};
pub use error::StatsError;
pub use functions::{FirstDistance, FunctionOptions, Functions, RipleyK, functions, ripley_k};
pub use histogram::Histogram;
pub use inhomogeneous::{Inhomogeneous, inhomogeneous};
pub use intensity::default_intensity_bandwidth;
pub use maps::{
    Along, Contour, Ellipse, Landmarks, LocalFlag, LocalValues, LocalWindow, MapGrid, MapOptions, Maps,
    ProfileRow, maps,
};
pub use measure::{MeasureOptions, Measures, measure};
pub use nearest::{Deviation, Moments, interior, moments};
pub use orientation::{AXIS_BIN, NearestAxes, NeighbourEllipse, Orientation, orientation};
pub(crate) use pcf::pcf_on_one_thread;
pub use pcf::{EdgeCorrection, Kernel, Pcf, PcfOptions, pcf};
pub use rank_correlation::{FEWEST_PAIRS, RankCorrelation, rank_correlation};
pub use rank_envelope::{RankEnvelope, rank_envelope};
pub use rois::{Grown, grown, lies_in, sliding};
pub use spectrum::{ModalSpacing, PowerSpectrum, SpectrumOptions, modal_spacing, spectrum};
pub use summary::{OrientationSummary, RecoverySummary, Summary};
pub use trend::{TREND_LEVEL, TREND_TOLERANCE, Trend, trend};
pub use voronoi::{Cell, Voronoi, VoronoiSummary, voronoi};
