//! The columns of `summary.csv`, each with its definition, unit, edge rule and source.
//!
//! Headers, rows and the data dictionary are all made from the lists in this folder.

mod about;
mod density;
mod detection;
mod dictionary;
mod expected;
mod fourier;
mod metric;
mod names;
mod neighbours;
mod order;
mod regularity;
mod selection;
mod summary;
#[cfg(test)]
mod tests;
mod unit;
mod voronoi;
mod words;

pub use dictionary::{dictionary, dictionary_csv, dictionary_text};
pub use metric::{Metric, MetricGroup, Quantity, Subject, SummaryKind};
pub use names::{ColumnNames, column_names};
pub use selection::MetricSelection;
pub use summary::Summary;
pub use words::column_in_words;

use metric::metric;

/// Returns all metrics in the order of their columns.
pub fn metrics() -> impl Iterator<Item = &'static Metric> {
    [
        about::FILE,
        density::DENSITY,
        neighbours::NEAREST,
        neighbours::SAMPLERS,
        detection::DETECTION,
        voronoi::VORONOI,
        regularity::REGULARITY,
        order::RECOVERY,
        order::ORIENTATION,
        fourier::FOURIER,
        regularity::EVENNESS,
        expected::EXPECTED,
    ]
    .into_iter()
    .flatten()
}
