use super::cells::{Row, Table};
use super::error::{Located, ReadFault, listed, shortened};
use super::header::{Name, Unit};
use super::identifier::{best_fits, without_folder};
use super::read::read_file;
use super::{Origin, ReadError, ReadOptions, text};
use crate::geometry::Rectangle;
use crate::mosaic::LengthUnit;
use std::collections::HashMap;
use std::path::Path;
use thiserror::Error;

/// Columns that a header should name, for messages.
const EXPECTED: &str = "columns x0, y0, x1, y1 or x, y, width, height (all may end in _px or _um; columns name and \
    file are optional)";

/// Error for boxes that cannot be looked up in a table.
#[derive(Debug, Error)]
pub enum RoiTableError {
    /// Coordinate file to which no row of the table applies.
    #[error(
        "{table}: expected rows for {file_name}, with a part of its name in the column file, found none \
         among {candidates}: add such rows, or leave that cell empty for boxes of every file"
    )]
    Missing {
        /// Path of the table.
        table: String,
        /// Name of the coordinate file, shortened.
        file_name: String,
        /// Cells of the column `file`.
        candidates: String,
    },
    /// Coordinate file that several cells of the column `file` fit equally well.
    #[error(
        "{table}: expected one name in the column file for {file_name}, found several that match equally \
         well ({candidates}): make one of them longer"
    )]
    Ambiguous {
        /// Path of the table.
        table: String,
        /// Name of the coordinate file, shortened.
        file_name: String,
        /// Identifiers that fit equally well.
        candidates: String,
    },
}

/// Rectangular region of interest with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Roi {
    /// Name in the table; without one, the number of the row, from 1.
    pub name: String,
    /// Edges in the unit of the table. Pixels count from 0 at the centre of the top-left pixel.
    pub frame: Rectangle,
}

/// Rectangular regions of interest, read from a CSV table with a header.
///
/// The columns are `x0,y0,x1,y1` (edges) or `x,y,width,height` (upper left corner and sides). They
/// are in the unit of the coordinates or, if they end in `_px` or `_um`, in that unit. A column
/// `name` (or `roi`) names the boxes. A column `file` says to which file a box belongs; where its
/// cell is empty, the box applies to every file.
#[derive(Clone, Debug)]
pub struct RoiTable {
    file: String,
    unit: Option<LengthUnit>,
    entries: Vec<Entry>,
}

#[derive(Clone, Debug)]
struct Entry {
    /// Part of the names of the files to which the box applies; empty for every file.
    identifier: String,
    roi: Roi,
}

impl RoiTable {
    /// Reads a table of regions; `options` has its origin and the direction of y, as for
    /// coordinates.
    ///
    /// # Errors
    /// Fails if the file cannot be read, lacks a header or rows, a row has no box or a box has no
    /// area, or two boxes of one file have the same name.
    pub fn read(path: &Path, options: &ReadOptions) -> Result<Self, ReadError> {
        let file = path.display().to_string();
        let read = || -> Result<Self, Located> {
            options.validate()?;
            let (unit, entries) = entries(&read_file(path)?, options)?;
            Ok(Self { file: file.clone(), unit, entries })
        };
        read().map_err(|located| located.in_file(&file))
    }

    /// Returns the path of the table, as passed to [`Self::read`].
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Returns the unit that the header names, or `None` if it names none.
    pub const fn unit(&self) -> Option<LengthUnit> {
        self.unit
    }

    /// Returns the boxes of the file called `file_name`, in the order of the table.
    ///
    /// Boxes whose cell in the column `file` is empty are always returned. Of the other cells, the
    /// longest that is part of the file name, folders not included, selects further boxes. Of two
    /// equally long cells, the one with which the name begins wins.
    ///
    /// # Errors
    /// Fails if no row fits, or several identifiers fit equally well.
    pub fn boxes_of(&self, file_name: &str) -> Result<Vec<&Roi>, RoiTableError> {
        let name = without_folder(file_name);
        let fitting = best_fits(&self.entries, name, |e| &e.identifier);
        let mut winners: Vec<&str> = fitting
            .iter()
            .map(|e| e.identifier.as_str())
            .filter(|identifier| !identifier.is_empty())
            .collect();
        winners.sort_unstable();
        winners.dedup();
        if winners.len() > 1 {
            return Err(RoiTableError::Ambiguous {
                table: self.file.clone(),
                file_name: shortened(name),
                candidates: listed(winners.into_iter()),
            });
        }
        let chosen = |e: &&Entry| e.identifier.is_empty() || winners.first() == Some(&e.identifier.as_str());
        let boxes: Vec<&Roi> = self.entries.iter().filter(chosen).map(|e| &e.roi).collect();
        if boxes.is_empty() {
            let mut candidates: Vec<&str> = self.entries.iter().map(|e| e.identifier.as_str()).collect();
            candidates.dedup();
            return Err(RoiTableError::Missing {
                table: self.file.clone(),
                file_name: shortened(name),
                candidates: listed(candidates.into_iter()),
            });
        }
        Ok(boxes)
    }
}

