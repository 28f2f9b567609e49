use super::BatchError;
use crate::image::extensions;
use std::collections::BTreeMap;
use std::path::Path;

/// Columns that name images or say how they were taken rather than measure them.
const NO_MEASURE: [&str; 6] =
    ["width_px", "height_px", "um_per_px", "um_per_unit", "um_per_degree", "eccentricity_mm"];

/// Numbers of the same images by one grader, session or program: a `summary.csv`, or any CSV with a column `name` or `file`.
pub(super) struct Readings {
    /// What it is called.
    pub label: String,
    /// Names of all columns.
    pub columns: Vec<String>,
    /// By image, the value of every column; `None` where it is no number.
    pub items: BTreeMap<String, Vec<Option<f64>>>,
}

impl Readings {
    /// From a table, or a folder that holds a `summary.csv`.
    ///
    /// # Errors
    /// If it cannot be read, no column names the images, or an image stands in it twice.
    pub fn read(path: &Path) -> Result<Self, BatchError> {
        let inside = path.join("summary.csv");
        let file = if path.is_dir() { &inside } else { path };
        let fail = |problem: String| BatchError::Tables(format!("{}: {problem}", file.display()));
        let bytes = std::fs::read(file).map_err(|e| {
            fail(format!("cannot be read ({e}): give a summary.csv, or a folder that holds one"))
        })?;
        let mut reader =
            csv::ReaderBuilder::new().from_reader(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes));
        let header: Vec<String> = reader
            .headers()
            .map_err(|e| fail(format!("is no CSV: {e}")))?
            .iter()
            .map(|h| h.trim().to_owned())
            .collect();
        let key =
            ["name", "file", "image", "identifier"].iter().find_map(|n| header.iter().position(|h| h == n));
        let Some(key) = key else {
            return Err(fail(
                "expected a column name or file that names the images, found none: add it to the header"
                    .into(),
            ));
        };
        let mut items: BTreeMap<String, Vec<Option<f64>>> = BTreeMap::new();
        for (k, row) in reader.records().enumerate() {
            let line = k + 2;
            let row = row.map_err(|e| fail(format!("line {line} cannot be read: {e}")))?;
            let name = row.get(key).unwrap_or_default().trim();
            let base = name.rsplit(['/', '\\']).next().unwrap_or(name);
            let known = ["csv", "txt", "json", "roi", "zip", "tsv", "tar"].into_iter().chain(extensions());
            let lower = base.to_lowercase();
            let ending = |e: &str| lower.strip_suffix(e).is_some_and(|rest| rest.ends_with('.'));
            let ending = known.into_iter().find(|e| ending(e)).map_or(0, |e| e.len() + 1);
            let item = base[..base.len() - ending].trim_end_matches("_coords").to_owned();
            if item.is_empty() {
                return Err(fail(format!("line {line} names no image: fill column {}", header[key])));
            }
            let values = row.iter().map(|c| c.trim().parse().ok().filter(|v: &f64| v.is_finite())).collect();
            if items.insert(item.clone(), values).is_some() {
                return Err(fail(format!(
                    "line {line}: {item} stands in the table twice: keep one row an image"
                )));
            }
        }
        let folder =
            path.is_dir().then_some(path).or_else(|| path.parent().filter(|_| path.ends_with("summary.csv")));
        let named = folder.and_then(Path::file_name).or_else(|| path.file_stem()).unwrap_or(path.as_os_str());
        Ok(Self { label: named.to_string_lossy().into_owned(), columns: header, items })
    }

    /// What it has for an image; `None` where it has none or no number.
    pub fn value(&self, item: &str, column: &str) -> Option<f64> {
        let k = self.columns.iter().position(|c| c == column)?;
        self.items.get(item)?.get(k).copied().flatten()
    }
}

/// The columns asked for, or all that hold numbers in every table.
pub(super) fn chosen_columns(readings: &[Readings], asked: &[String]) -> Result<Vec<String>, BatchError> {
    for column in asked {
        if let Some(lacking) = readings.iter().find(|r| !r.columns.contains(column)) {
            return Err(BatchError::Tables(format!(
                "{} has no column {column}: it has {}",
                lacking.label,
                lacking.columns.join(", ")
            )));
        }
    }
    if !asked.is_empty() {
        return Ok(asked.to_vec());
    }
    let numbers = |r: &Readings, column: &String| {
        r.columns
            .iter()
            .position(|c| c == column)
            .is_some_and(|k| r.items.values().any(|v| v.get(k).copied().flatten().is_some()))
    };
    let first = readings.first().map_or(&[][..], |r| &r.columns);
    Ok(first
        .iter()
        .filter(|c| !NO_MEASURE.contains(&c.as_str()) && readings.iter().all(|r| numbers(r, c)))
        .cloned()
        .collect())
}
