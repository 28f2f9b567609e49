use std::fmt;
use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// Place in a file where something is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of text, counted from 1.
    Line(usize),
    /// A member of an archive.
    Member(String),
}

/// Error for a coordinate file or a table that cannot be read: the file, the place and the fault.
#[derive(Debug)]
pub struct ReadError {
    /// Path of the file, as given.
    pub file: String,
    /// Place in the file; `None` if the fault has none.
    pub place: Option<Place>,
    /// Fault that was found there.
    pub fault: ReadFault,
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", printable(&self.file))?;
        match &self.place {
            Some(Place::Line(line)) => write!(f, ", line {line}")?,
            Some(Place::Member(name)) => write!(f, ", member {}", shortened(name))?,
            None => {}
        }
        write!(f, ": {}", self.fault)
    }
}

impl std::error::Error for ReadError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.fault {
            ReadFault::Io(source) => Some(source),
            _ => None,
        }
    }
}

/// Fault of a coordinate file or a table.
///
/// The message says what was expected, what was found and what to do.
#[derive(Debug, Error)]
pub enum ReadFault {
    /// The operating system refuses to read the file.
    #[error("cannot be read ({0}): check that it exists and may be read")]
    Io(io::Error),
    /// The file is larger than a coordinate file can sensibly be.
    #[error("is larger than {limit_mib} MiB, too large for coordinates: give a file of point coordinates")]
    TooLarge {
        /// Size of the largest file that is read, in MiB.
        limit_mib: u64,
    },
    /// The file has nothing but blanks and comments.
    #[error(
        "expected {expected}, found an empty file: export it again (a header alone would mean no points)"
    )]
    Empty {
        /// Content that was expected.
        expected: &'static str,
    },
    /// The file is neither text nor any of the known binary dialects.
    #[error(
        "expected coordinates as text, a WebPlotDigitizer project or ImageJ ROIs, found {found}: export the \
         coordinates as CSV"
    )]
    NotCoordinates {
        /// Kind of file that it seems to be.
        found: String,
    },
    /// A cell that should be a number has other text.
    #[error("expected a number for {column}, found {found}: {remedy}")]
    NotANumber {
        /// Name of the column.
        column: String,
        /// Text of the cell, shortened.
        found: String,
        /// Advice on what to do.
        remedy: &'static str,
    },
    /// A number is NaN, infinite, or too large for a floating-point number.
    #[error("expected a finite number for {column}, found {found}: leave out points without a position")]
    NotFinite {
        /// Name of the column.
        column: String,
        /// Text of the cell, shortened.
        found: String,
    },
    /// The file has a single column.
    #[error(
        "expected two columns, x and y, separated by comma, semicolon, tab or blanks, found only one in \
         {found}: export both"
    )]
    OneColumn {
        /// Text of the first line, shortened.
        found: String,
    },
    /// A row has more or fewer cells than the first one.
    #[error(
        "expected {expected} cells as in the first row, found {found} in {line}: correct the row (is this a \
         table of coordinates? are decimal commas separated by semicolons?)"
    )]
    Ragged {
        /// Number of cells in the first row.
        expected: usize,
        /// Number of cells in this row.
        found: usize,
        /// Text of the row, shortened.
        line: String,
    },
    /// A quotation mark is not closed on its line.
    #[error("expected a closing quotation mark on the same line, found none in {line}: correct the row")]
    OpenQuote {
        /// Text of the line, shortened.
        line: String,
    },
    /// The header lacks the expected columns.
    #[error(
        "expected a header that names {expected}, found {found}: rename the columns or leave out the header"
    )]
    Header {
        /// Columns that were expected.
        expected: &'static str,
        /// Text of the header, shortened.
        found: String,
    },
    /// Two columns have the same name.
    #[error("expected one column named {column}, found two in {header}: keep only the right one")]
    TwoColumns {
        /// Name of the column.
        column: String,
        /// Text of the header, shortened.
        header: String,
    },
    /// The JSON is broken, or not a WebPlotDigitizer project.
    #[error(
        "expected a WebPlotDigitizer project (version 3 or 4), found JSON that is damaged or of another \
         kind ({detail}): save the project again"
    )]
    Json {
        /// Message of the JSON parser.
        detail: String,
    },
    /// The archive is broken.
    #[error("expected {expected}, found a damaged archive ({detail}): save it again")]
    Archive {
        /// Kind of archive that was expected.
        expected: &'static str,
        /// Message of the archive reader.
        detail: String,
    },
    /// The archive lacks the expected file.
    #[error("expected {expected} in the archive, found {found}: {remedy}")]
    NotInArchive {
        /// File that was expected.
        expected: &'static str,
        /// Files in the archive, shortened.
        found: String,
        /// Advice on what to do.
        remedy: &'static str,
    },
    /// The file is an archive, and this build cannot read archives.
    #[cfg(not(feature = "archives"))]
    #[error(
        "expected a file that is not packed, found {found}, which this build cannot open: unpack it, or build conemosaic \
         with the feature `archives`"
    )]
    WithoutArchives {
        /// Kind of archive that was found.
        found: &'static str,
    },
    /// The ImageJ ROI ends too early or does not start like one.
    #[error(
        "expected an ImageJ ROI of at least {expected} bytes that begins with “Iout”, found {found}: save the ROI again"
    )]
    BrokenRoi {
        /// Number of bytes that the header announces.
        expected: u64,
        /// Description of what was found.
        found: String,
    },
    /// The ImageJ ROI is not a set of points.
    #[error(
        "expected an ImageJ point or multi-point ROI, found {found}: mark cones with the multi-point tool"
    )]
    NotAPointRoi {
        /// Kind of ROI that was found.
        found: String,
    },
    /// The ImageJ ROI is of a kind that encloses no window.
    #[error(
        "expected an ImageJ polygon, freehand, traced or rectangular ROI, found {found}: draw the window with one of \
         these tools"
    )]
    NotAnOutlineRoi {
        /// Kind of ROI that was found.
        found: String,
    },
    /// The rings enclose no window.
    #[error("{0}")]
    Outline(crate::geometry::PolygonError),
    /// The file lacks the dataset that was asked for.
    #[error("expected a dataset named {wanted}, found only {found}: choose one of these")]
    NoSuchDataset {
        /// Name that was asked for.
        wanted: String,
        /// Names in the file, shortened.
        found: String,
    },
    /// The options give a pixel origin for coordinates that are not pixels.
    #[error(
        "expected coordinates in px, since the origin is {origin}, found coordinates in \
         {unit}: leave out the origin"
    )]
    OriginWithoutPixels {
        /// Origin that was asked for.
        origin: super::Origin,
        /// Symbol of the unit that the header names.
        unit: &'static str,
    },
    /// An option is out of its range.
    #[error("{option} is {found}: expected {expected}")]
    Option {
        /// Name of the option.
        option: &'static str,
        /// Value of the option.
        found: String,
        /// Range of the option.
        expected: &'static str,
    },
    /// The scale is not a positive number.
    #[error("{0}: correct the row")]
    Scale(#[from] crate::mosaic::ScaleError),
    /// Two rows give the same identifier different scales.
    #[error(
        "expected one scale for {identifier}, found another on line {first_line}: keep only the right one"
    )]
    TwoScales {
        /// Identifier of both rows, shortened.
        identifier: String,
        /// Number of the line that gave the first scale.
        first_line: usize,
    },
    /// Two rows give the same name different groups.
    #[error("expected one group for {name}, found another on line {first_line}: keep only the right one")]
    TwoGroups {
        /// Name that occurs twice, shortened.
        name: String,
        /// Number of the line that gave the first group.
        first_line: usize,
    },
    /// A row of a table of groups lacks the name or the group.
    #[error("expected a name and its group, found {line}: give both, separated by a comma")]
    NoGroup {
        /// Text of the row, shortened.
        line: String,
    },
    /// Two different rows of a manifest have the same identifier.
    #[error("expected one row for {identifier}, found another on line {first_line}: keep only the right one")]
    TwoRows {
        /// Identifier of both rows, shortened.
        identifier: String,
        /// Number of the line of the first row.
        first_line: usize,
    },
    /// The distance from the fovea is negative.
    #[error(
        "expected a distance of 0 or more in column {column}, found {value}: give the distance without a \
         sign, and the direction in the column meridian"
    )]
    Eccentricity {
        /// Name of the column.
        column: &'static str,
        /// Number in the cell.
        value: f64,
    },
    /// The direction from the fovea is not one of the four meridians.
    #[error(
        "expected the meridian nasal, temporal, superior or inferior (of the retina), found {found}: name \
         one of these, or leave the cell empty"
    )]
    Meridian {
        /// Text of the cell, shortened.
        found: String,
    },
    /// The box has no area.
    #[error("expected a box with an area (x0 < x1 and y0 < y1), found {line}: correct the row")]
    NoBox {
        /// Text of the row, shortened.
        line: String,
    },
    /// Two boxes of one file have the same name.
    #[error("expected one box named {name} per file, found another on line {first_line}: rename one of them")]
    TwoBoxes {
        /// Name that occurs twice, shortened.
        name: String,
        /// Number of the line that gave the first box.
        first_line: usize,
    },
    /// A row of a table of scales or of a manifest has no identifier.
    #[error("expected an identifier in the first column, found none in {line}: give a part of the file name")]
    NoIdentifier {
        /// Text of the row, shortened.
        line: String,
    },
}

