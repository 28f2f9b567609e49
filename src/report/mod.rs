//! Tables and figures. Does not know how the numbers were made.
//!
//! # Examples
//! ```
//! use conemosaic::prelude::*;
//! use conemosaic::report::{MarkKind, OverlayMark, encode_png, metrics, overlay};
//!
//! // an image with its cones marked, as the bytes of a PNG
//! let image = read("fixtures/images/split_sparse.png".as_ref())?;
//! let found = detect(&image, &DetectOptions::default())?;
//! let mark = |cone: &Detection| {
//!     let Point { x, y } = cone.centre;
//!     OverlayMark { x, y, radius: 3., kind: MarkKind::Detection }
//! };
//! let marks: Vec<OverlayMark> = found.cones.iter().map(mark).collect();
//! let png = encode_png(&overlay(&image, &marks, found.spacing))?;
//! assert!(png.starts_with(&b"\x89PNG"[..]));
//!
//! // the definition of every column of summary.csv
//! for metric in metrics() {
//!     let words = &metric.column.words;
//!     println!("{} ({}): {}", words.name, words.unit, words.definition);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod cell;
mod convert;
mod csv;
mod error;
mod figure;
mod finding;
mod landmarks;
mod metrics;
mod page;
mod paper;
mod picture;
mod record;
pub mod tables;
mod text;
mod verdict;

pub use cell::Cell;
pub use convert::{FigureFormat, convert};
pub use csv::write_csv;
pub use error::ReportError;
pub use figure::{
    AgreementLine, AgreementPanel, Curve, EnvelopePanel, FrocLine, MosaicFigure, ReferenceLine,
    ReliabilityFigure, SamplerPanel, agreement_figure, envelope_figure, froc_figure, maps_figure,
    mosaic_figure, reliability_figure, samplers_figure, spectrum_figure, spectrum_png,
};
pub use finding::FindingRecord;
pub use landmarks::LandmarkRecord;
pub use metrics::{
    ColumnNames, Metric, MetricGroup, MetricSelection, Quantity, Subject, Summary, SummaryKind,
    column_in_words, column_names, dictionary, dictionary_csv, dictionary_text, metrics,
};
pub use page::{
    Document, Headline, ScoredImage, Section, ValidationPage, expected_errors, page, validation_page,
};
pub use paper::PaperResults;
pub use picture::{
    MarkKind, OverlayMark, PowerScale, encode_png, overlay, overlay_with_border, spectrum_plane,
};
pub use record::{
    ConesFrom, CoordinatesRecord, DetectionRecord, ImageRecord, MosaicRecord, SamplerDistance, by_need,
};
pub use tables::{EdgeRule, Failure, ValidationRow, VersusRow};
pub use text::{
    TextTable, accuracy_table, agreement_table, comparison_table, counted, group_table, significant, table,
    threshold_table,
};
pub use verdict::VerdictRecord;
