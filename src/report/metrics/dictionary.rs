use super::summary::columns;
use super::{Metric, MetricGroup, SummaryKind, metrics};
use crate::report::tables::{ColumnWords, Row, TABLES, Table, TableWords, column};
use crate::report::{ReportError, table};

/// Kinds of summary, each with the command that writes it.
const KINDS: [(SummaryKind, &str); 2] = [(SummaryKind::Images, "run"), (SummaryKind::Coordinates, "measure")];

/// Opening paragraphs of the data dictionary.
const INTRODUCTION: &str = "\
This part describes the columns of `summary.csv`.

Lengths, areas and densities are given in several units, one column per unit; the name of the column ends in \
the unit. A cell is empty if its value cannot be converted to that unit: px need a scale if the coordinates \
are in µm and are impossible in the unit square; µm and degrees need a scale. A column has the same name in \
all commands. The summary of `measure` also gives each of these values in the unit of the coordinates, which \
the column `unit` names; that column's name has no unit. Options that take names (`--metrics`, \
`agree --columns`) accept the name without a unit in all commands, and `spacing` for `spacing_density`.

A cell is also empty if its value is not defined or not known. For example, metrics of bound cells need at \
least one bound cell (there are none with fewer than four points), a standard deviation needs two values, and \
a ratio to a standard deviation needs values that differ. The columns of a manifest come after all others.

The edge rule says which points count, as the neighbours of a point near the border may lie outside the window. \
*all*: all points count, without any correction. *interior*: only those points count that are at least as far \
from the border as from their nearest neighbour. *bound*: only those points count whose Voronoi cell is finite \
and has every vertex strictly inside the window (Cooper et al. 2016). *see definition*: the definition states the \
column's own rule. –: the border does not affect the value.";

/// Opening paragraph of the part about all other tables.
const BESIDE: &str = "\
This part describes all other tables. `NAME` stands for the name of an image or coordinate file, and \
`SAMPLER` in the name of a column for the name of each sampler. The unit `unit` is the unit of the coordinates, \
which is px for an image.";

/// Row of the data dictionary, which describes one column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
struct DictionaryRow {
    table: &'static str,
    column: String,
    group: &'static str,
    unit: &'static str,
    edge: &'static str,
    commands: String,
    definition: &'static str,
    source: &'static str,
}

impl Row for DictionaryRow {
    type Of<'a> = &'a Self;
}

/// Columns of the data dictionary as CSV.
static DICTIONARY: Table<DictionaryRow> = Table {
    file: "dictionary.csv",
    commands: "metrics --csv",
    about: "One row for each column of each table.",
    columns: &[
        column("table", "text", "Name of the file that contains the table.").of(|r| r.table.into()),
        column("column", "text", "Name of the column.").of(|r| r.column.as_str().into()),
        column("group", "text", "Group of the column in --metrics; empty for tables other than summary.csv.")
            .of(|r| r.group.into()),
        column("unit", "text", "Unit of the column.").of(|r| r.unit.into()),
        column("edge_rule", "text", "Edge rule: which points count near the border of the window.")
            .of(|r| r.edge.into()),
        column("commands", "text", "Commands that write the table.").of(|r| r.commands.as_str().into()),
        column("definition", "text", "Definition of the value.").of(|r| r.definition.into()),
        column("source", "text", "Author and year of the publication that defines the value.")
            .of(|r| r.source.into()),
    ],
};

/// Returns one row per column of a metric, with the commands whose summaries have the column.
fn rows_of(metric: &'static Metric) -> Vec<DictionaryRow> {
    let sampler = [String::from("SAMPLER")];
    let mut rows: Vec<DictionaryRow> = Vec::new();
    for (kind, command) in KINDS.into_iter().filter(|(kind, _)| metric.is_of(*kind)) {
        for column in columns(metric, kind, &sampler) {
            match rows.iter_mut().find(|row| row.column == column.name) {
                Some(row) => row.commands = format!("{}, {command}", row.commands),
                None => rows.push(DictionaryRow {
                    table: "summary.csv",
                    unit: column.unit_words(),
                    column: column.name,
                    group: metric.group.name(),
                    edge: metric.column.words.edge.name(),
                    commands: command.to_owned(),
                    definition: metric.column.words.definition,
                    source: metric.column.words.source,
                }),
            }
        }
    }
    rows
}

/// Returns the rows of the columns of the summaries, then of all other tables.
fn all_rows() -> Vec<DictionaryRow> {
    let beside = TABLES.into_iter().flat_map(|t| {
        let words = t.words();
        words.columns.into_iter().map(move |c| DictionaryRow {
            table: words.file,
            column: c.name.to_owned(),
            group: "",
            unit: c.unit,
            edge: c.edge.name(),
            commands: words.commands.to_owned(),
            definition: c.definition,
            source: c.source,
        })
    });
    metrics().flat_map(rows_of).chain(beside).collect()
}

