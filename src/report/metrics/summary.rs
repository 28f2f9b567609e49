use super::unit::Unit;
use super::{Metric, MetricGroup, MetricSelection, Quantity, Subject, SummaryKind, metrics};
use crate::report::tables::{Value, sheet};
use crate::report::{Cell, ReportError};

/// Column of a summary: one metric in one unit or of one sampler.
pub(super) struct Column {
    /// Name in the header.
    pub name: String,
    /// Metric that the column shows.
    pub metric: &'static Metric,
    /// Unit of the values.
    pub unit: Unit,
    /// Name of the sampler; empty if the metric is not one per sampler.
    sampler: String,
}

/// Returns the columns of a metric: one per sampler, or one per unit.
pub(super) fn columns<'a>(
    metric: &'static Metric,
    kind: SummaryKind,
    samplers: &'a [String],
) -> Box<dyn Iterator<Item = Column> + 'a> {
    if let Value::PerSampler(_) = metric.column.value {
        return Box::new(samplers.iter().map(move |sampler| Column {
            name: metric.column.name_for(sampler),
            metric,
            unit: Unit::Coordinates,
            sampler: sampler.clone(),
        }));
    }
    Box::new(Unit::all(metric.quantity, kind).map(move |unit| Column {
        name: format!("{}{}", metric.column.words.name, unit.suffix(metric.quantity)),
        metric,
        unit,
        sampler: String::new(),
    }))
}

impl Column {
    fn cell(&self, subject: &Subject) -> Cell {
        let value = self.metric.column.cell(subject, &self.sampler);
        self.unit.convert(value, self.metric.quantity, subject.mosaic())
    }

    /// Returns the unit of the column in words.
    pub fn unit_words(&self) -> &'static str {
        self.unit.words(self.metric.quantity, self.metric.column.words.unit)
    }

    /// Returns the heading of the column in a table to be read: its name with its unit.
    fn heading(&self) -> String {
        match (self.metric.quantity, self.unit_words()) {
            (Quantity::Plain, "text" | "count" | "ratio" | "0–1") => self.name.clone(),
            (_, "column “unit”") => format!("{} (unit)", self.name),
            (_, unit) => format!("{} ({unit})", self.name),
        }
    }
}

/// Columns of a `summary.csv`, from which its header and its rows are made.
pub struct Summary {
    kind: SummaryKind,
    selection: MetricSelection,
    columns: Vec<Column>,
    labels: Vec<String>,
}

impl Summary {
    /// Makes a summary of the metrics in `selection`.
    ///
    /// `samplers` are those that the mosaics are compared with, and `labels` the columns of a
    /// manifest, which come last. A label that is the name of another column becomes
    /// `manifest_LABEL`.
    pub fn new(
        kind: SummaryKind,
        selection: &MetricSelection,
        samplers: &[String],
        labels: &[String],
    ) -> Self {
        let columns: Vec<Column> = metrics()
            .filter(|m| m.is_of(kind))
            // Without samplers the column `closest_sampler` would be empty.
            .filter(|m| m.group != MetricGroup::Samplers || !samplers.is_empty())
            .flat_map(|m| columns(m, kind, samplers))
            .filter(|c| selection.has(c.metric, &c.name))
            .collect();
        let taken = |name: &str| columns.iter().any(|c| c.name == name);
        let labels =
            labels.iter().map(|l| if taken(l) { format!("manifest_{l}") } else { l.clone() }).collect();
        Self { kind, selection: selection.clone(), columns, labels }
    }

    /// Returns the names of the columns.
    pub fn header(&self) -> Vec<String> {
        self.columns.iter().map(|c| c.name.clone()).chain(self.labels.iter().cloned()).collect()
    }

    /// Returns the row of one image or file, in the order of [`Self::header`].
    pub fn row(&self, subject: &Subject) -> Vec<Cell> {
        let labels = &subject.mosaic().labels;
        let label = |k: usize| labels.get(k).map(String::as_str).filter(|text| !text.is_empty()).into();
        self.columns.iter().map(|c| c.cell(subject)).chain((0..self.labels.len()).map(label)).collect()
    }

    /// Returns `summary.csv`, one row per subject.
    ///
    /// # Errors
    /// Fails if the table cannot be written as CSV.
    pub fn csv<'a>(&self, subjects: impl IntoIterator<Item = Subject<'a>>) -> Result<Vec<u8>, ReportError> {
        let rows: Vec<Vec<Cell>> = subjects.into_iter().map(|subject| self.row(&subject)).collect();
        sheet(&self.header(), &rows)
    }

    /// Returns a row as a JSON object with the names of the columns as keys.
    ///
    /// Numbers have all their digits; missing values are `null`.
    ///
    /// # Errors
    /// Fails if a number cannot be written.
    pub fn json(&self, subject: &Subject) -> Result<serde_json::Value, serde_json::Error> {
        let cells = self.row(subject).into_iter().map(serde_json::to_value);
        let pairs = self.header().into_iter().zip(cells).map(|(name, cell)| Ok((name, cell?)));
        Ok(serde_json::Value::Object(pairs.collect::<Result<_, serde_json::Error>>()?))
    }

    /// Returns the columns of numbers, which can be averaged over images.
    ///
    /// Each is the name of the column, its unit and the value of each subject. Columns without any
    /// number are left out.
    pub fn numbers(&self, subjects: &[Subject]) -> Vec<(String, &'static str, Vec<Option<f64>>)> {
        let of = |column: &Column| {
            let number = |subject: &Subject| match column.cell(subject) {
                Cell::Number(v) => Some(v),
                Cell::Count(n) => Some(n as f64),
                Cell::Text(_) | Cell::Missing => None,
            };
            let values: Vec<Option<f64>> = subjects.iter().map(number).collect();
            values.iter().any(Option::is_some).then(|| (column.name.clone(), column.unit_words(), values))
        };
        self.columns.iter().filter_map(of).collect()
    }

    /// Returns the columns that were asked for as a table to be read: headings with units, and
    /// rows.
    ///
    /// `None` if no selection was made, as all columns would be too many to read.
    pub fn readable(&self, subjects: &[Subject]) -> Option<(Vec<String>, Vec<Vec<String>>)> {
        if self.selection.is_all() {
            return None;
        }
        let asked: Vec<&Column> = self
            .columns
            .iter()
            .filter(|c| c.name == "file" || self.selection.names(c.metric, &c.name))
            // For coordinates the same value in their own unit is already in the table.
            .filter(|c| {
                let twice = self.kind == SummaryKind::Coordinates && c.unit == Unit::Pixels;
                !twice || self.selection.names_column(&c.name)
            })
            // A column without any value says nothing.
            .filter(|c| subjects.iter().any(|s| c.cell(s) != Cell::Missing))
            .collect();
        let header = asked.iter().map(|c| c.heading()).collect();
        let rows = subjects.iter().map(|s| asked.iter().map(|c| c.cell(s).readable()).collect()).collect();
        Some((header, rows))
    }
}
