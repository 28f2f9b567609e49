use super::error::{Located, ReadFault, shortened};
use super::text::content_lines;
use std::borrow::Cow;

/// Separator between the cells of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Separator {
    /// One comma between cells.
    Comma,
    /// One semicolon between cells.
    Semicolon,
    /// One tab between cells.
    Tab,
    /// Any number of blanks between cells.
    Blanks,
}

impl Separator {
    /// Determines the separator of a file from its first line.
    ///
    /// Tab and semicolon are tried first because cells between them may contain a decimal comma;
    /// blanks are tried last because they often follow a comma.
    fn of(line: &str) -> Self {
        let mut quoted = false;
        let outside: Vec<char> = line
            .chars()
            .filter(|&c| {
                quoted ^= c == '"';
                !quoted
            })
            .collect();
        [(Self::Tab, '\t'), (Self::Semicolon, ';'), (Self::Comma, ',')]
            .into_iter()
            .find(|(_, c)| outside.contains(c))
            .map_or(Self::Blanks, |(separator, _)| separator)
    }

    /// Returns whether a comma inside a cell is read as a decimal comma.
    const fn allows_decimal_comma(self) -> bool {
        matches!(self, Self::Semicolon | Self::Tab)
    }

    /// Splits a line into cells without surrounding blanks and quotation marks.
    ///
    /// Returns `None` if a quotation mark is not closed.
    fn split<'a>(self, line: &'a str) -> Option<Vec<Cow<'a, str>>> {
        let separates = |c: char| match self {
            Self::Comma => c == ',',
            Self::Semicolon => c == ';',
            Self::Tab => c == '\t',
            Self::Blanks => c.is_whitespace(),
        };
        if !line.contains('"') {
            let cells = line.split(separates).map(|cell| Cow::Borrowed(cell.trim()));
            return Some(match self {
                Self::Blanks => cells.filter(|cell| !cell.is_empty()).collect(),
                _ => cells.collect(),
            });
        }
        let mut cells = vec![String::new()];
        let mut quoted = false;
        for c in line.chars() {
            if c == '"' {
                quoted = !quoted;
            } else if !quoted && separates(c) {
                cells.push(String::new());
            } else if let Some(cell) = cells.last_mut() {
                cell.push(c);
            }
        }
        let cells = cells.into_iter().map(|cell| Cow::<str>::Owned(cell.trim().to_owned()));
        (!quoted).then(|| match self {
            Self::Blanks => cells.filter(|cell| !cell.is_empty()).collect(),
            _ => cells.collect(),
        })
    }
}

/// Line of a text, split into cells.
#[derive(Debug)]
pub(super) struct Row<'a> {
    /// Number of the line, from 1.
    pub line: usize,
    /// Complete text of the line.
    pub text: &'a str,
    /// Cells without surrounding blanks and quotation marks.
    pub cells: Vec<Cow<'a, str>>,
}

/// Non-empty rows of a text, each with as many cells as the first, and the separator between cells.
pub(super) struct Table<'a> {
    /// Rows in the order of the text, the header included.
    pub rows: Vec<Row<'a>>,
    separator: Separator,
}

