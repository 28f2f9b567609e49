use crate::batch::BatchError;
use crate::image::extensions;
use crate::report::{ColumnNames, column_names};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Columns whose numbers describe how an image was taken. They are no measurements, so they are not
/// compared unless the user names them.
const NO_MEASURE: [&str; 6] =
    ["width_px", "height_px", "um_per_px", "um_per_unit", "um_per_degree", "eccentricity_mm"];

/// Table of numbers that one grader, session or program measured on a set of images.
///
/// Read from a `summary.csv`, or from any CSV with a column `name`, `file`, `image` or
/// `identifier`.
pub(in crate::batch) struct Readings {
    /// Name of the grader: the name of the folder or file that was read.
    pub label: String,
    /// Names of all columns of the table.
    pub columns: Vec<String>,
    /// Unit of the coordinates; `None` unless the table states the same unit in every row.
    pub unit: Option<String>,
    /// Values of one row per image, in the order of `columns`, with the name of the image as key. A
    /// value is `None` if its cell has no number.
    pub items: BTreeMap<String, Vec<Option<f64>>>,
}

impl Readings {
    /// Reads a table, or the `summary.csv` in a folder.
    ///
    /// # Errors
    /// Fails if the table cannot be read, no column names the images, or an image has two rows.
    pub fn read(path: &Path) -> Result<Self, BatchError> {
        let inside = path.join("summary.csv");
        let file = if path.is_dir() { &inside } else { path };
        let fail = |problem: String| BatchError::Tables(format!("{}: {problem}", file.display()));
        let bytes = std::fs::read(file).map_err(|e| {
            fail(format!("cannot be read ({e}): give a summary.csv, or a folder that contains one"))
        })?;
        let mut reader =
            csv::ReaderBuilder::new().from_reader(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes));
        let header: Vec<String> = reader
            .headers()
            .map_err(|e| fail(format!("is not a CSV file ({e}): save the table as CSV")))?
            .iter()
            .map(|h| h.trim().to_owned())
            .collect();
        let key =
            ["name", "file", "image", "identifier"].iter().find_map(|n| header.iter().position(|h| h == n));
        let Some(key) = key else {
            return Err(fail(
                "expected a column with the names of the images (name, file, image or identifier), found \
                 none: add one"
                    .into(),
            ));
        };
        let unit_column = header.iter().position(|h| h == "unit");
        let mut units = BTreeSet::new();
        let mut items: BTreeMap<String, Vec<Option<f64>>> = BTreeMap::new();
        for (k, row) in reader.records().enumerate() {
            // lines count from 1, and line 1 is the header
            let line = k + 2;
            let row = row.map_err(|e| fail(format!("line {line}: cannot be read ({e}): correct the row")))?;
            let name = row.get(key).unwrap_or_default().trim();
            let base = name.rsplit(['/', '\\']).next().unwrap_or(name);
            let known = ["csv", "txt", "json", "roi", "zip", "tsv", "tar"].into_iter().chain(extensions());
            let lower = base.to_lowercase();
            let ending = |e: &str| lower.strip_suffix(e).is_some_and(|rest| rest.ends_with('.'));
            let ending = known.into_iter().find(|e| ending(e)).map_or(0, |e| e.len() + 1);
            let item = base[..base.len() - ending].trim_end_matches("_coords").to_owned();
            if item.is_empty() {
                return Err(fail(format!(
                    "line {line}: expected the name of an image in column {}, found an empty cell: fill it \
                     in",
                    header[key]
                )));
            }
            units.extend(unit_column.and_then(|u| row.get(u)).map(|u| u.trim().to_owned()));
            let values = row.iter().map(|c| c.trim().parse().ok().filter(|v: &f64| v.is_finite())).collect();
            if items.insert(item.clone(), values).is_some() {
                return Err(fail(format!(
                    "line {line}: expected one row per image, found a second one for {item}: keep only the \
                     right one"
                )));
            }
        }
        let folder =
            path.is_dir().then_some(path).or_else(|| path.parent().filter(|_| path.ends_with("summary.csv")));
        let named = folder.and_then(Path::file_name).or_else(|| path.file_stem()).unwrap_or(path.as_os_str());
        let unit = units.pop_first().filter(|_| units.is_empty());
        Ok(Self { label: named.to_string_lossy().into_owned(), columns: header, unit, items })
    }

    /// Returns whether any image has a number in a column.
    fn has_numbers(&self, column: &str) -> bool {
        let k = self.columns.iter().position(|c| c == column);
        k.is_some_and(|k| self.items.values().any(|v| v.get(k).copied().flatten().is_some()))
    }

    /// Returns the first of `names` under which this table has a column with numbers.
    ///
    /// `names` are names of the same quantity. Those without a unit are tried only if the
    /// coordinates of the table are in px.
    fn name_of(&self, names: &ColumnNames) -> Option<String> {
        let pixels = self.unit.as_deref() == Some("px");
        let plain = names.in_pixels.iter().copied().filter(|_| pixels);
        let mut all = names.suffixed.iter().map(String::as_str).chain(plain);
        all.find(|name| self.has_numbers(name)).map(str::to_owned)
    }

    /// Returns the value of an image in a column; `None` if the image has no row or the cell has no
    /// number.
    pub fn value(&self, item: &str, column: &str) -> Option<f64> {
        let k = self.columns.iter().position(|c| c == column)?;
        self.items.get(item)?.get(k).copied().flatten()
    }
}

