use super::cells::{Row, Table};
use super::error::{Located, ReadFault, listed, shortened};
use super::identifier::{best_fits, without_folder};
use super::read::read_file;
use super::{ReadError, text};
use crate::mosaic::{Scale, micrometres_per_degree};
use std::collections::HashMap;
use std::path::Path;
use thiserror::Error;

/// Error for a scale that cannot be looked up in a table.
#[derive(Debug, Error)]
pub enum ScaleTableError {
    /// Table that cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// File name of which no identifier of the table is a part.
    #[error(
        "{table}: expected a row whose identifier is part of {file_name}, found none among {candidates}: add a row, \
         or let files without a row stay in pixels"
    )]
    Missing {
        /// Path of the table.
        table: String,
        /// File name of the image, shortened.
        file_name: String,
        /// Identifiers in the table, the first few of many.
        candidates: String,
    },
    /// File name that several identifiers fit equally well.
    #[error(
        "{table}: expected one row for {file_name}, found several that match its name equally well \
         ({candidates}): give one of them a longer identifier"
    )]
    Ambiguous {
        /// Path of the table.
        table: String,
        /// File name of the image, shortened.
        file_name: String,
        /// Identifiers that fit equally well.
        candidates: String,
    },
}

/// Scales of a folder of images, read from a CSV table.
///
/// The columns are `identifier,um_per_px` or `identifier,axial_length_mm,pixels_per_degree`, with
/// or without a header. With a header, the identifier is still the first column, the other columns
/// are found by name, and `axial_length_mm` may be missing (average eye).
#[derive(Clone, Debug)]
pub struct ScaleTable {
    file: String,
    entries: Vec<Entry>,
}

#[derive(Clone, Debug)]
struct Entry {
    identifier: String,
    scale: Scale,
}

/// Columns, counted from 0, from which the scale of a row is computed.
#[derive(Clone, Copy)]
enum Quantity {
    MicrometresPerPixel(usize),
    PixelsPerDegree { axial_length: Option<usize>, pixels: usize },
}

impl ScaleTable {
    /// Reads a table of scales.
    ///
    /// `um_per_degree`, micrometres of retina per degree, applies to rows without an axial length.
    /// Rows with an axial length use the value of [`micrometres_per_degree`].
    ///
    /// # Errors
    /// Fails if the file cannot be read, a row lacks its identifier or a positive number, or two
    /// rows give the same identifier different scales.
    pub fn read(path: &Path, um_per_degree: f64) -> Result<Self, ReadError> {
        let file = path.display().to_string();
        let entries = read_file(path).map_err(Located::from).and_then(|bytes| entries(&bytes, um_per_degree));
        entries.map(|entries| Self { file: file.clone(), entries }).map_err(|located| located.in_file(&file))
    }

    /// Returns the scale of the image with this file name.
    ///
    /// A row fits if its identifier is part of the file name, folders not included. The longest
    /// identifier wins; of two equally long ones, the one with which the name begins.
    ///
    /// # Errors
    /// Fails if no row fits, or several fit equally well.
    pub fn scale_for(&self, file_name: &str) -> Result<Scale, ScaleTableError> {
        let name = without_folder(file_name);
        let winners = best_fits(&self.entries, name, |e| &e.identifier);
        match winners.as_slice() {
            [only] => Ok(only.scale),
            [] => Err(ScaleTableError::Missing {
                table: self.file.clone(),
                file_name: shortened(name),
                candidates: listed(self.entries.iter().map(|e| e.identifier.as_str())),
            }),
            _ => Err(ScaleTableError::Ambiguous {
                table: self.file.clone(),
                file_name: shortened(name),
                candidates: listed(winners.iter().map(|e| e.identifier.as_str())),
            }),
        }
    }

    /// Returns the number of identifiers.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Returns whether the table has no identifiers.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }
}

/// Returns the identifiers and scales in the order of the table.
fn entries(bytes: &[u8], um_per_degree: f64) -> Result<Vec<Entry>, Located> {
    let text = text::decode(bytes)?;
    let table =
        Table::new(&text, "rows of identifier,um_per_px or identifier,axial_length_mm,pixels_per_degree")?;
    let Some((first, rest)) = table.rows.split_first() else { return Ok(Vec::new()) };
    let has_header = first.cells.len() > 1 && !first.cells.iter().skip(1).any(|cell| table.is_number(cell));
    let (quantity, rows) = if has_header {
        (Quantity::named_in(first)?, rest)
    } else {
        (Quantity::by_count(first)?, table.rows.as_slice())
    };
    let mut seen: HashMap<&str, (Scale, usize)> = HashMap::new();
    let mut entries: Vec<Entry> = Vec::with_capacity(rows.len());
    for row in rows {
        let identifier = row.cells.first().map_or("", |cell| cell.as_ref());
        if identifier.is_empty() {
            return Err(Located::line(row.line, ReadFault::NoIdentifier { line: shortened(row.text) }));
        }
        let scale = quantity.read(&table, row, um_per_degree)?;
        match seen.get(identifier) {
            None => {
                seen.insert(identifier, (scale, row.line));
                entries.push(Entry { identifier: identifier.to_owned(), scale });
            }
            Some((earlier, _)) if *earlier == scale => {}
            Some(&(_, first_line)) => {
                let fault = ReadFault::TwoScales { identifier: shortened(identifier), first_line };
                return Err(Located::line(row.line, fault));
            }
        }
    }
    Ok(entries)
}

impl Quantity {
    /// Chooses the columns in a table without a header by the number of cells in a row.
    fn by_count(row: &Row) -> Result<Self, Located> {
        match row.cells.len() {
            2 => Ok(Self::MicrometresPerPixel(1)),
            3 => Ok(Self::PixelsPerDegree { axial_length: Some(1), pixels: 2 }),
            _ => Err(Self::unclear(row)),
        }
    }

