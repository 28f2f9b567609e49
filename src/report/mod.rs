//! Tables and figures. Does not know how the numbers were made.

mod cell;
mod csv;
mod error;
mod figure;
mod grey;
mod ink;
mod overlay;
mod page;
mod record;
mod table;

pub use cell::Cell;
pub use csv::write_csv;
pub use error::ReportError;
pub use figure::{Curve, MosaicFigure, ReferenceLine, mosaic_figure};
pub use overlay::{MarkKind, OverlayMark, encode_png, overlay};
pub use page::{expected_errors, page};
pub use record::{CoordinatesRecord, DetectionRecord, ImageRecord, MosaicRecord, SamplerDistance, by_need};
pub use table::{counted, significant, table};
