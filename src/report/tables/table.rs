use super::{Column, ColumnWords, Part, Row, Value};
use crate::report::{Cell, ReportError, write_csv};

/// A kind of CSV file: where it is written, what a row is, and its columns.
pub struct Table<R: Row + 'static> {
    /// Name of the file; `NAME` stands for the name of an image or file of coordinates.
    pub file: &'static str,
    /// Commands that write the file.
    pub commands: &'static str,
    /// Description of a row, and remarks that apply to all columns.
    pub about: &'static str,
    /// Columns in their order.
    pub columns: &'static [Column<R>],
}

/// The differences between files of one kind.
#[derive(Clone, Copy, Debug, Default)]
pub struct Layout<'s> {
    /// Samplers for which columns are repeated.
    pub samplers: &'s [String],
    /// Optional parts that the file has.
    pub parts: &'s [Part],
}

impl<R: Row> Table<R> {
    /// Returns these rows as a CSV file, without columns that are repeated or optional.
    ///
    /// # Errors
    /// Fails if the rows cannot be written as CSV.
    pub fn csv<'a>(&self, rows: impl IntoIterator<Item = R::Of<'a>>) -> Result<Vec<u8>, ReportError> {
        self.csv_as(&Layout::default(), rows)
    }

    /// Returns these rows as a CSV file with the columns of a layout.
    ///
    /// # Errors
    /// Fails if the rows cannot be written as CSV.
    pub fn csv_as<'a>(
        &self,
        layout: &Layout,
        rows: impl IntoIterator<Item = R::Of<'a>>,
    ) -> Result<Vec<u8>, ReportError> {
        let columns = self.expanded(layout);
        let cells = |row: R::Of<'a>| columns.iter().map(|(c, sampler)| c.cell(&row, sampler)).collect();
        let rows: Vec<Vec<Cell>> = rows.into_iter().map(cells).collect();
        sheet(&self.header(layout), &rows)
    }

    /// Returns the names of the columns of a layout.
    pub fn header(&self, layout: &Layout) -> Vec<String> {
        self.expanded(layout).into_iter().map(|(column, sampler)| column.name_for(sampler)).collect()
    }

    /// Returns the cells of a row, in the order of [`Self::header`].
    pub fn cells(&self, layout: &Layout, row: &R::Of<'_>) -> Vec<Cell> {
        self.expanded(layout).into_iter().map(|(column, sampler)| column.cell(row, sampler)).collect()
    }

    /// Returns every column of the layout with its sampler, which is empty for columns that are not
    /// repeated.
    ///
    /// Repeated columns that stand together are repeated together: `low_a`, `high_a`, `low_b`,
    /// `high_b`.
    fn expanded<'s>(&self, layout: &Layout<'s>) -> Vec<(&'static Column<R>, &'s str)> {
        let repeats = |column: &Column<R>| matches!(column.value, Value::PerSampler(_));
        let kept = |column: &&Column<R>| column.words.part.is_none_or(|part| layout.parts.contains(&part));
        let groups = self.columns.chunk_by(|a, b| repeats(a) && repeats(b));
        let of_group = |group: &'static [Column<R>]| -> Vec<(&'static Column<R>, &'s str)> {
            let samplers: Vec<&str> = match group.first() {
                Some(first) if repeats(first) => layout.samplers.iter().map(String::as_str).collect(),
                _ => vec![""],
            };
            let of_sampler = |sampler| group.iter().filter(kept).map(move |column| (column, sampler));
            samplers.into_iter().flat_map(of_sampler).collect()
        };
        groups.flat_map(of_group).collect()
    }
}

/// Returns rows as CSV; this is the only way in which tables become files.
pub(in crate::report) fn sheet(header: &[String], rows: &[Vec<Cell>]) -> Result<Vec<u8>, ReportError> {
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    let mut bytes = Vec::new();
    write_csv(&mut bytes, &header, rows)?;
    Ok(bytes)
}

/// A table without its values, for the data dictionary.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableWords {
    /// Name of the file.
    pub file: &'static str,
    /// Commands that write the file.
    pub commands: &'static str,
    /// Description of a row, and remarks that apply to all columns.
    pub about: &'static str,
    /// Columns without their values.
    pub columns: Vec<ColumnWords>,
}

/// A table whose rows may be of any type.
pub trait Described: Sync {
    /// Returns the description of the table.
    fn words(&self) -> TableWords;
}

impl<R: Row> Described for Table<R> {
    fn words(&self) -> TableWords {
        TableWords {
            file: self.file,
            commands: self.commands,
            about: self.about,
            columns: self.columns.iter().map(|column| column.words).collect(),
        }
    }
}
