use super::summary::columns;
use super::{Metric, MetricGroup, SummaryKind, metrics};
use std::str::FromStr;

/// Which metrics a summary has: all, or those of some groups or names. The file, the number of cones and the warnings are
/// always there.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MetricSelection {
    /// Groups, metrics or columns; empty: all.
    wanted: Vec<String>,
}

/// What no summary is without.
const ALWAYS: [&str; 4] = ["file", "unit", "n", "warnings"];

impl MetricSelection {
    /// Whether anything was chosen.
    pub fn is_all(&self) -> bool {
        self.wanted.is_empty()
    }

    /// Whether a summary of this kind has any column of a group.
    pub fn has_any_of(&self, group: MetricGroup, kind: SummaryKind) -> bool {
        metrics()
            .filter(|m| m.group == group && m.is_of(kind))
            .any(|m| columns(m, kind, &[]).any(|c| self.has(m, &c.name)))
    }

    /// Whether a column of a metric is in the summary.
    pub(super) fn has(&self, metric: &Metric, column: &str) -> bool {
        self.is_all() || ALWAYS.contains(&metric.name) || self.names(metric, column)
    }

    /// Whether it was asked for.
    pub(super) fn names(&self, metric: &Metric, column: &str) -> bool {
        self.wanted.iter().any(|w| *w == metric.group.name() || *w == metric.name || *w == column)
    }
}

impl FromStr for MetricSelection {
    type Err = String;

    /// Groups, metrics or columns, separated by commas; `all`.
    fn from_str(text: &str) -> Result<Self, String> {
        let wanted: Vec<String> =
            text.split(',').map(|part| part.trim().to_owned()).filter(|part| !part.is_empty()).collect();
        if wanted.is_empty() {
            return Err("no metric is named: give groups or names, separated by commas".into());
        }
        if wanted.iter().any(|w| w == "all") {
            return Ok(Self::default());
        }
        let known = |w: &str| {
            MetricGroup::ALL.iter().any(|g| g.name() == w)
                || [SummaryKind::Images, SummaryKind::Coordinates].into_iter().any(|kind| {
                    metrics()
                        .filter(|m| m.is_of(kind))
                        .any(|m| m.name == w || columns(m, kind, &[]).any(|c| c.name == w))
                })
        };
        match wanted.iter().find(|w| !known(w)) {
            None => Ok(Self { wanted }),
            Some(unknown) => {
                let groups: Vec<&str> = MetricGroup::ALL.iter().map(|g| g.name()).collect();
                Err(format!(
                    "“{unknown}” is no metric: expected groups ({}) or names from `conemosaic metrics`",
                    groups.join(", ")
                ))
            }
        }
    }
}
