use std::fmt;
use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// Location of a fault within a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of text, counted from 1.
    Line(usize),
    /// A member of an archive.
    Member(String),
}

/// Error for a coordinate file or a table that cannot be read: the file, the location and the
/// fault.
#[derive(Debug)]
pub struct ReadError {
    /// Path of the file, as passed by the caller.
    pub file: String,
    /// Location in the file, or `None` if the fault is not on a line or in a member of an archive.
    pub place: Option<Place>,
    /// Fault that was found in the file.
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
    /// Refusal of the operating system to read the file.
    #[error("cannot be read ({0}): check that it exists and may be read")]
    Io(io::Error),
    /// File, or ROI in an archive, that is larger than coordinates can sensibly be.
    #[error("is larger than {limit_mib} MiB, too large for coordinates: give a file of point coordinates")]
    TooLarge {
        /// Size of the largest file that is read, in MiB.
        limit_mib: u64,
    },
    /// File with nothing but blanks and comments.
    #[error(
        "expected {expected}, found an empty file: export it again (a header alone would mean no points)"
    )]
    Empty {
        /// Content that was expected.
        expected: &'static str,
    },
    /// File that is neither text nor any of the known binary dialects.
    #[error(
        "expected coordinates as text, a WebPlotDigitizer project or ImageJ ROIs, found {found}: export the \
         coordinates as CSV"
    )]
    NotCoordinates {
        /// Kind of file that it seems to be.
        found: String,
    },
    /// Cell that should be a number but has other text.
    #[error("expected a number for {column}, found {found}: {remedy}")]
    NotANumber {
        /// Name of the column.
        column: String,
        /// Text of the cell, shortened.
        found: String,
        /// Advice on what to do.
        remedy: &'static str,
    },
    /// Number that is NaN, infinite, or too large for a floating-point number.
    #[error("expected a finite number for {column}, found {found}: leave out points without a position")]
    NotFinite {
        /// Name of the column.
        column: String,
        /// Text of the cell, shortened.
        found: String,
    },
    /// File with a single column.
    #[error(
        "expected two columns, x and y, separated by comma, semicolon, tab or blanks, found only one in \
         {found}: export both"
    )]
    OneColumn {
        /// Text of the first line, shortened.
        found: String,
    },
    /// Row with more or fewer cells than the first row.
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
    /// Quotation mark that is not closed on its line.
    #[error("expected a closing quotation mark on the same line, found none in {line}: correct the row")]
    OpenQuote {
        /// Text of the line, shortened.
        line: String,
    },
    /// Header without the expected columns.
    #[error(
        "expected a header that names {expected}, found {found}: rename the columns or leave out the header"
    )]
    Header {
        /// Columns that were expected.
        expected: &'static str,
        /// Text of the header, shortened.
        found: String,
    },
    /// Two columns with the same name.
    #[error("expected one column named {column}, found two in {header}: keep only the right one")]
    TwoColumns {
        /// Name of the column.
        column: String,
        /// Text of the header, shortened.
        header: String,
    },
    /// JSON that is broken, or not a WebPlotDigitizer project.
    #[error(
        "expected a WebPlotDigitizer project (version 3 or 4), found JSON that is damaged or of another \
         kind ({detail}): save the project again"
    )]
    Json {
        /// Message of the JSON parser.
        detail: String,
    },
    /// Archive that is broken and cannot be unpacked.
    #[error("expected {expected}, found a damaged archive ({detail}): save it again")]
    Archive {
        /// Kind of archive that was expected.
        expected: &'static str,
        /// Message of the archive reader.
        detail: String,
    },
    /// Archive without the expected file.
    #[error("expected {expected} in the archive, found {found}: {remedy}")]
    NotInArchive {
        /// File that was expected.
        expected: &'static str,
        /// Files in the archive, shortened.
        found: String,
        /// Advice on what to do.
        remedy: &'static str,
    },
    /// Archive, which this build cannot read because it lacks the feature `archives`.
    #[cfg(not(feature = "archives"))]
    #[error(
        "expected a file that is not packed, found {found}, which this build cannot open: unpack it, or build conemosaic \
         with the feature `archives`"
    )]
    WithoutArchives {
        /// Kind of archive that was found.
        found: &'static str,
    },
    /// ImageJ ROI that ends too early or does not begin with the bytes of a ROI.
    #[error(
        "expected an ImageJ ROI of at least {expected} bytes that begins with “Iout”, found {found}: save the ROI again"
    )]
    BrokenRoi {
        /// Number of bytes that the header announces.
        expected: u64,
        /// Description of what was found.
        found: String,
    },
    /// ImageJ ROI that is not a set of points.
    #[error(
        "expected an ImageJ point or multi-point ROI, found {found}: mark cones with the multi-point tool"
    )]
    NotAPointRoi {
        /// Kind of ROI that was found.
        found: String,
    },
    /// ImageJ ROI of a kind that encloses no window.
    #[error(
        "expected an ImageJ polygon, freehand, traced or rectangular ROI, found {found}: draw the window with one of \
         these tools"
    )]
    NotAnOutlineRoi {
        /// Kind of ROI that was found.
        found: String,
    },
    /// Rings of corners that enclose no window.
    #[error("{0}")]
    Outline(crate::geometry::PolygonError),
    /// Request for a dataset that the file does not contain.
    #[error("expected a dataset named {wanted}, found only {found}: choose one of these")]
    NoSuchDataset {
        /// Name that was asked for.
        wanted: String,
        /// Names in the file, shortened.
        found: String,
    },
    /// Pixel origin set for coordinates that are not in pixels.
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
    /// Option with a value outside its range.
    #[error("{option} is {found}: expected {expected}")]
    Option {
        /// Name of the option.
        option: &'static str,
        /// Value of the option.
        found: String,
        /// Range of the option.
        expected: &'static str,
    },
    /// Scale that is not a positive number.
    #[error("{0}: correct the row")]
    Scale(#[from] crate::mosaic::ScaleError),
    /// Two rows with the same identifier but different scales.
    #[error(
        "expected one scale for {identifier}, found another on line {first_line}: keep only the right one"
    )]
    TwoScales {
        /// Identifier of both rows, shortened.
        identifier: String,
        /// Number of the line that gave the first scale.
        first_line: usize,
    },
    /// Two rows with the same name but different groups.
    #[error("expected one group for {name}, found another on line {first_line}: keep only the right one")]
    TwoGroups {
        /// Name that occurs twice, shortened.
        name: String,
        /// Number of the line that gave the first group.
        first_line: usize,
    },
    /// Row of a table of groups without a name or without a group.
    #[error("expected a name and its group, found {line}: give both, separated by a comma")]
    NoGroup {
        /// Text of the row, shortened.
        line: String,
    },
    /// Two different rows of a manifest with the same identifier.
    #[error("expected one row for {identifier}, found another on line {first_line}: keep only the right one")]
    TwoRows {
        /// Identifier of both rows, shortened.
        identifier: String,
        /// Number of the line of the first row.
        first_line: usize,
    },
    /// Distance from the fovea that is negative.
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
    /// Direction from the fovea that is not one of the four meridians.
    #[error(
        "expected the meridian nasal, temporal, superior or inferior (of the retina), found {found}: name \
         one of these, or leave the cell empty"
    )]
    Meridian {
        /// Text of the cell, shortened.
        found: String,
    },
    /// Box without an area, in a table of regions.
    #[error("expected a box with an area (x0 < x1 and y0 < y1), found {line}: correct the row")]
    NoBox {
        /// Text of the row, shortened.
        line: String,
    },
    /// Two boxes of one file with the same name.
    #[error("expected one box named {name} per file, found another on line {first_line}: rename one of them")]
    TwoBoxes {
        /// Name that occurs twice, shortened.
        name: String,
        /// Number of the line that gave the first box.
        first_line: usize,
    },
    /// Row of a table of scales or of a manifest without an identifier.
    #[error("expected an identifier in the first column, found none in {line}: give a part of the file name")]
    NoIdentifier {
        /// Text of the row, shortened.
        line: String,
    },
}

