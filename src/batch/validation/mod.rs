use super::detection::{detect_in, read_image};
use super::failures::write_failures;
use super::inputs::coordinate_files;
use super::outputs::OutputFolder;
use super::pairing::{image_beside, image_in, image_name, says_coords};
use super::work::for_each;
use super::{BatchError, Failure, Input, Progress};
use crate::compare::{MatchOptions, Score, Summary, summarise, validate};
use crate::detect::DetectOptions;
use crate::geometry::Point;
use crate::image;
use crate::mosaic::LengthUnit;
use crate::mosaic::io::{ReadOptions, read_coordinates};
use crate::report::Cell;
use std::path::{Path, PathBuf};

/// Where detections come from.
#[derive(Clone, Debug)]
pub enum Detected {
    /// Coordinate files NAME.csv of any program.
    Folder {
        /// The folder.
        folder: PathBuf,
        /// How its files are to be understood.
        read: ReadOptions,
    },
    /// This program, on images NAME.png or .tif.
    Images {
        /// The folder.
        folder: PathBuf,
        /// How cones are found.
        detect: DetectOptions,
    },
}

/// How detections are held against hand marks.
#[derive(Clone, Debug)]
pub struct ValidationOptions {
    /// How the marks are to be understood.
    pub read: ReadOptions,
    /// Where detections come from.
    pub detected: Detected,
    /// Width and height of all images in px; `None`: from the image beside the marks or in the folder of images.
    pub size: Option<(usize, usize)>,
    /// Which detection belongs to which mark.
    pub matching: MatchOptions,
}

/// The score of one image.
#[derive(Clone, Debug)]
pub struct ValidationRow {
    /// The file of marks, as given.
    pub file: String,
    /// The image's name.
    pub name: String,
    /// How well detections and marks agree.
    pub score: Score,
}

/// What came of a validation.
#[derive(Clone, Debug)]
pub struct ValidationOutcome {
    /// One row an image, in order of the files of marks.
    pub rows: Vec<ValidationRow>,
    /// Means and pooled rates; `None` without an image.
    pub summary: Option<Summary>,
    /// Marks that could not be scored.
    pub failures: Vec<Failure>,
    /// Files beside the marks that belong to no image: tables of scales and the like.
    pub ignored: Vec<PathBuf>,
}

