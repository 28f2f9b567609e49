use super::cells::{Row, Table};
use super::error::{Located, ReadFault, listed, shortened};
use super::identifier::{best_fits, without_folder};
use super::read::read_file;
use super::{ReadError, text};
use crate::mosaic::{Meridian, RetinalPlace};
use std::collections::HashMap;
use std::path::Path;
use thiserror::Error;

/// Table of what is known about the images of a study, read from a CSV file with a header.
///
/// The first column is an identifier, a part of the file name of an image. All further columns are
/// free, for example subject, eye or diagnosis. Three names have a meaning: `eccentricity_mm` or
/// `eccentricity_deg` (distance from the fovea) and `meridian` (nasal, temporal, superior or
/// inferior, of the retina) state the location of an image on the retina; their cells may be empty.
#[derive(Clone, Debug)]
pub struct Manifest {
    file: String,
    columns: Vec<String>,
    rows: Vec<ManifestRow>,
}

/// Row of a manifest, which describes one image.
#[derive(Clone, Debug, PartialEq)]
pub struct ManifestRow {
    identifier: String,
    /// Cells after the identifier, in the order of [`Manifest::columns`].
    pub labels: Vec<String>,
    eccentricity: Option<Eccentricity>,
    meridian: Option<Meridian>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Eccentricity {
    Millimetres(f64),
    Degrees(f64),
}

/// Error for an image that several rows of a manifest fit equally well.
#[derive(Debug, Error, PartialEq)]
#[error(
    "{manifest}: expected one row for {file_name}, found several that match its name equally well \
     ({candidates}): give one of them a longer identifier"
)]
pub struct AmbiguousRow {
    manifest: String,
    file_name: String,
    candidates: String,
}

impl ManifestRow {
    /// Returns the location of the image on the retina, or `None` if the manifest states no
    /// eccentricity.
    ///
    /// An eccentricity in degrees is converted by `um_per_degree`, micrometres of retina per
    /// degree.
    pub fn place(&self, um_per_degree: f64) -> Option<RetinalPlace> {
        let eccentricity_mm = match self.eccentricity? {
            Eccentricity::Millimetres(mm) => mm,
            Eccentricity::Degrees(degrees) => degrees * um_per_degree / 1e3,
        };
        Some(RetinalPlace { eccentricity_mm, meridian: self.meridian })
    }
}

impl Manifest {
    /// Reads a manifest.
    ///
    /// # Errors
    /// Fails if the file cannot be read; if its header has fewer than two columns, or the same
    /// column twice; if a row has no identifier, an eccentricity that is not a number of at least
    /// 0, or an unknown meridian; or if two rows with the same identifier differ.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let file = path.display().to_string();
        let found = read_file(path).map_err(Located::from).and_then(|bytes| parse(&bytes));
        found
            .map(|(columns, rows)| Self { file: file.clone(), columns, rows })
            .map_err(|located| located.in_file(&file))
    }

    /// Returns the path of the manifest, as passed to [`Self::read`].
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Returns the names of the columns after the identifier.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Returns the row of the image with this file name, or `None` if no row fits.
    ///
    /// A row fits if its identifier is part of the file name, folders not included. The longest
    /// identifier wins; of two equally long ones, the one with which the name begins.
    ///
    /// # Errors
    /// Fails if several rows fit equally well.
    pub fn row_of(&self, file_name: &str) -> Result<Option<&ManifestRow>, AmbiguousRow> {
        let name = without_folder(file_name);
        let winners = best_fits(&self.rows, name, |e| &e.identifier);
        match winners.as_slice() {
            [] => Ok(None),
            [only] => Ok(Some(only)),
            several => Err(AmbiguousRow {
                manifest: self.file.clone(),
                file_name: shortened(name),
                candidates: listed(several.iter().map(|r| r.identifier.as_str())),
            }),
        }
    }
}

/// Indices, from 0, of the columns with names that the program recognises.
struct Meanings {
    /// Column of the eccentricity in mm of retina.
    millimetres: Option<usize>,
    /// Column of the eccentricity in degrees of visual angle.
    degrees: Option<usize>,
    /// Column of the direction from the fovea.
    meridian: Option<usize>,
}