impl<'a> Table<'a> {
    /// Splits a text into rows of cells; `expected` describes, in errors, the content of a good
    /// file.
    ///
    /// Empty cells at the end of a row that is longer than the first are dropped.
    ///
    /// # Errors
    /// Fails if the text has no content, a row has more or fewer cells than the first, or a
    /// quotation mark is not closed on its line.
    pub fn new(text: &'a str, expected: &'static str) -> Result<Self, Located> {
        let (_, first) = content_lines(text).next().ok_or(ReadFault::Empty { expected })?;
        let separator = Separator::of(first);
        let mut rows: Vec<Row> = Vec::new();
        for (line, text) in content_lines(text) {
            let open = || Located::line(line, ReadFault::OpenQuote { line: shortened(text) });
            let mut cells = separator.split(text).ok_or_else(open)?;
            // Spreadsheets export empty rows below a table as rows of nothing but separators.
            if cells.iter().all(|cell| cell.is_empty()) {
                continue;
            }
            if let Some(expected) = rows.first().map(|row| row.cells.len()) {
                while cells.len() > expected && cells.last().is_some_and(|cell| cell.is_empty()) {
                    cells.pop();
                }
                if cells.len() != expected {
                    let fault = ReadFault::Ragged { expected, found: cells.len(), line: shortened(text) };
                    return Err(Located::line(line, fault));
                }
            }
            rows.push(Row { line, text, cells });
        }
        if rows.is_empty() {
            return Err(ReadFault::Empty { expected }.into());
        }
        Ok(Self { rows, separator })
    }

    /// Returns whether a cell can be read as a number, finite or not.
    pub fn is_number(&self, cell: &str) -> bool {
        self.parse(cell).is_some()
    }

    /// Returns the number in cell `index` of a row.
    ///
    /// # Errors
    /// Fails if the cell has no finite number; the message calls the cell by the name `column`.
    pub fn number(&self, row: &Row, index: usize, column: &str) -> Result<f64, Located> {
        let cell = row.cells.get(index).map_or("", |cell| cell.as_ref());
        let fault = match self.parse(cell) {
            Some(number) if number.is_finite() => return Ok(number),
            Some(_) => ReadFault::NotFinite { column: column.into(), found: shortened(cell) },
            None => ReadFault::NotANumber {
                column: column.into(),
                found: if cell.is_empty() { "an empty cell".into() } else { shortened(cell) },
                remedy: if self.may_be_decimal_comma(cell) {
                    "write decimal points, or separate the columns by semicolons"
                } else {
                    "correct or delete the row; if there are columns other than x and y, name all columns \
                     in a header"
                },
            },
        };
        Err(Located::line(row.line, fault))
    }

    /// Returns whether a cell that is not a number looks like a number with a decimal comma.
    ///
    /// A line such as `1,5 2,5` is split at its commas, so that the cell `5 2` contains a blank.
    fn may_be_decimal_comma(&self, cell: &str) -> bool {
        match self.separator {
            Separator::Comma => cell.contains(char::is_whitespace),
            _ => cell.contains(','),
        }
    }

    /// Reads a cell as a number, with a decimal point or, where it is allowed, a decimal comma.
    fn parse(&self, cell: &str) -> Option<f64> {
        if self.separator.allows_decimal_comma() && cell.contains(',') && !cell.contains('.') {
            cell.replacen(',', ".", 1).parse().ok()
        } else {
            cell.parse().ok()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(line: &str) -> Vec<String> {
        Separator::of(line).split(line).unwrap().iter().map(ToString::to_string).collect()
    }

    #[test]
    fn separators_are_recognised_by_the_line() {
        assert_eq!(cells("1, 2"), ["1", "2"]);
        assert_eq!(cells("1,5;2,5"), ["1,5", "2,5"]);
        assert_eq!(cells(" \tX\tY"), ["", "X", "Y"]);
        assert_eq!(cells("  1.5   2 "), ["1.5", "2"]);
        assert_eq!(cells("\"a;b\",\"2\""), ["a;b", "2"]);
        assert_eq!(cells("\"1\" \"2\""), ["1", "2"]);
    }

    #[test]
    fn decimal_commas_need_another_separator() {
        let number = |text| {
            let table = Table::new(text, "").unwrap();
            table.number(&table.rows[0], 0, "x").ok()
        };
        assert_eq!(number("1,5;2"), Some(1.5));
        assert_eq!(number("1,5\t2"), Some(1.5));
        assert_eq!(number("1,5"), Some(1.));
        assert_eq!(number("1.234,5;2"), None);
        assert_eq!(number("1,234,5;2"), None);
    }
}
