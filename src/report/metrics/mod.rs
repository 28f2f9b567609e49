//! The columns of `summary.csv`: what each is, in which unit, by which edge rule, after whom. Headers, rows
//! and the data dictionary all come from the lists here.

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
mod unit;
#[cfg(test)]
mod values;
mod voronoi;
mod words;

pub use dictionary::{dictionary, dictionary_csv, dictionary_text};
pub use metric::{Metric, MetricGroup, Quantity, Subject, SummaryKind};
pub use names::{ColumnNames, column_names};
pub use selection::MetricSelection;
pub use summary::Summary;
pub use words::column_in_words;

use metric::metric;

/// Returns all metrics, in the order of the columns.
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_metric_has_its_own_name_a_definition_and_stands_with_its_group() {
        let mut names = HashSet::new();
        let mut groups = Vec::new();
        for metric in metrics() {
            assert!(names.insert(metric.column.words.name), "{} twice", metric.column.words.name);
            assert!(
                metric.column.words.definition.ends_with('.'),
                "{}: {}",
                metric.column.words.name,
                metric.column.words.definition
            );
            if groups.last() != Some(&metric.group) {
                groups.push(metric.group);
            }
        }
        assert_eq!(groups, MetricGroup::ALL);
    }
}