/// Fault with its place, before the path of the file is added.
#[derive(Debug)]
pub(super) struct Located {
    /// Place in the file; `None` if the fault has none.
    pub place: Option<Place>,
    /// Fault that was found there.
    pub fault: ReadFault,
}

impl Located {
    /// Places a fault on a line, counted from 1.
    pub fn line(line: usize, fault: ReadFault) -> Self {
        Self { place: Some(Place::Line(line)), fault }
    }

    /// Places a fault in a member of an archive.
    #[cfg(feature = "archives")]
    pub fn member(name: &str, fault: ReadFault) -> Self {
        Self { place: Some(Place::Member(name.to_owned())), fault }
    }

    /// Completes the error by the path of the file.
    pub fn in_file(self, file: &str) -> ReadError {
        ReadError { file: file.to_owned(), place: self.place, fault: self.fault }
    }
}

impl From<ReadFault> for Located {
    fn from(fault: ReadFault) -> Self {
        Self { place: None, fault }
    }
}

/// Error for a coordinate file that cannot be written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The operating system refuses to write the file.
    #[error(
        "{} cannot be written ({source}): check that its folder exists, may be written to and has room",
        .file.display()
    )]
    Io {
        /// Path of the file.
        file: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A coordinate or score is not finite, so that no reader would accept it.
    #[error(
        "{}: point {index} (counted from 0) has a coordinate or score that is not a finite number: leave \
         it out",
        .file.display()
    )]
    NotFinite {
        /// Path of the file.
        file: PathBuf,
        /// 0-based index of the point.
        index: usize,
    },
    /// The scores are not one per point.
    #[error("{}: there are {points} points but {scores} scores: give one score per point", .file.display())]
    Scores {
        /// Path of the file.
        file: PathBuf,
        /// Number of points given.
        points: usize,
        /// Number of scores given.
        scores: usize,
    },
}