/// Returns the data dictionary as CSV: one row per column of the summaries, then of all other
/// tables.
///
/// # Errors
/// Fails if the table cannot be written as CSV.
pub fn dictionary_csv() -> Result<Vec<u8>, ReportError> {
    DICTIONARY.csv(&all_rows())
}

/// Returns the data dictionary for a terminal: one block per metric.
pub fn dictionary_text() -> String {
    let mut text = String::new();
    for group in MetricGroup::ALL {
        text.push_str(&format!("{} (--metrics {})\n\n", group.title(), group.name()));
        metrics().filter(|m| m.group == group).for_each(|m| text.push_str(&block(m)));
    }
    for t in TABLES.into_iter().map(|t| t.words()) {
        text.push_str(&format!("{} ({})\n\n  {}\n\n", t.file, t.commands, t.about));
        let rows: Vec<Vec<String>> = t
            .columns
            .iter()
            .map(|c| {
                let definition = format!("{}{}{}", c.definition, rule(c.edge.name()), cited(c.source));
                vec![format!("  {}", c.name), c.unit.to_owned(), definition]
            })
            .collect();
        text.push_str(&format!("{}\n\n", table(&["  column", "unit", "definition"], &rows)));
    }
    text
}

/// Returns a metric for a terminal: its columns, units and commands, then its definition.
fn block(metric: &'static Metric) -> String {
    let cells = |row: DictionaryRow| vec![row.column, row.unit.to_owned(), row.commands];
    let columns: Vec<Vec<String>> = rows_of(metric).into_iter().map(cells).collect();
    let mut text = String::new();
    for line in table(&["  column", "unit", "in"], &columns).lines().skip(2) {
        text.push_str(&format!("  {line}\n"));
    }
    let c = metric.column.words;
    text.push_str(&format!("      {}{}{}\n\n", c.definition, rule(c.edge.name()), cited(c.source)));
    text
}

/// Returns the edge rule as a sentence, or nothing for values that do not depend on it.
fn rule(edge: &str) -> String {
    if edge == "–" { String::new() } else { format!(" Edge rule: {edge}.") }
}

/// Returns the source in square brackets, or nothing if there is none.
fn cited(source: &str) -> String {
    if source.is_empty() { String::new() } else { format!(" [{source}]") }
}

/// Returns a table other than the summary as a section in Markdown.
fn section(t: &TableWords) -> String {
    let row = |c: &ColumnWords| {
        format!("| `{}` | {} | {} | {} | {} |\n", c.name, c.unit, c.edge.name(), c.definition, c.source)
    };
    format!(
        "\n### `{}` – {}\n\n{}\n\n| column | unit | edge rule | definition | source |\n|---|---|---|---|---|\n{}",
        t.file,
        t.commands,
        t.about,
        t.columns.iter().map(row).collect::<String>()
    )
}

/// Returns a metric as a row in Markdown, with its columns on separate lines of a cell.
fn line(metric: &'static Metric) -> String {
    let rows = rows_of(metric);
    let join = |cells: Vec<String>| cells.join("<br>");
    let mut commands: Vec<String> = rows.iter().map(|row| row.commands.clone()).collect();
    commands.dedup();
    format!(
        "| {} | {} | {} | {} | {} | {} |\n",
        join(rows.iter().map(|row| format!("`{}`", row.column)).collect()),
        join(rows.iter().map(|row| row.unit.to_owned()).collect()),
        join(commands),
        metric.column.words.edge.name(),
        metric.column.words.definition,
        metric.column.words.source
    )
}

/// Returns the data dictionary as a page in Markdown.
pub fn dictionary() -> String {
    let mut page = format!(
        "# Data dictionary\n\nThis file is generated by `conemosaic metrics --markdown`, and a test checks that it is up to date.\n\n{INTRODUCTION}\n"
    );
    for group in MetricGroup::ALL {
        page.push_str(&format!("\n## {} (`--metrics {}`)\n\n", group.title(), group.name()));
        page.push_str(
            "| column | unit | in | edge rule | definition | source |\n|---|---|---|---|---|---|\n",
        );
        metrics().filter(|m| m.group == group).for_each(|m| page.push_str(&line(m)));
    }
    page.push_str(&format!("\n## Other tables\n\n{BESIDE}\n"));
    TABLES.iter().for_each(|t| page.push_str(&section(&t.words())));
    page
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::metrics::{MetricSelection, Summary};

    #[test]
    fn the_dictionary_has_exactly_the_columns_of_the_summaries() {
        let rows = all_rows();
        for (kind, command) in KINDS {
            let summary = Summary::new(kind, &MetricSelection::default(), &["SAMPLER".into()], &[]);
            let of_command = |row: &&DictionaryRow| {
                row.table == "summary.csv" && row.commands.split(", ").any(|c| c == command)
            };
            let mut told: Vec<&String> = rows.iter().filter(of_command).map(|row| &row.column).collect();
            let header = summary.header();
            let mut expected: Vec<&String> = header.iter().collect();
            told.sort_unstable();
            expected.sort_unstable();
            assert_eq!(told, expected);
        }
    }
}