/// Returns the names of the columns after the identifier, and the rows of a manifest.
fn parse(bytes: &[u8]) -> Result<(Vec<String>, Vec<ManifestRow>), Located> {
    const EXPECTED: &str = "a header identifier,COLUMN,… and one row per image";
    let text = text::decode(bytes)?;
    let table = Table::new(&text, EXPECTED)?;
    let Some((header, rows)) = table.rows.split_first() else {
        return Err(ReadFault::Empty { expected: EXPECTED }.into());
    };
    let columns: Vec<String> = header.cells.iter().skip(1).map(|c| c.to_string()).collect();
    if columns.is_empty() || columns.iter().any(String::is_empty) {
        let fault = ReadFault::Header {
            expected: "an identifier and at least one more column",
            found: shortened(header.text),
        };
        return Err(Located::line(header.line, fault));
    }
    for (k, column) in columns.iter().enumerate() {
        if columns[..k].contains(column) {
            let fault = ReadFault::TwoColumns { column: shortened(column), header: shortened(header.text) };
            return Err(Located::line(header.line, fault));
        }
    }
    let find = |names: &[&str]| {
        columns.iter().position(|c| names.iter().any(|n| c.eq_ignore_ascii_case(n))).map(|k| k + 1)
    };
    let meanings = Meanings {
        millimetres: find(&["eccentricity_mm"]),
        degrees: find(&["eccentricity_deg", "eccentricity_degrees"]),
        meridian: find(&["meridian"]),
    };
    let mut seen: HashMap<&str, (&Row, usize)> = HashMap::new();
    let mut found: Vec<ManifestRow> = Vec::with_capacity(rows.len());
    for row in rows {
        let identifier = row.cells.first().map_or("", |cell| cell.as_ref());
        if identifier.is_empty() {
            return Err(Located::line(row.line, ReadFault::NoIdentifier { line: shortened(row.text) }));
        }
        match seen.get(identifier) {
            None => {
                seen.insert(identifier, (row, row.line));
                found.push(meanings.row(&table, row, identifier)?);
            }
            Some((earlier, _)) if earlier.cells == row.cells => {}
            Some(&(_, first_line)) => {
                let fault = ReadFault::TwoRows { identifier: shortened(identifier), first_line };
                return Err(Located::line(row.line, fault));
            }
        }
    }
    Ok((columns, found))
}

impl Meanings {
    /// Reads one row below the header.
    fn row(&self, table: &Table, row: &Row, identifier: &str) -> Result<ManifestRow, Located> {
        let cell = |k: Option<usize>| k.filter(|&k| row.cells.get(k).is_some_and(|c| !c.is_empty()));
        let distance = |k: Option<usize>, name: &'static str| -> Result<Option<f64>, Located> {
            let Some(k) = cell(k) else { return Ok(None) };
            let value = table.number(row, k, name)?;
            if value >= 0. {
                return Ok(Some(value));
            }
            let fault = ReadFault::Eccentricity { column: name, value };
            Err(Located::line(row.line, fault))
        };
        let millimetres = distance(self.millimetres, "eccentricity_mm")?.map(Eccentricity::Millimetres);
        let degrees = distance(self.degrees, "eccentricity_deg")?.map(Eccentricity::Degrees);
        let meridian = match cell(self.meridian) {
            Some(k) => Some(row.cells[k].parse().map_err(|_| {
                Located::line(row.line, ReadFault::Meridian { found: shortened(&row.cells[k]) })
            })?),
            None => None,
        };
        Ok(ManifestRow {
            identifier: identifier.to_owned(),
            labels: row.cells.iter().skip(1).map(|c| c.to_string()).collect(),
            eccentricity: millimetres.or(degrees),
            meridian,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn manifest(text: &str) -> Result<Manifest, String> {
        parse(text.as_bytes())
            .map(|(columns, rows)| Manifest { file: "m.csv".into(), columns, rows })
            .map_err(|located| located.in_file("m.csv").to_string())
    }

    #[test]
    fn rows_belong_to_the_images_whose_name_holds_their_identifier() {
        let text = "identifier,subject,eye,eccentricity_deg,meridian\nAB_1,s1,OD,2,T\nAB_12,s2,OS,,\n";
        let found = manifest(text).unwrap();
        assert_eq!(found.columns(), ["subject", "eye", "eccentricity_deg", "meridian"]);
        let row = found.row_of("x/AB_12_conf.tif").unwrap().unwrap();
        assert_eq!(row.labels, ["s2", "OS", "", ""]);
        assert_eq!(row.place(288.), None);
        let row = found.row_of("AB_1_conf.tif").unwrap().unwrap();
        let place = row.place(288.).unwrap();
        assert!((place.eccentricity_mm - 0.576).abs() < 1e-12 && place.meridian == Some(Meridian::Temporal));
        assert_eq!(found.row_of("CD.tif").unwrap(), None);
        let ambiguous = manifest("id,a\nAB,1\nCD,2\n").unwrap();
        assert!(ambiguous.row_of("x_AB_CD.png").unwrap_err().to_string().contains("AB"));
    }

    #[test]
    fn what_cannot_be_meant_is_refused_with_its_line() {
        let refused = |text: &str, words: &str| {
            let message = manifest(text).unwrap_err();
            assert!(message.contains(words), "{message}");
        };
        refused("", "m.csv");
        refused("id\nA\n", "at least one more column");
        refused("id,a,a\nA,1,2\n", "found two");
        refused("id,eccentricity_mm\nA,1\nB,-1\n", "line 3");
        refused("id,eccentricity_mm\nA,one\n", "eccentricity_mm");
        refused("id,meridian\nA,NT\n", "nasal");
        refused("id,a\nA,1\nA,2\n", "line 3");
        refused("id,a\n,1\n", "line 2");
        assert!(manifest("id,a\nA,1\nA,1\n").is_ok());
    }
}