/// Fault and its location within a file, before the path of the file is added.
#[derive(Debug)]
pub(super) struct Located {
    /// Location in the file, or `None` if the fault is not on a line or in a member of an archive.
    pub place: Option<Place>,
    /// Fault that was found in the file.
    pub fault: ReadFault,
}

impl Located {
    /// Returns the fault with its line, counted from 1.
    pub fn line(line: usize, fault: ReadFault) -> Self {
        Self { place: Some(Place::Line(line)), fault }
    }

    /// Returns the fault with the name of the member of an archive that has it.
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
    /// Refusal of the operating system to write the file.
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
    /// Coordinate or score that is not finite, so that no reader would accept it.
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
    /// Number of scores that differs from the number of points.
    #[error("{}: there are {points} points but {scores} scores: give one score per point", .file.display())]
    Scores {
        /// Path of the file.
        file: PathBuf,
        /// Number of points to be written.
        points: usize,
        /// Number of scores to be written.
        scores: usize,
    },
}

/// Number of characters after which a quotation from a file is cut in a message.
const QUOTED: usize = 48;

/// Returns text from a file in a form that is safe in a one-line message.
///
/// The text is shortened, put in quotation marks, and freed of characters that move a cursor.
pub(super) fn shortened(text: &str) -> String {
    format!("“{}”", clipped(text.trim(), QUOTED))
}

/// Returns the first `length` characters of a text, and an ellipsis if the text has more.
///
/// Characters that would disturb a terminal are replaced by `·`.
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

/// Replaces characters that would disturb a terminal by `·`.
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