/// A column to compare, with its name in each table.
#[derive(Clone, Debug)]
pub(in crate::batch) struct Chosen {
    /// Name of the column in the results. It includes the unit if the tables use different names
    /// for the column.
    pub name: String,
    /// Name of the column in each table, in the order of the tables.
    pub named: Vec<String>,
}

/// Returns the columns in `asked`; if `asked` is empty, all columns that have numbers in every
/// table.
///
/// A column may have a different name in each table. For `density`, for example, the column
/// `density_per_px2` is found, or that in any other unit that all tables have. For a name that a
/// column had in an earlier version of the program, the column is found under its current name.
///
/// # Errors
/// Fails if a column asked for is missing from a table, or if the tables have it in no common unit.
pub(in crate::batch) fn chosen_columns(
    readings: &[Readings],
    asked: &[String],
) -> Result<Vec<Chosen>, BatchError> {
    if !asked.is_empty() {
        return asked.iter().map(|column| resolved(readings, column)).collect();
    }
    let first = readings.first().map_or(&[][..], |r| &r.columns);
    let numbers = |column: &&String| readings.iter().all(|r| r.has_numbers(column));
    let common = first.iter().filter(|c| !NO_MEASURE.contains(&c.as_str()));
    let common: Vec<&String> = common.filter(numbers).collect();
    // a column in the unit of the coordinates adds nothing to a column of the same quantity that
    // names its unit
    let twice = |column: &String| {
        let names = column_names(column);
        names.len() > 1 && names.iter().any(|n| common.contains(&&n.name))
    };
    let kept = common.iter().filter(|column| !twice(column));
    Ok(kept.map(|column| literal(readings, column)).collect())
}

/// Returns the entry for a column that has the same name in every table.
fn literal(readings: &[Readings], column: &str) -> Chosen {
    Chosen { name: column.to_owned(), named: vec![column.to_owned(); readings.len()] }
}

/// Finds the column `asked` in every table, in the same unit in all of them.
fn resolved(readings: &[Readings], asked: &str) -> Result<Chosen, BatchError> {
    let candidates = column_names(asked);
    let has = |r: &&Readings| r.columns.iter().any(|c| c == asked);
    // a length without a unit means the same in all tables only if their coordinates share a unit
    let units: BTreeSet<Option<&str>> = readings.iter().map(|r| r.unit.as_deref()).collect();
    if readings.iter().all(|r| has(&r)) && (candidates.len() < 2 || units.len() < 2) {
        return Ok(literal(readings, asked));
    }
    let in_all = |names: &ColumnNames| {
        let named: Option<Vec<String>> = readings.iter().map(|r| r.name_of(names)).collect();
        Some(Chosen { name: names.name.clone(), named: named? })
    };
    if let Some(found) = candidates.iter().find_map(in_all) {
        return Ok(found);
    }
    let lacks = |r: &&Readings| !candidates.iter().any(|names| r.name_of(names).is_some());
    match readings.iter().find(|r| !has(r) && lacks(r)) {
        Some(r) => Err(BatchError::Tables(format!(
            "{} has no column {asked}: choose from {}",
            r.label,
            r.columns.join(", ")
        ))),
        None => Err(BatchError::Tables(format!(
            "the tables give {asked} in different units: measure all mosaics in px, or all with a scale"
        ))),
    }
}