type Column = (&'static str, fn(&Score) -> Cell);

const COLUMNS: &[Column] = &[
    ("tp", |s| s.tp.into()),
    ("fn", |s| s.fn_.into()),
    ("fp", |s| s.fp.into()),
    ("sensitivity", |s| s.sensitivity.into()),
    ("fdr", |s| s.fdr.into()),
    ("dice", |s| s.dice.into()),
    ("precision", |s| s.precision.into()),
    ("localisation_px", |s| s.localisation_px.into()),
    ("localisation_s", |s| s.localisation_s.into()),
    ("density_ratio", |s| s.density_ratio.into()),
    ("n_marks", |s| s.n_marks.into()),
    ("n_detections", |s| s.n_detections.into()),
    ("limit_px", |s| s.limit_px.into()),
    ("assignment", |s| s.assignment.name().into()),
];

/// Scores every file of marks in `reference` (`NAME_coords.csv` or `NAME.csv`) and writes `validation.csv` and
/// `validation.json` (means and pooled rates).
///
/// # Errors
/// If there are no marks or `out` cannot be written to. Marks that fail are in the outcome and in `failures.csv`.
pub fn validate_files(
    reference: &Path,
    options: &ValidationOptions,
    out: &Path,
    progress: &dyn Progress,
) -> Result<ValidationOutcome, BatchError> {
    let (Detected::Folder { folder, .. } | Detected::Images { folder, .. }) = &options.detected;
    folder.read_dir().map_err(|source| BatchError::Unreadable { path: folder.clone(), source })?;
    let (marks, ignored) = marks_in(reference, options, out)?;
    let out = OutputFolder::create(out)?;
    let (rows, failures) = for_each(&marks, progress, |input| {
        let name = image_name(&input.path);
        let truth = read_pixels(&input.path, &options.read)?;
        let (found, size) = detections_of(input, reference, options)?;
        let (width, height) = match options.size.or(size) {
            Some(size) => size,
            None => size_of_image(input)?,
        };
        let (score, _) = validate(&truth, &found, width, height, &options.matching)?;
        let line = format!("Dice {:.4}", score.dice);
        Ok((ValidationRow { file: input.path.display().to_string(), name, score }, line))
    });
    let table: Vec<Vec<Cell>> = rows
        .iter()
        .map(|r| {
            [r.file.as_str().into()].into_iter().chain(COLUMNS.iter().map(|(_, v)| v(&r.score))).collect()
        })
        .collect();
    let header: Vec<String> =
        ["file"].into_iter().chain(COLUMNS.iter().map(|(name, _)| *name)).map(str::to_owned).collect();
    out.write_table("validation.csv", &header, &table)?;
    let summary = summarise(&rows.iter().map(|r| r.score).collect::<Vec<_>>());
    let mut json = serde_json::to_vec_pretty(&summary)?;
    json.push(b'\n');
    out.write("validation.json", &json)?;
    write_failures(&out, &failures)?;
    Ok(ValidationOutcome { rows, summary, failures, ignored })
}

/// The files of marks, one an image, and what else lies there: a file counts if it is called `…_coords` or an image
/// or a detection has its name.
fn marks_in(
    reference: &Path,
    options: &ValidationOptions,
    out: &Path,
) -> Result<(Vec<Input>, Vec<PathBuf>), BatchError> {
    let files = coordinate_files(&[reference.to_owned()], Some(out))?;
    let belongs = |input: &Input| {
        says_coords(&input.path)
            || image_beside(&input.path).is_some()
            || partner(input, reference, &options.detected).is_some()
    };
    let (mut marks, ignored): (Vec<Input>, Vec<Input>) = files.into_iter().partition(belongs);
    let twice: Vec<PathBuf> = marks.iter().filter(|m| says_coords(&m.path)).map(|m| m.path.clone()).collect();
    marks.retain(|m| {
        says_coords(&m.path)
            || !twice.iter().any(|t| t.parent() == m.path.parent() && image_name(t) == image_name(&m.path))
    });
    if marks.is_empty() {
        let paths = reference.display().to_string();
        let expected = "NAME_coords.csv, or NAME.csv beside NAME.png or NAME.tif";
        return Err(BatchError::Nothing { what: "hand marks", paths, expected });
    }
    Ok((marks, ignored.into_iter().map(|i| i.path).collect()))
}

type Found = (Vec<Point>, Option<(usize, usize)>);

/// The detections or the image that belong to a file of marks: in the folder that lies below the one given as the
/// marks lie below the reference, or in the one given itself. Never the marks themselves.
fn partner(marks: &Input, reference: &Path, detected: &Detected) -> Option<PathBuf> {
    let name = image_name(&marks.path);
    let below = marks.path.parent().and_then(|p| p.strip_prefix(reference).ok()).unwrap_or(Path::new(""));
    let (Detected::Folder { folder, .. } | Detected::Images { folder, .. }) = detected;
    [folder.join(below), folder.clone()].into_iter().find_map(|folder| match detected {
        Detected::Folder { .. } => {
            let path = folder.join(format!("{name}.csv"));
            (path.is_file() && path.canonicalize().ok() != marks.path.canonicalize().ok()).then_some(path)
        }
        Detected::Images { .. } => image_in(&folder, &name),
    })
}

/// Points of a file in px.
fn read_pixels(path: &Path, read: &ReadOptions) -> Result<Vec<Point>, BatchError> {
    let file = read_coordinates(path, read)?;
    match file.unit {
        Some(unit) if unit != LengthUnit::Pixel => Err(BatchError::NotPixels { file: path.to_owned(), unit }),
        _ => Ok(file.points),
    }
}

fn detections_of(input: &Input, reference: &Path, options: &ValidationOptions) -> Result<Found, BatchError> {
    let name = image_name(&input.path);
    let path = partner(input, reference, &options.detected);
    let missing = |problem: String| BatchError::Pairing { file: input.path.clone(), problem };
    match &options.detected {
        Detected::Folder { folder, read } => {
            let path =
                path.ok_or_else(|| missing(format!("no detections {name}.csv in {}", folder.display())))?;
            Ok((read_pixels(&path, read)?, None))
        }
        Detected::Images { folder, detect } => {
            let path = path.ok_or_else(|| {
                missing(format!("no image {name}.png or {name}.tif in {}", folder.display()))
            })?;
            let input = Input { path, name };
            let (_, image) = read_image(&input)?;
            let found = detect_in(&input, &image, detect)?;
            Ok((found.centres(), Some((image.ncols(), image.nrows()))))
        }
    }
}

fn size_of_image(input: &Input) -> Result<(usize, usize), BatchError> {
    let path = image_beside(&input.path).ok_or_else(|| BatchError::Pairing {
        file: input.path.clone(),
        problem: "no image of that name beside it to take the size from: give --size WxH".into(),
    })?;
    let (height, width) = image::read(&path)?.dim();
    Ok((width, height))
}
