//! Tests that check every column of every table against the value of the API that it names.
//!
//! The columns of a table differ in these rows, so that exchanging the values of any two cannot
//! pass.

mod mosaic;
mod paper;
mod records;
mod scores;

use super::{Described, TABLES, sheet};
use crate::report::Cell;

/// A column name and its expected cells, one per row.
type Expected<'a> = (&'a str, Vec<Cell>);

/// Tables that were checked against the API, by file and commands.
#[derive(Default)]
struct Held(Vec<(&'static str, &'static str)>);

impl Held {
    /// Asserts that a file has exactly these columns.
    fn table(&mut self, table: &dyn Described, file: Vec<u8>, expected: &[Expected]) {
        let words = table.words();
        let name = words.file;
        for (k, (a, values)) in expected.iter().enumerate() {
            for (b, others) in &expected[k + 1..] {
                assert_ne!(values, others, "{name}: {a} and {b} could be exchanged unnoticed");
            }
        }
        let rows = expected.iter().map(|(_, values)| values.len()).max().unwrap_or(0);
        assert!(rows > 0, "{name}: a table without rows holds nothing");
        let row = |k: usize| expected.iter().map(|(_, values)| values[k].clone()).collect();
        let rows: Vec<Vec<Cell>> = (0..rows).map(row).collect();
        let header: Vec<String> = expected.iter().map(|(column, _)| (*column).to_owned()).collect();
        let wanted = String::from_utf8(sheet(&header, &rows).unwrap()).unwrap();
        let found = String::from_utf8(file).unwrap();
        for (found, wanted) in found.lines().zip(wanted.lines()) {
            assert_eq!(found, wanted, "{name}");
        }
        assert_eq!(found.lines().count(), wanted.lines().count(), "{name}");
        self.0.push((name, words.commands));
    }

    /// Asserts that a file has exactly this row.
    fn row(&mut self, table: &dyn Described, file: Vec<u8>, expected: Vec<(&str, Cell)>) {
        let expected: Vec<Expected> =
            expected.into_iter().map(|(column, cell)| (column, vec![cell])).collect();
        self.table(table, file, &expected);
    }
}

/// Returns a series as cells.
fn cells<T: Copy + Into<Cell>>(values: impl IntoIterator<Item = T>) -> Vec<Cell> {
    values.into_iter().map(Into::into).collect()
}

#[test]
fn every_column_of_every_table_is_the_value_that_its_name_says() {
    let mut held = Held::default();
    mosaic::points_and_cones(&mut held);
    mosaic::functions_of_distance(&mut held);
    mosaic::maps_and_profiles(&mut held);
    mosaic::spectra_of_tiles(&mut held);
    records::records(&mut held);
    records::regions_groups_and_failures(&mut held);
    scores::validation(&mut held);
    scores::curves_of_scores(&mut held);
    scores::agreement(&mut held);
    scores::pairs(&mut held);
    paper::tables(&mut held);
    for table in TABLES.into_iter().map(|t| t.words()) {
        assert!(held.0.contains(&(table.file, table.commands)), "{} is not held to anything", table.file);
    }
}

#[test]
fn columns_are_described_and_no_table_has_one_twice() {
    for table in TABLES.into_iter().map(|t| t.words()) {
        assert!(table.about.ends_with('.'), "{}: {}", table.file, table.about);
        for (k, column) in table.columns.iter().enumerate() {
            let place = format!("{}, {}", table.file, column.name);
            assert!(column.definition.ends_with('.') && !column.unit.is_empty(), "{place}");
            assert!(table.columns[..k].iter().all(|other| other.name != column.name), "{place}");
        }
    }
}
