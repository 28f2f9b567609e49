//! Tables and figures. Does not know how the numbers were made.

mod csv;
mod error;
mod table;

pub use csv::write_csv;
pub use error::ReportError;
pub use table::{significant, table};
