use super::metric::Value;
use super::unit::Unit;
use super::{Metric, MetricSelection, Quantity, Subject, SummaryKind, metrics};
use crate::report::Cell;

/// A column of a summary.
pub(super) struct Column {
    pub name: String,
    pub metric: &'static Metric,
    pub unit: Unit,
    sampler: Option<String>,
}

/// The columns of a metric.
pub(super) fn columns<'a>(
    metric: &'static Metric,
    kind: SummaryKind,
    samplers: &'a [String],
) -> Box<dyn Iterator<Item = Column> + 'a> {
    if let Value::PerSampler(_) = metric.value {
        return Box::new(samplers.iter().map(move |sampler| Column {
            name: metric.name.replace("SAMPLER", &sampler.replace('-', "_")),
            metric,
            unit: Unit::Coordinates,
            sampler: Some(sampler.clone()),
        }));
    }
    let units = match metric.quantity {
        Quantity::Plain(_) => &Unit::ALL[..1],
        _ => &Unit::ALL[..],
    };
    Box::new(units.iter().map(move |&unit| Column {
        name: format!("{}{}", metric.name, unit.suffix(metric.quantity, kind)),
        metric,
        unit,
        sampler: None,
    }))
}

impl Column {
    fn cell(&self, subject: &Subject) -> Cell {
        let value = match (self.metric.value, &self.sampler) {
            (Value::One(of), _) => of(subject),
            (Value::PerSampler(of), Some(sampler)) => of(subject, sampler),
            (Value::PerSampler(_), None) => Cell::Missing,
        };
        self.unit.convert(value, self.metric.quantity, subject.mosaic())
    }

    fn words(&self, kind: SummaryKind) -> String {
        match self.metric.quantity {
            Quantity::Plain("text" | "count" | "ratio" | "0–1") => self.name.clone(),
            quantity => match self.unit.words(quantity, kind) {
                "column “unit”" => format!("{} (unit)", self.name),
                words => format!("{} ({words})", self.name),
            },
        }
    }
}

/// The columns of a `summary.csv`, from which its header and rows are made.
pub struct Summary {
    kind: SummaryKind,
    selection: MetricSelection,
    columns: Vec<Column>,
    labels: Vec<String>,
}

impl Summary {
    /// Of a kind, with the metrics chosen, the samplers compared with, and the columns of a manifest behind them.
    pub fn new(
        kind: SummaryKind,
        selection: &MetricSelection,
        samplers: &[String],
        labels: &[String],
    ) -> Self {
        let columns: Vec<Column> = metrics()
            .filter(|m| m.is_of(kind))
            .flat_map(|m| columns(m, kind, samplers))
            .filter(|c| selection.has(c.metric, &c.name))
            .collect();
        let taken = |name: &str| columns.iter().any(|c| c.name == name);
        let labels =
            labels.iter().map(|l| if taken(l) { format!("manifest_{l}") } else { l.clone() }).collect();
        Self { kind, selection: selection.clone(), columns, labels }
    }

    /// Names of the columns.
    pub fn header(&self) -> Vec<String> {
        self.columns.iter().map(|c| c.name.clone()).chain(self.labels.iter().cloned()).collect()
    }

    /// The row of one image or file, under [`Self::header`].
    pub fn row(&self, subject: &Subject) -> Vec<Cell> {
        let labels = &subject.mosaic().labels;
        let label = |k: usize| labels.get(k).map(String::as_str).filter(|text| !text.is_empty()).into();
        self.columns.iter().map(|c| c.cell(subject)).chain((0..self.labels.len()).map(label)).collect()
    }

    /// A row as a JSON object: numbers in full, `null` where there is none.
    ///
    /// # Errors
    /// If a number cannot be written.
    pub fn json(&self, subject: &Subject) -> Result<serde_json::Value, serde_json::Error> {
        let cells = self.row(subject).into_iter().map(serde_json::to_value);
        let pairs = self.header().into_iter().zip(cells).map(|(name, cell)| Ok((name, cell?)));
        Ok(serde_json::Value::Object(pairs.collect::<Result<_, serde_json::Error>>()?))
    }

    /// The numbers that can be averaged over images, by column: name, unit, value of each subject.
    pub fn numbers(&self, subjects: &[Subject]) -> Vec<(String, &'static str, Vec<Option<f64>>)> {
        let of = |column: &Column| {
            let number = |subject: &Subject| match column.cell(subject) {
                Cell::Number(v) => Some(v),
                Cell::Count(n) => Some(n as f64),
                Cell::Text(_) | Cell::Missing => None,
            };
            let unit = column.unit.words(column.metric.quantity, self.kind);
            let values: Vec<Option<f64>> = subjects.iter().map(number).collect();
            values.iter().any(Option::is_some).then(|| (column.name.clone(), unit, values))
        };
        self.columns.iter().filter_map(of).collect()
    }

    /// What was asked for, as a table to be read: headers with units and rows; `None` if everything was.
    pub fn readable(&self, subjects: &[Subject]) -> Option<(Vec<String>, Vec<Vec<String>>)> {
        if self.selection.is_all() {
            return None;
        }
        let asked: Vec<&Column> = self
            .columns
            .iter()
            .filter(|c| c.name == "file" || self.selection.names(c.metric, &c.name))
            // a column without any number says nothing
            .filter(|c| subjects.iter().any(|s| c.cell(s) != Cell::Missing))
            .collect();
        let header = asked.iter().map(|c| c.words(self.kind)).collect();
        let rows = subjects.iter().map(|s| asked.iter().map(|c| c.cell(s).readable()).collect()).collect();
        Some((header, rows))
    }
}
