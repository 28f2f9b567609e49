//! Tables and figures. Does not know how the numbers were made.

mod csv;
mod error;
mod figure;
mod grey;
mod ink;
mod overlay;
mod table;

pub use csv::write_csv;
pub use error::ReportError;
pub use figure::{Curve, MosaicFigure, ReferenceLine, mosaic_figure};
pub use overlay::{MarkKind, OverlayMark, encode_png, overlay};
pub use table::{significant, table};
