//! Tables and figures. Does not know how the numbers were made.

mod cell;
mod csv;
mod document;
mod error;
mod figure;
mod finding;
mod grey;
mod ink;
mod landmarks;
mod metrics;
mod overlay;
mod page;
mod paper;
mod paper_page;
mod record;
mod spectrum;
mod table;
pub mod tables;
mod validation;
mod validation_page;
mod verdict;

pub use cell::Cell;
pub use csv::write_csv;
pub use document::{Document, Headline, Section};
pub use error::ReportError;
pub use figure::{
    AgreementLine, AgreementPanel, Curve, EnvelopePanel, FrocLine, MosaicFigure, ReferenceLine,
    ReliabilityFigure, SamplerPanel, agreement_figure, envelope_figure, froc_figure, maps_figure,
    mosaic_figure, reliability_figure, samplers_figure,
};
pub use finding::FindingRecord;
pub use landmarks::LandmarkRecord;
pub use metrics::{
    ColumnNames, Metric, MetricGroup, MetricSelection, Quantity, Subject, Summary, SummaryKind, column_names,
    dictionary, dictionary_csv, dictionary_text, metrics,
};
pub use overlay::{MarkKind, OverlayMark, encode_png, overlay, overlay_with_border};
pub use page::{expected_errors, page};
pub use paper::PaperResults;
pub use record::{CoordinatesRecord, DetectionRecord, ImageRecord, MosaicRecord, SamplerDistance, by_need};
pub use spectrum::{PowerScale, spectrum_png};
pub use table::{counted, significant, table};
pub use tables::{EdgeRule, Failure, ValidationRow, VersusRow};
pub use validation::{
    TextTable, accuracy_table, agreement_table, comparison_table, group_table, threshold_table,
};
pub use validation_page::{ScoredImage, ValidationPage, validation_page};
pub use verdict::VerdictRecord;
