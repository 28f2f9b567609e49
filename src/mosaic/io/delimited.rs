use super::cells::{Row, Table};
use super::error::Located;
use super::header::Columns;
use super::{Dataset, Dialect, Origin, RawFile};
use crate::geometry::Point;

/// Reads text in columns, with or without a header, with one point per row.
///
/// WebPlotDigitizer's CSV of one dataset and ImageJ's results are of this kind. WebPlotDigitizer's
/// CSV of all datasets is recognised by its header and read as several datasets.
pub(super) fn read(text: &str) -> Result<RawFile, Located> {
    let table = Table::new(text, "two columns of numbers, x and y")?;
    if let Some(names) = all_datasets_header(&table) {
        return read_all_datasets(&table, names);
    }
    let (columns, rows) = columns_of(&table)?;
    let mut points = Vec::with_capacity(rows.len());
    let mut scores = columns.score.map(|_| Vec::with_capacity(rows.len()));
    for row in rows {
        points.push(Point::new(table.number(row, columns.x, "x")?, table.number(row, columns.y, "y")?));
        if let (Some(scores), Some(column)) = (&mut scores, columns.score) {
            scores.push(table.number(row, column, "score")?);
        }
    }
    let dataset = Dataset { name: String::new(), origin: Origin::Zero, points };
    Ok(RawFile {
        dialect: Dialect::Delimited,
        unit: columns.unit,
        y_may_point_up: true,
        datasets: vec![dataset],
        scores,
    })
}

/// Reads the corners of rings, each ring as one dataset.
///
/// A blank line, or another value in a column `ring`, begins the next ring.
pub(super) fn read_rings(text: &str) -> Result<RawFile, Located> {
    let table = Table::new(text, "two columns of numbers, x and y")?;
    if let Some(names) = all_datasets_header(&table) {
        return read_all_datasets(&table, names);
    }
    let (columns, rows) = columns_of(&table)?;
    let header = table.rows.first().filter(|_| rows.len() < table.rows.len());
    let ring = header.and_then(|h| h.cells.iter().position(|cell| cell.eq_ignore_ascii_case("ring")));
    let lines = text.split('\n').enumerate();
    let blank: Vec<usize> = lines.filter(|(_, line)| line.trim().is_empty()).map(|(i, _)| i + 1).collect();
    let mut datasets: Vec<Dataset> = Vec::new();
    let mut before = None;
    for row in rows {
        let name = ring.and_then(|column| row.cells.get(column)).map_or("", |cell| cell.as_ref());
        let place = Some((name, blank.partition_point(|&line| line < row.line)));
        if place != before {
            datasets.push(Dataset { name: name.to_owned(), origin: Origin::Zero, points: Vec::new() });
        }
        before = place;
        let corner = Point::new(table.number(row, columns.x, "x")?, table.number(row, columns.y, "y")?);
        if let Some(dataset) = datasets.last_mut() {
            dataset.points.push(corner);
        }
    }
    let (dialect, unit) = (Dialect::Delimited, columns.unit);
    Ok(RawFile { dialect, unit, y_may_point_up: true, datasets, scores: None })
}

/// Returns the indices of the columns, and the rows below the header, or all rows without a header.
fn columns_of<'t, 'a>(table: &'t Table<'a>) -> Result<(Columns, &'t [Row<'a>]), Located> {
    match table.rows.split_first() {
        Some((first, rest)) if !first.cells.iter().any(|cell| table.is_number(cell)) => {
            Ok((Columns::named_in(first)?, rest))
        }
        Some((first, _)) if first.cells.len() < 2 => {
            let fault = super::ReadFault::OneColumn { found: super::error::shortened(first.text) };
            Err(Located::line(first.line, fault))
        }
        _ => Ok((Columns::FIRST_TWO, table.rows.as_slice())),
    }
}

/// Returns the names of the datasets, if the table is WebPlotDigitizer's export of all of them.
///
/// Such a table begins with a row that has each name above the first column of its dataset and
/// nothing above the second, followed by a row `X,Y,X,Y,…`.
fn all_datasets_header<'a>(table: &'a Table) -> Option<Vec<&'a str>> {
    let [names, axes, ..] = table.rows.as_slice() else { return None };
    let pairs = |row: &'a Row, agree: fn(&str, &str) -> bool| {
        let (pairs, rest) = row.cells.as_chunks::<2>();
        rest.is_empty() && pairs.iter().all(|[a, b]| agree(a, b))
    };
    let is_header = pairs(axes, |x, y| x.eq_ignore_ascii_case("x") && y.eq_ignore_ascii_case("y"))
        && pairs(names, |_, above_y| above_y.is_empty());
    is_header.then(|| names.cells.iter().step_by(2).map(|name| name.as_ref()).collect())
}

/// Reads all datasets of a WebPlotDigitizer export, two columns per dataset.
///
/// Datasets shorter than the longest are padded with empty cells, which are skipped.
fn read_all_datasets(table: &Table, names: Vec<&str>) -> Result<RawFile, Located> {
    let mut datasets: Vec<Dataset> = names
        .into_iter()
        .map(|name| Dataset { name: name.to_owned(), origin: Origin::Zero, points: Vec::new() })
        .collect();
    for row in table.rows.iter().skip(2) {
        for (i, dataset) in datasets.iter_mut().enumerate() {
            let (x, y) = (2 * i, 2 * i + 1);
            if [x, y].iter().all(|&column| row.cells.get(column).is_none_or(|cell| cell.is_empty())) {
                continue;
            }
            dataset.points.push(Point::new(table.number(row, x, "x")?, table.number(row, y, "y")?));
        }
    }
    let dialect = Dialect::WebPlotDigitizerCsv;
    Ok(RawFile { dialect, unit: None, y_may_point_up: true, datasets, scores: None })
}
