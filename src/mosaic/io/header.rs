use super::cells::Row;
use super::error::{Located, ReadFault, shortened};
use crate::mosaic::LengthUnit;

/// Indices, from 0, of the columns of a coordinate table.
#[derive(Debug, PartialEq)]
pub(super) struct Columns {
    /// Index of the column of x.
    pub x: usize,
    /// Index of the column of y.
    pub y: usize,
    /// Index of the column of scores, if there is one.
    pub score: Option<usize>,
    /// Unit that the header names.
    pub unit: Option<LengthUnit>,
}

/// Names of the columns of x, each with that of y, in order of preference.
///
/// `XM` and `YM` are ImageJ's centre of mass; for points they equal X and Y, which are preferred in
/// a file that has all four.
const STEMS: [(&str, &str); 2] = [("x", "y"), ("xm", "ym")];

/// Units of the columns of coordinates, in order of preference; `None` stands for a column that
/// names no unit.
///
/// Pixels come first as they need no scale, and a file that names them is explicit about them.
const UNITS: [Option<LengthUnit>; 4] =
    [Some(LengthUnit::Pixel), None, Some(LengthUnit::Micrometre), Some(LengthUnit::Unit)];

/// Names that programs use for the score of a point, in order of preference.
const SCORES: [&str; 3] = ["score", "confidence", "probability"];

impl Columns {
    /// Columns of a file without a header: x is in the first column and y in the second.
    pub const FIRST_TWO: Self = Self { x: 0, y: 1, score: None, unit: None };

    /// Finds the columns in a header: `x`, `X`, `x_px`, `x (px)`, `X [µm]` and the like.
    ///
    /// # Errors
    /// Fails if a column is missing or named twice.
    pub fn named_in(header: &Row) -> Result<Self, Located> {
        let names: Vec<_> = header.cells.iter().map(|cell| Name::parse(cell)).collect();
        let find = |stem: &str, unit: Option<LengthUnit>| {
            let mut found =
                names.iter().enumerate().filter(|(_, n)| n.stem == stem && n.unit == Unit::Is(unit));
            match (found.next(), found.next()) {
                (Some((index, _)), None) => Ok(Some(index)),
                (None, _) => Ok(None),
                (Some((index, _)), Some(_)) => {
                    let column = header.cells.get(index).map(|cell| shortened(cell)).unwrap_or_default();
                    let fault = ReadFault::TwoColumns { column, header: shortened(header.text) };
                    Err(Located::line(header.line, fault))
                }
            }
        };
        let mut score = None;
        for name in SCORES {
            score = score.or(find(name, None)?);
        }
        for (x, y) in STEMS {
            for unit in UNITS {
                if let (Some(x), Some(y)) = (find(x, unit)?, find(y, unit)?) {
                    return Ok(Self { x, y, score, unit });
                }
            }
        }
        let fault = match header.cells.as_slice() {
            [_] => ReadFault::OneColumn { found: shortened(header.text) },
            _ => ReadFault::Header {
                expected: "columns x and y (or x_px and y_px, x_um and y_um)",
                found: shortened(header.text),
            },
        };
        Err(Located::line(header.line, fault))
    }
}

/// Unit at the end of a column's name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Unit {
    /// Known unit, or `None` if the name has no unit.
    Is(Option<LengthUnit>),
    /// Words that are no known unit.
    Unknown,
}

/// Name of a column, split into its stem and its unit: `x_px` is `x` in pixels.
pub(super) struct Name {
    /// First word of the name, in lower case.
    pub(super) stem: String,
    /// Unit that the rest of the name states.
    pub(super) unit: Unit,
}

impl Name {
    /// Splits a cell of a header at blanks, underscores, hyphens, brackets and slashes.
    pub(super) fn parse(cell: &str) -> Self {
        let lower = cell.to_lowercase();
        let mut words =
            lower.split(|c: char| c.is_whitespace() || "_-()[]/".contains(c)).filter(|w| !w.is_empty());
        let stem = words.next().unwrap_or("").to_owned();
        let unit = match (words.next(), words.next()) {
            (None, _) => Unit::Is(None),
            (Some(word), None) => match word {
                "px" | "pixel" | "pixels" => Unit::Is(Some(LengthUnit::Pixel)),
                // The two signs differ: µ is the micro sign U+00B5, μ the Greek letter U+03BC.
                "um" | "µm" | "μm" | "micron" | "microns" | "micrometre" | "micrometres" | "micrometer"
                | "micrometers" => Unit::Is(Some(LengthUnit::Micrometre)),
                "unit" => Unit::Is(Some(LengthUnit::Unit)),
                _ => Unit::Unknown,
            },
            _ => Unit::Unknown,
        };
        Self { stem, unit }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(header: &str) -> Result<Columns, Located> {
        let cells = header.split(',').map(Into::into).collect();
        Columns::named_in(&Row { line: 1, text: header, cells })
    }

    #[test]
    fn headers_of_the_field_name_their_columns() {
        let px = Some(LengthUnit::Pixel);
        let um = Some(LengthUnit::Micrometre);
        for (header, x, y, score, unit) in [
            ("x,y", 0, 1, None, None),
            ("Y,X", 1, 0, None, None),
            ("x_px,y_px,score,x_um,y_um", 0, 1, Some(2), px),
            ("x_um,y_um", 0, 1, None, um),
            ("X (µm),Y (µm)", 0, 1, None, um),
            ("X [pixels],Y [pixels],Score", 0, 1, Some(2), px),
            (",Area,Mean,X,Y,XM,YM", 3, 4, None, None),
            ("Label,XM,YM", 1, 2, None, None),
            ("x,y,Confidence", 0, 1, Some(2), None),
            ("x,probability,y,score", 0, 2, Some(3), None),
        ] {
            assert_eq!(named(header).unwrap(), Columns { x, y, score, unit }, "{header}");
        }
    }

    #[test]
    fn unclear_headers_are_refused() {
        for header in ["row,column", "x_mm,y_mm", "x_px,y_um", "x"] {
            assert!(named(header).is_err(), "{header}");
        }
        assert!(matches!(named("x,y,x,y").unwrap_err().fault, ReadFault::TwoColumns { .. }));
    }
}
