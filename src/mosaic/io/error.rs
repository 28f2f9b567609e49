use std::fmt;
use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// Where in a file something is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of text, counted from 1.
    Line(usize),
    /// A member of an archive.
    Member(String),
}

/// A coordinate file or a table of scales or groups that cannot be read: which file, where in it, and why.
#[derive(Debug)]
pub struct ReadError {
    /// The file as it was given.
    pub file: String,
    /// Where in it, if the fault has a place.
    pub place: Option<Place>,
    /// What is wrong there.
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

/// What is wrong with a coordinate file or a scale table: what was expected, what was found, what to do.
#[derive(Debug, Error)]
pub enum ReadFault {
    /// The operating system refuses.
    #[error("cannot be read ({0}): check that it exists and may be read")]
    Io(io::Error),
    /// More than a coordinate file can sensibly hold.
    #[error("is larger than {limit_mib} MiB, too large for coordinates: give a file of point coordinates")]
    TooLarge {
        /// The most that is read, in MiB.
        limit_mib: u64,
    },
    /// Nothing but blanks and comments.
    #[error(
        "expected {expected}, found an empty file: export it again (a header alone would mean no points)"
    )]
    Empty {
        /// What belongs there.
        expected: &'static str,
    },
    /// Neither text nor any of the known binary dialects.
    #[error(
        "expected coordinates as text, a WebPlotDigitizer project or ImageJ ROIs, found {found}: export the \
         coordinates as CSV"
    )]
    NotCoordinates {
        /// What it seems to be.
        found: String,
    },
    /// Text that is not a number where one belongs.
    #[error("expected a number for {column}, found {found}: {remedy}")]
    NotANumber {
        /// The column.
        column: String,
        /// The text, shortened.
        found: String,
        /// What to do.
        remedy: &'static str,
    },
    /// NaN, infinite, or too large for a floating-point number.
    #[error("expected a finite number for {column}, found {found}: leave out points without a position")]
    NotFinite {
        /// The column.
        column: String,
        /// The text, shortened.
        found: String,
    },
    /// A single column.
    #[error(
        "expected two columns, x and y, separated by comma, semicolon, tab or blanks, found only one in \
         {found}: export both"
    )]
    OneColumn {
        /// The line, shortened.
        found: String,
    },
    /// A row with more or fewer cells than the first one.
    #[error("expected {expected} cells as in the first row, found {found} in {line}: correct the row")]
    Ragged {
        /// Cells of the first row.
        expected: usize,
        /// Cells of this row.
        found: usize,
        /// The row, shortened.
        line: String,
    },
    /// A quotation mark that opens and does not close on its line.
    #[error("expected a closing quotation mark on the same line, found none in {line}: correct the row")]
    OpenQuote {
        /// The line, shortened.
        line: String,
    },
    /// A header without the columns sought.
    #[error(
        "expected a header that names {expected}, found {found}: rename the columns or leave out the header"
    )]
    Header {
        /// The columns sought.
        expected: &'static str,
        /// The header, shortened.
        found: String,
    },
    /// Two columns of equal rights.
    #[error("expected one column named {column}, found two in {header}: keep only the right one")]
    TwoColumns {
        /// The column.
        column: String,
        /// The header, shortened.
        header: String,
    },
    /// JSON that is broken, or not a project.
    #[error(
        "expected a WebPlotDigitizer project (version 3 or 4), found JSON that is damaged or of another \
         kind ({detail}): save the project again"
    )]
    Json {
        /// Why.
        detail: String,
    },
    /// An archive that is broken.
    #[error("expected {expected}, found a damaged archive ({detail}): save it again")]
    Archive {
        /// What it should be.
        expected: &'static str,
        /// Why.
        detail: String,
    },
    /// An archive without what is sought in it.
    #[error("expected {expected} in the archive, found {found}: {remedy}")]
    NotInArchive {
        /// What is sought.
        expected: &'static str,
        /// What is there, shortened.
        found: String,
        /// What to do.
        remedy: &'static str,
    },
    /// An archive, and this build reads none.
    #[cfg(not(feature = "archives"))]
    #[error(
        "expected a file that is not packed, found {found}, which this build cannot open: unpack it, or build conemosaic \
         with the feature `archives`"
    )]
    WithoutArchives {
        /// The kind of archive.
        found: &'static str,
    },
    /// An ImageJ ROI that ends too early or does not start like one.
    #[error(
        "expected an ImageJ ROI of at least {expected} bytes that begins with “Iout”, found {found}: save the ROI again"
    )]
    BrokenRoi {
        /// Bytes that its header promises.
        expected: u64,
        /// What is there.
        found: String,
    },
    /// An ImageJ ROI of another kind.
    #[error(
        "expected an ImageJ point or multi-point ROI, found {found}: mark cones with the multi-point tool"
    )]
    NotAPointRoi {
        /// The kind found.
        found: String,
    },
    /// An ImageJ ROI that encloses no window.
    #[error(
        "expected an ImageJ polygon, freehand, traced or rectangular ROI, found {found}: draw the window with one of \
         these tools"
    )]
    NotAnOutlineRoi {
        /// The kind found.
        found: String,
    },
    /// Rings that enclose no window.
    #[error("{0}")]
    Outline(crate::geometry::PolygonError),
    /// A dataset asked for that is not in the file.
    #[error("expected a dataset named {wanted}, found only {found}: choose one of these")]
    NoSuchDataset {
        /// The name asked for.
        wanted: String,
        /// The names in the file, shortened.
        found: String,
    },
    /// A pixel origin for coordinates that are not pixels.
    #[error(
        "expected coordinates in px, since the origin is {origin}, found coordinates in \
         {unit}: leave out the origin"
    )]
    OriginWithoutPixels {
        /// The origin asked for.
        origin: super::Origin,
        /// Symbol of the unit in the header.
        unit: &'static str,
    },
    /// An option out of its range.
    #[error("{option} is {found}: expected {expected}")]
    Option {
        /// The option.
        option: &'static str,
        /// Its value.
        found: String,
        /// Its range.
        expected: &'static str,
    },
    /// A scale that is not a positive number.
    #[error("{0}: correct the row")]
    Scale(#[from] crate::mosaic::ScaleError),
    /// The same identifier with two scales.
    #[error(
        "expected one scale for {identifier}, found another on line {first_line}: keep only the right one"
    )]
    TwoScales {
        /// The identifier, shortened.
        identifier: String,
        /// The line that gave the first scale.
        first_line: usize,
    },
    /// The same name with two groups.
    #[error("expected one group for {name}, found another on line {first_line}: keep only the right one")]
    TwoGroups {
        /// The name, shortened.
        name: String,
        /// The line that gave the first group.
        first_line: usize,
    },
    /// A row of a table of groups that lacks one of the two.
    #[error("expected a name and its group, found {line}: give both, separated by a comma")]
    NoGroup {
        /// The row, shortened.
        line: String,
    },
    /// The same identifier with two rows of a manifest.
    #[error("expected one row for {identifier}, found another on line {first_line}: keep only the right one")]
    TwoRows {
        /// The identifier, shortened.
        identifier: String,
        /// The line of the first row.
        first_line: usize,
    },
    /// A distance from the fovea that is none.
    #[error(
        "expected a distance of 0 or more in column {column}, found {value}: give the distance without a \
         sign, and the direction in the column meridian"
    )]
    Eccentricity {
        /// The column.
        column: &'static str,
        /// What it says.
        value: f64,
    },
    /// A direction from the fovea that is none.
    #[error(
        "expected the meridian nasal, temporal, superior or inferior (of the retina), found {found}: name \
         one of these, or leave the cell empty"
    )]
    Meridian {
        /// What it says, shortened.
        found: String,
    },
    /// A box without area.
    #[error("expected a box with an area (x0 < x1 and y0 < y1), found {line}: correct the row")]
    NoBox {
        /// The row, shortened.
        line: String,
    },
    /// The same name for two boxes.
    #[error("expected one box named {name} per file, found another on line {first_line}: rename one of them")]
    TwoBoxes {
        /// The name, shortened.
        name: String,
        /// The line that gave the first box.
        first_line: usize,
    },
    /// A row of a scale table without identifier.
    #[error("expected an identifier in the first column, found none in {line}: give a part of the file name")]
    NoIdentifier {
        /// The row, shortened.
        line: String,
    },
}

