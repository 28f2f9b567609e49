use super::names::canonical;
use super::summary::columns;
use super::{Metric, MetricGroup, SummaryKind, metrics};
use crate::sample::samplers;
use std::str::FromStr;

/// Selection of the metrics of a summary: all, or those of some groups or names.
///
/// The file, the unit, the number of cones and the warnings are always included.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MetricSelection {
    /// Names of the wanted groups, metrics or columns, where current names have replaced old ones;
    /// empty if all metrics are wanted.
    wanted: Vec<String>,
}

/// Columns that every summary has.
const ALWAYS: [&str; 4] = ["file", "unit", "n", "warnings"];

/// All kinds of summaries.
const KINDS: [SummaryKind; 2] = [SummaryKind::Images, SummaryKind::Coordinates];

impl MetricSelection {
    /// Returns whether all metrics are wanted.
    pub fn is_all(&self) -> bool {
        self.wanted.is_empty()
    }

    /// Returns whether a summary of this kind has any column of a group.
    pub fn has_any_of(&self, group: MetricGroup, kind: SummaryKind) -> bool {
        metrics()
            .filter(|m| m.group == group && m.is_of(kind))
            .any(|m| columns(m, kind, &[]).any(|c| self.has(m, &c.name)))
    }

    /// Returns whether a column of a metric is in the summary.
    pub(super) fn has(&self, metric: &Metric, column: &str) -> bool {
        self.is_all() || ALWAYS.contains(&metric.column.words.name) || self.names(metric, column)
    }

    /// Returns whether a column was asked for by its group, its metric or its own name.
    pub(super) fn names(&self, metric: &Metric, column: &str) -> bool {
        let names = [metric.group.name(), metric.column.words.name, column];
        self.wanted.iter().any(|w| names.contains(&w.as_str()))
    }

    /// Returns whether a column was asked for by its own name.
    pub(super) fn names_column(&self, column: &str) -> bool {
        self.wanted.iter().any(|w| w == column)
    }
}

/// Returns whether a word names a group, a metric or a column, including the columns of any
/// sampler.
fn is_known(word: &str) -> bool {
    let every: Vec<String> = samplers().iter().map(|s| s.name().to_owned()).collect();
    let names = |m: &'static Metric, kind| {
        m.column.words.name == word || columns(m, kind, &every).any(|column| column.name == word)
    };
    MetricGroup::ALL.iter().any(|group| group.name() == word)
        || KINDS.iter().any(|&kind| metrics().filter(|m| m.is_of(kind)).any(|m| names(m, kind)))
}

impl FromStr for MetricSelection {
    type Err = String;

    /// Reads names of groups, metrics or columns, separated by commas, or the word `all`.
    ///
    /// Names of earlier versions are replaced by the current ones.
    ///
    /// # Errors
    /// Fails if there is no name, or one that is not known.
    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split(',').map(str::trim).filter(|part| !part.is_empty());
        let wanted: Vec<String> = parts.map(|part| canonical(part).into_owned()).collect();
        if wanted.is_empty() {
            return Err("no metric is named: give names of groups or metrics, separated by commas".into());
        }
        if wanted.iter().any(|w| w == "all") {
            return Ok(Self::default());
        }
        match wanted.iter().find(|w| !is_known(w)) {
            None => Ok(Self { wanted }),
            Some(unknown) => {
                let groups: Vec<&str> = MetricGroup::ALL.iter().map(|g| g.name()).collect();
                Err(format!(
                    "“{unknown}” is not a metric: expected groups ({}) or names from `conemosaic metrics`",
                    groups.join(", ")
                ))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Summary;

    #[test]
    fn columns_of_samplers_and_names_of_earlier_versions_can_be_chosen() {
        let header = |kind, wanted: &str| {
            let samplers = ["bnot".to_owned(), "dart-throwing".to_owned()];
            Summary::new(kind, &wanted.parse().unwrap(), &samplers, &[]).header()
        };
        let images = header(SummaryKind::Images, "l_infinity_bnot,l_infinity_dart_throwing");
        assert!(images.contains(&"l_infinity_bnot".to_owned()), "{images:?}");
        assert!(images.contains(&"l_infinity_dart_throwing".to_owned()), "{images:?}");
        for kind in KINDS {
            let old = header(kind, "spacing_um,nn_mean");
            assert_eq!(old.iter().filter(|name| name.starts_with("spacing")).count(), 1, "{old:?}");
            assert!(old.contains(&"spacing_density_um".to_owned()) && old.contains(&"nn_mean_px".to_owned()));
        }
        assert!("l_infinity_bnott".parse::<MetricSelection>().is_err());
    }
}
