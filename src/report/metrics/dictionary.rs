use super::summary::columns;
use super::{Metric, MetricGroup, SummaryKind, metrics};
use crate::report::table;
use crate::report::tables::{OutputTable, TABLES};

const KINDS: [(SummaryKind, &str); 2] = [(SummaryKind::Images, "run"), (SummaryKind::Coordinates, "measure")];

/// Where `conemosaic metrics` and its page begin.
const INTRODUCTION: &str = "\
Columns of `summary.csv`. Lengths, areas and densities are given in several units at once, which the column's name ends in; those that need \
a scale are empty without one. In the summary of `measure` a name without unit means the unit of the coordinates, which the column `unit` names. \
A cell is empty where its value is not defined or not known: metrics of bound cells where there are none (below four points at \
least), standard deviations below two values, and ratios over one where all values are equal. Columns of a manifest follow behind.

Edge rules: *all*: nothing is done about the border. *interior*: points at least as far from the border as from their nearest neighbour. \
*bound*: points whose Voronoi cell is finite and has every vertex strictly inside the window (Cooper et al. 2016).";

/// Name, unit and commands of every column of a metric.
fn rows_of(metric: &'static Metric) -> Vec<[String; 3]> {
    let sampler = [String::from("SAMPLER")];
    let mut rows: Vec<[String; 3]> = Vec::new();
    for (kind, command) in KINDS.into_iter().filter(|(kind, _)| metric.is_of(*kind)) {
        for column in columns(metric, kind, &sampler) {
            let unit = column.unit.words(metric.quantity, kind).to_owned();
            match rows.iter_mut().find(|row| row[0] == column.name && row[1] == unit) {
                Some(row) => row[2] = format!("{}, {command}", row[2]),
                None => rows.push([column.name, unit, command.to_owned()]),
            }
        }
    }
    rows
}

const HEADER: [&str; 8] =
    ["table", "column", "group", "unit", "edge_rule", "commands", "definition", "source"];

/// Where the tables beside the summary begin.
const BESIDE: &str = "\
Other tables. `NAME` stands for the name of an image or a file of coordinates, `SAMPLER` in a column for that of each sampler; `unit` is the \
unit of the coordinates: px of an image.";

/// The data dictionary as rows of a table, and its header: a row a column of the summaries, then of all other tables.
pub fn dictionary_table() -> (Vec<String>, Vec<Vec<String>>) {
    let rows = metrics().flat_map(|m| {
        rows_of(m).into_iter().map(move |[name, unit, commands]| {
            let texts = [m.group.name(), m.edge.name(), m.definition, m.source].map(str::to_owned);
            let [group, edge, definition, source] = texts;
            vec!["summary.csv".to_owned(), name, group, unit, edge, commands, definition, source]
        })
    });
    let beside = TABLES.into_iter().flat_map(|t| {
        t.columns.iter().map(move |c| {
            [t.file, c.name, "", c.unit, "", t.commands, c.definition, ""].map(str::to_owned).to_vec()
        })
    });
    (HEADER.map(str::to_owned).to_vec(), rows.chain(beside).collect())
}

/// The data dictionary for a terminal: a block a metric.
pub fn dictionary_text() -> String {
    let mut text = String::new();
    for group in MetricGroup::ALL {
        text.push_str(&format!("{} (--metrics {})\n\n", group.title(), group.name()));
        for metric in metrics().filter(|m| m.group == group) {
            let columns: Vec<Vec<String>> = rows_of(metric).into_iter().map(|row| row.to_vec()).collect();
            text.push_str(
                &table(&["  column", "unit", "in"], &columns)
                    .lines()
                    .skip(2)
                    .fold(String::new(), |all, line| format!("{all}  {line}\n")),
            );
            let edge = match metric.edge.name() {
                "–" => String::new(),
                rule => format!(" Edge rule: {rule}."),
            };
            let source =
                if metric.source.is_empty() { String::new() } else { format!(" [{}]", metric.source) };
            text.push_str(&format!("      {}{edge}{source}\n\n", metric.definition));
        }
    }
    for t in TABLES {
        text.push_str(&format!("{} ({})\n\n  {}\n\n", t.file, t.commands, t.about));
        let rows: Vec<Vec<String>> = t
            .columns
            .iter()
            .map(|c| vec![format!("  {}", c.name), c.unit.to_owned(), c.definition.to_owned()])
            .collect();
        text.push_str(&format!("{}\n\n", table(&["  column", "unit", "definition"], &rows)));
    }
    text
}

/// A table beside the summary as a section in Markdown.
fn section(t: &OutputTable) -> String {
    let rows = t.columns.iter().map(|c| format!("| `{}` | {} | {} |\n", c.name, c.unit, c.definition));
    format!(
        "\n### `{}` – {}\n\n{}\n\n| column | unit | definition |\n|---|---|---|\n{}",
        t.file,
        t.commands,
        t.about,
        rows.collect::<String>()
    )
}

/// The data dictionary as a page in Markdown.
pub fn dictionary() -> String {
    let mut page = format!(
        "# Data dictionary\n\nMade by `conemosaic metrics --markdown`; a test holds it to the program.\n\n{INTRODUCTION}\n"
    );
    for group in MetricGroup::ALL {
        page.push_str(&format!("\n## {} (`--metrics {}`)\n\n", group.title(), group.name()));
        page.push_str(
            "| column | unit | in | edge rule | definition | source |\n|---|---|---|---|---|---|\n",
        );
        for metric in metrics().filter(|m| m.group == group) {
            let rows = rows_of(metric);
            let join = |k: usize| {
                let mut cells: Vec<&str> = rows.iter().map(|row| row[k].as_str()).collect();
                if k == 2 {
                    cells.dedup();
                }
                cells
                    .iter()
                    .map(|c| if k == 0 { format!("`{c}`") } else { (*c).to_owned() })
                    .collect::<Vec<_>>()
                    .join("<br>")
            };
            page.push_str(&format!(
                "| {} | {} | {} | {} | {} | {} |\n",
                join(0),
                join(1),
                join(2),
                metric.edge.name(),
                metric.definition,
                metric.source
            ));
        }
    }
    page.push_str(&format!("\n## Beside the summary\n\n{BESIDE}\n"));
    TABLES.iter().for_each(|t| page.push_str(&section(t)));
    page
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::metrics::{MetricSelection, Summary};

    #[test]
    fn the_dictionary_has_exactly_the_columns_of_the_summaries() {
        let (_, rows) = dictionary_table();
        for (kind, command) in KINDS {
            let summary = Summary::new(kind, &MetricSelection::default(), &["SAMPLER".into()], &[]);
            let of_command =
                |row: &&Vec<String>| row[0] == "summary.csv" && row[5].split(", ").any(|c| c == command);
            let mut told: Vec<&String> = rows.iter().filter(of_command).map(|row| &row[1]).collect();
            let header = summary.header();
            let mut expected: Vec<&String> = header.iter().collect();
            told.sort_unstable();
            expected.sort_unstable();
            assert_eq!(told, expected);
        }
    }
}
