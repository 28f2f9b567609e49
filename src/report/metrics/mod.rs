//! The columns of `summary.csv`: what each is, in which unit, by which edge rule, after whom. Headers, rows and the data
//! dictionary all come from the lists here.

mod about;
mod density;
mod dictionary;
mod metric;
mod neighbours;
mod order;
mod selection;
mod summary;
mod unit;
mod words;

pub use dictionary::{dictionary, dictionary_table, dictionary_text};
pub use metric::{EdgeRule, Metric, MetricGroup, Quantity, Subject, SummaryKind};
pub use selection::MetricSelection;
pub use summary::Summary;
pub use words::column_in_words;

/// All metrics, in the order of the columns.
pub fn metrics() -> impl Iterator<Item = &'static Metric> {
    [
        about::FILE,
        density::DENSITY,
        neighbours::NEAREST,
        neighbours::SAMPLERS,
        about::DETECTION,
        neighbours::VORONOI,
        neighbours::REGULARITY,
        order::RECOVERY,
        order::ORIENTATION,
        order::FOURIER,
        neighbours::EVENNESS,
        density::EXPECTED,
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
            assert!(names.insert(metric.name), "{} twice", metric.name);
            assert!(metric.definition.ends_with('.'), "{}: {}", metric.name, metric.definition);
            if groups.last() != Some(&metric.group) {
                groups.push(metric.group);
            }
        }
        assert_eq!(groups, MetricGroup::ALL);
    }
}