/// A fault and where it is, before the file is known.
#[derive(Debug)]
pub(super) struct Located {
    pub place: Option<Place>,
    pub fault: ReadFault,
}

impl Located {
    pub fn line(line: usize, fault: ReadFault) -> Self {
        Self { place: Some(Place::Line(line)), fault }
    }

    #[cfg(feature = "archives")]
    pub fn member(name: &str, fault: ReadFault) -> Self {
        Self { place: Some(Place::Member(name.to_owned())), fault }
    }

    pub fn in_file(self, file: &str) -> ReadError {
        ReadError { file: file.to_owned(), place: self.place, fault: self.fault }
    }
}

impl From<ReadFault> for Located {
    fn from(fault: ReadFault) -> Self {
        Self { place: None, fault }
    }
}

/// A file that cannot be written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The operating system refuses.
    #[error(
        "{} cannot be written ({source}): check that its folder exists, may be written to and has room",
        .file.display()
    )]
    Io {
        /// The file.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A coordinate or score that no reader would take.
    #[error(
        "{}: point {index} (counted from 0) has a coordinate or score that is not a finite number: leave \
         it out",
        .file.display()
    )]
    NotFinite {
        /// The file.
        file: PathBuf,
        /// 0-based index of the point.
        index: usize,
    },
    /// Not one score a point.
    #[error("{}: there are {points} points but {scores} scores: give one score per point", .file.display())]
    Scores {
        /// The file.
        file: PathBuf,
        /// Number of points.
        points: usize,
        /// Number of scores.
        scores: usize,
    },
}

/// Longest quotation from a file in a message, in characters.
const QUOTED: usize = 48;

/// Text from a file as it may stand in a one-line message: shortened, quoted, nothing that moves a cursor.
pub(super) fn shortened(text: &str) -> String {
    format!("“{}”", clipped(text.trim(), QUOTED))
}

/// The first `length` characters, made printable.
pub(super) fn clipped(text: &str, length: usize) -> String {
    let mut start: String = text.chars().take(length + 1).collect();
    if start.chars().count() > length {
        start.pop();
        start.push('…');
    }
    printable(&start)
}

/// Names in one line: the first few, and how many more there are.
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
    // Besides control characters: marks that reorder or hide text on a terminal.
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