/// Indices, from 0, of the columns of a table of regions.
struct Columns {
    /// Indices of the four columns of numbers.
    numbers: [usize; 4],
    /// Names of these four columns without a unit, for errors.
    labels: [&'static str; 4],
    /// `true` if the third and fourth number are sides and not edges.
    sides: bool,
    name: Option<usize>,
    file: Option<usize>,
    unit: Option<LengthUnit>,
}

impl Columns {
    /// Finds the columns of boxes in a header; edges are preferred to sides, and columns in px to
    /// other units.
    fn named_in(header: &Row) -> Result<Self, Located> {
        let names: Vec<Name> = header.cells.iter().map(|cell| Name::parse(cell)).collect();
        let find = |stem: &str, unit: Unit| names.iter().position(|n| n.stem == stem && n.unit == unit);
        let bare = Unit::Is(None);
        let all = |labels: [&'static str; 4], unit: Option<LengthUnit>| {
            let found = labels.map(|label| find(label, Unit::Is(unit)));
            let [a, b, c, d] = found;
            Some([a?, b?, c?, d?])
        };
        const LAYOUTS: [([&str; 4], bool); 2] =
            [(["x0", "y0", "x1", "y1"], false), (["x", "y", "width", "height"], true)];
        const UNITS: [Option<LengthUnit>; 4] =
            [Some(LengthUnit::Pixel), None, Some(LengthUnit::Micrometre), Some(LengthUnit::Unit)];
        for (labels, sides) in LAYOUTS {
            for unit in UNITS {
                if let Some(numbers) = all(labels, unit) {
                    let name = find("name", bare).or_else(|| find("roi", bare));
                    return Ok(Self { numbers, labels, sides, name, file: find("file", bare), unit });
                }
            }
        }
        let fault = ReadFault::Header { expected: EXPECTED, found: shortened(header.text) };
        Err(Located::line(header.line, fault))
    }
}

/// Returns the unit that the header names, and the boxes in the order of the table.
fn entries(bytes: &[u8], options: &ReadOptions) -> Result<(Option<LengthUnit>, Vec<Entry>), Located> {
    const ROWS: &str = "a header and rows of boxes";
    let text = text::decode(bytes)?;
    let table = Table::new(&text, ROWS)?;
    let Some((header, rows)) = table.rows.split_first() else {
        return Err(ReadFault::Empty { expected: ROWS }.into());
    };
    let columns = Columns::named_in(header)?;
    if rows.is_empty() {
        return Err(ReadFault::Empty { expected: ROWS }.into());
    }
    let pixels = matches!(columns.unit, None | Some(LengthUnit::Pixel));
    if let (Some(origin @ (Origin::Half | Origin::One)), Some(unit), false) =
        (options.origin, columns.unit, pixels)
    {
        return Err(ReadFault::OriginWithoutPixels { origin, unit: unit.symbol() }.into());
    }
    let from = if pixels { options.origin.unwrap_or_default().value() } else { 0. };
    // If y points up, 0 is the centre of the bottom row of pixels, which is at height − 1 when y
    // points down. Coordinate files are converted in the same way.
    let top = if pixels { 1. } else { 0. };
    let mut seen: HashMap<(String, String), usize> = HashMap::new();
    let mut entries = Vec::with_capacity(rows.len());
    for (k, row) in rows.iter().enumerate() {
        let text_of = |column: Option<usize>| {
            column.and_then(|c| row.cells.get(c)).map(|cell| cell.to_string()).unwrap_or_default()
        };
        let (identifier, mut name) = (text_of(columns.file), text_of(columns.name));
        if name.is_empty() {
            name = (k + 1).to_string();
        }
        let mut numbers = [0.; 4];
        for (number, (&column, label)) in numbers.iter_mut().zip(columns.numbers.iter().zip(columns.labels)) {
            *number = table.number(row, column, label)?;
        }
        let [x0, y0, x1, y1] = numbers;
        let [x1, y1] = if columns.sides { [x0 + x1, y0 + y1] } else { [x1, y1] };
        let [x0, y0, x1, y1] = [x0, y0, x1, y1].map(|v| v - from);
        let [y0, y1] = options.flip_y.map_or([y0, y1], |height| [height - top - y1, height - top - y0]);
        let frame = Rectangle::new(x0, y0, x1, y1)
            .map_err(|_| Located::line(row.line, ReadFault::NoBox { line: shortened(row.text) }))?;
        if let Some(&first_line) = seen.get(&(identifier.clone(), name.clone())) {
            let fault = ReadFault::TwoBoxes { name: shortened(&name), first_line };
            return Err(Located::line(row.line, fault));
        }
        seen.insert((identifier.clone(), name.clone()), row.line);
        entries.push(Entry { identifier, roi: Roi { name, frame } });
    }
    Ok((columns.unit, entries))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table_with(text: &str, options: &ReadOptions) -> Result<RoiTable, Located> {
        let (unit, entries) = entries(text.as_bytes(), options)?;
        Ok(RoiTable { file: "rois.csv".into(), unit, entries })
    }

    fn table(text: &str) -> Result<RoiTable, Located> {
        table_with(text, &ReadOptions::default())
    }

    fn names(table: &RoiTable, file: &str) -> Vec<String> {
        table.boxes_of(file).unwrap().into_iter().map(|b| b.name.clone()).collect()
    }

    #[test]
    fn edges_and_sides_say_the_same() {
        let expected = Rectangle::new(1., 2., 11., 22.5).unwrap();
        for text in [
            "name,x0,y0,x1,y1\nA,1,2,11,22.5\n",
            "x,y,width,height,name\n1,2,10,20.5,A\n",
            "ROI;X0_px;Y0_px;X1_px;Y1_px\nA;1;2;11;22,5\n",
            "name\tx (µm)\ty (µm)\twidth (µm)\theight (µm)\nA\t1\t2\t10\t20.5\n",
        ] {
            let table = table(text).unwrap();
            let boxes = table.boxes_of("any.csv").unwrap();
            assert_eq!((boxes.len(), boxes[0].frame, boxes[0].name.as_str()), (1, expected, "A"), "{text}");
        }
        assert_eq!(table("x0_um,y0_um,x1_um,y1_um\n1,2,3,4\n").unwrap().unit(), Some(LengthUnit::Micrometre));
    }

    #[test]
    fn boxes_count_from_where_coordinates_do() {
        let options = ReadOptions { origin: Some(Origin::One), ..ReadOptions::default() };
        let found = table_with("x0,y0,x1,y1\n1,2,11,22\n", &options).unwrap();
        assert_eq!(found.boxes_of("a").unwrap()[0].frame, Rectangle::new(0., 1., 10., 21.).unwrap());
        let options = ReadOptions { flip_y: Some(100.), ..ReadOptions::default() };
        let found = table_with("x,y,width,height\n1,2,10,20\n", &options).unwrap();
        assert_eq!(found.boxes_of("a").unwrap()[0].frame, Rectangle::new(1., 77., 11., 97.).unwrap());
        let options = ReadOptions { origin: Some(Origin::One), ..ReadOptions::default() };
        assert!(table_with("x0_um,y0_um,x1_um,y1_um\n1,2,3,4\n", &options).is_err());
    }

    #[test]
    fn the_longest_part_of_a_name_gives_a_file_its_boxes() {
        let text = "file,x0,y0,x1,y1\nAD,0,0,1,1\nAD_10,0,0,2,2\nAD_10,0,0,3,3\n,0,0,4,4\nleft,0,0,5,5\nAD_9_,0,0,6,6\n";
        let table = table(text).unwrap();
        assert_eq!(names(&table, "AD_10_OS.csv"), ["2", "3", "4"]);
        assert_eq!(names(&table, "AD_2.csv"), ["1", "4"]);
        assert_eq!(names(&table, "folder_AD/JC.csv"), ["4"]);
        // of equally long parts the beginning counts
        assert_eq!(names(&table, "AD_10_AD_9_.csv"), ["2", "3", "4"]);
        let none = self::table("file,x0,y0,x1,y1\nAD,0,0,1,1\nJC,0,0,1,1\n").unwrap();
        let missing = none.boxes_of("NC.csv").unwrap_err().to_string();
        assert!(missing.contains("“AD”, “JC”") && missing.contains("NC.csv"), "{missing}");
        let ambiguous = none.boxes_of("x_AD_JC.csv").unwrap_err();
        assert!(matches!(ambiguous, RoiTableError::Ambiguous { .. }), "{ambiguous}");
    }

    #[test]
    fn broken_rows_say_their_line() {
        for (text, line, part) in [
            ("name,x0,y0,x1,y1\nA,0,0,1,1\nA,0,0,2,2\n", 3, "line 2"),
            ("x0,y0,x1,y1\n0,0,1,1\n\n0,0,1,x\n", 4, "y1"),
            ("x0,y0,x1,y1\n3,0,1,1\n", 2, "area"),
            ("x,y,width,height\n3,0,0,1\n", 2, "area"),
            ("x,y,width,height\n3,0,-2,1\n", 2, "area"),
            ("x,y\n3,0\n", 1, "width"),
            ("0,0,1,1\n", 1, "x0, y0"),
            ("x0,y0,x1,y1\n0,0,1\n", 2, "cells"),
        ] {
            let error = table(text).unwrap_err().in_file("rois.csv").to_string();
            assert!(
                error.starts_with(&format!("rois.csv, line {line}: ")) && error.contains(part),
                "{text}: {error}"
            );
        }
        assert!(table("x0,y0,x1,y1\n").is_err() && table("").is_err());
    }
}