/// Length of the longest quotation from a file in a message, in characters.
const QUOTED: usize = 48;

/// Returns text from a file in a form that is safe in a one-line message.
///
/// The text is shortened, put in quotation marks, and freed of characters that move a cursor.
pub(super) fn shortened(text: &str) -> String {
    format!("“{}”", clipped(text.trim(), QUOTED))
}

/// Returns the first `length` characters, made printable, with an ellipsis if there are more.
pub(super) fn clipped(text: &str, length: usize) -> String {
    let mut start: String = text.chars().take(length + 1).collect();
    if start.chars().count() > length {
        start.pop();
        start.push('…');
    }
    printable(&start)
}

/// Lists names in one line: the first eight, and how many more there are.
pub(super) fn listed<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    const SHOWN: usize = 8;
    let more = names.len().saturating_sub(SHOWN);
    let mut list: Vec<String> = names.take(SHOWN).map(shortened).collect();
    if list.is_empty() {
        return "none".into();
    }
    if more > 0 {
        list.push(format!("{more} more"));
    }
    list.join(", ")
}

fn printable(text: &str) -> String {
    // Beside control characters, some marks reorder or hide text on a terminal.
    let invisible = |c: char| {
        c.is_control()
            || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
    };
    text.chars().map(|c| if invisible(c) { '·' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotations_are_short_and_printable() {
        let quoted = shortened(&format!("\u{1b}[31m\u{202e}\n{}", "long ".repeat(1000)));
        assert!(quoted.chars().count() <= QUOTED + 3);
        assert!(!quoted.chars().any(|c| c.is_control() || c == '\u{202e}'));
        assert!(quoted.ends_with("…”"));
    }

    #[test]
    fn long_lists_say_how_many_are_left_out() {
        let names: Vec<String> = (0..20).map(|i| i.to_string()).collect();
        assert!(listed(names.iter().map(String::as_str)).ends_with("12 more"));
        assert_eq!(listed([].into_iter()), "none");
    }
}