    /// Finds the columns by their names in a header.
    fn named_in(header: &Row) -> Result<Self, Located> {
        let find = |name: &str| {
            header.cells.iter().skip(1).position(|c| c.eq_ignore_ascii_case(name)).map(|i| i + 1)
        };
        match (find("um_per_px"), find("pixels_per_degree")) {
            (Some(column), None) => Ok(Self::MicrometresPerPixel(column)),
            (None, Some(pixels)) => {
                Ok(Self::PixelsPerDegree { axial_length: find("axial_length_mm"), pixels })
            }
            _ => Err(Self::unclear(header)),
        }
    }

    /// Returns the error for a row from which the columns cannot be told.
    fn unclear(row: &Row) -> Located {
        let fault = ReadFault::Header {
            expected: "identifier,um_per_px or identifier,axial_length_mm,pixels_per_degree",
            found: shortened(row.text),
        };
        Located::line(row.line, fault)
    }

    /// Reads the scale in one row.
    fn read(self, table: &Table, row: &Row, um_per_degree: f64) -> Result<Scale, Located> {
        let scale = match self {
            Self::MicrometresPerPixel(column) => {
                Scale::new(table.number(row, column, "um_per_px")?, um_per_degree)
            }
            Self::PixelsPerDegree { axial_length, pixels } => {
                let pixels = table.number(row, pixels, "pixels_per_degree")?;
                let per_degree = match axial_length {
                    Some(column) => micrometres_per_degree(table.number(row, column, "axial_length_mm")?),
                    None => Ok(um_per_degree),
                };
                per_degree.and_then(|um| Scale::from_pixels_per_degree(pixels, um))
            }
        };
        scale.map_err(|e| Located::line(row.line, e.into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Result<ScaleTable, Located> {
        Ok(ScaleTable { file: "scales.csv".into(), entries: entries(text.as_bytes(), 288.)? })
    }

    fn scale(text: &str, name: &str) -> f64 {
        table(text).unwrap().scale_for(name).unwrap().micrometres_per_pixel()
    }

    #[test]
    fn the_longest_identifier_wins_and_a_prefix_beats_an_equally_long_part() {
        let text = "JC,1\nJC_0007,2\nleft,3\nfoo_,4\n";
        assert_eq!(scale(text, "JC_0007_BL_0.08.png"), 2.);
        assert_eq!(scale(text, "JC_0008.png"), 1.);
        assert_eq!(scale(text, "JC_left.png"), 3.);
        assert_eq!(scale(text, "foo_left.png"), 4.);
        assert_eq!(scale(text, "left/JC_0001.png"), 1.);
    }

    #[test]
    fn every_layout_of_a_table_is_understood() {
        assert_eq!(scale("identifier,um_per_px\nA,0.5\n", "A1"), 0.5);
        assert_eq!(scale("identifier;um_per_px\r\nA;0,5\r\n", "A1"), 0.5);
        assert_eq!(scale("A,24,582\n", "A1"), 0.5);
        assert_eq!(scale("subject,eye,pixels_per_degree,axial_length_mm\nA,left,582,24\n", "A1"), 0.5);
        assert_eq!(scale("subject,pixels_per_degree\nA,576\n", "A1"), 0.5);
        assert_eq!(scale("2023,0.5\n", "20230415.png"), 0.5);
    }

    #[test]
    fn missing_and_ambiguous_rows_list_the_candidates() {
        let table = table("left,1\nfoo_,2\n").unwrap();
        let missing = table.scale_for("right.png").unwrap_err();
        assert!(matches!(missing, ScaleTableError::Missing { .. }));
        assert!(missing.to_string().contains("“left”, “foo_”"), "{missing}");
        let ambiguous = table.scale_for("a_foo_left.png").unwrap_err();
        assert!(matches!(ambiguous, ScaleTableError::Ambiguous { .. }), "{ambiguous}");
    }

    #[test]
    fn broken_rows_say_their_line() {
        for (text, line, part) in [
            ("A,1\n# note\nA,2\n", 3, "line 1"),
            ("A,1\nB,x\n", 2, "“x”"),
            ("A,1\nB,-1\n", 2, "-1"),
            ("A,1\n,2\n", 2, "identifier"),
            ("A,1,2,3\n", 1, "um_per_px"),
            ("name,size\nA,1\n", 1, "um_per_px"),
            ("A\n", 1, "um_per_px"),
        ] {
            let error = table(text).unwrap_err().in_file("scales.csv").to_string();
            assert!(
                error.starts_with(&format!("scales.csv, line {line}: ")) && error.contains(part),
                "{error}"
            );
        }
        assert_eq!(table("A,1\nA,1.0\n").unwrap().len(), 1);
    }

    #[test]
    fn every_image_of_the_reference_data_has_one_scale() {
        for folder in ["confocal", "split"] {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/aoslo").join(folder);
            let Ok(files) = std::fs::read_dir(&folder) else {
                println!("SKIPPED scales of the reference data: ../shared is not here");
                return;
            };
            let table = ScaleTable::read(&folder.join("scale_um_per_px.csv"), 288.).unwrap();
            let names = files.map(|f| f.unwrap().file_name().into_string().unwrap());
            let scales: Vec<_> = names.filter(|n| n.ends_with(".png")).map(|n| table.scale_for(&n)).collect();
            assert!(scales.len() > 100);
            for scale in scales {
                assert!((0.2..1.).contains(&scale.unwrap().micrometres_per_pixel()));
            }
        }
    }
}
