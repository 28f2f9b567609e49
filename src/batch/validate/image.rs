//! Validation of one image: its marks, its detections, and the agreement of the two.

use super::pairs::Pairs;
use super::{Detected, ValidationRow, VersusRow};
use crate::batch::detect::{detect_in, read_image};
use crate::batch::input::image_name;
use crate::batch::output::OutputFolder;
use crate::batch::{BatchError, Input};
use crate::compare::{JudgedImage, MatchOptions, Matching, Score, judge, turned, validate};
use crate::detect::Detection;
use crate::geometry::Point;
use crate::image::Plane;
use crate::mosaic::io::{ReadOptions, read_coordinates};
use crate::mosaic::{LengthUnit, hexagonal_spacing};
use crate::report::{MarkKind, OverlayMark, encode_png, overlay_with_border};
use std::path::Path;

/// Radius of the ring drawn around each point, in hexagonal spacings of the marks. It is less than
/// half a spacing, so that the rings of neighbours stay apart.
const RING: f64 = 0.3;

/// Detected points, from a file or by the detector.
struct Found {
    /// Positions of the points, in px.
    points: Vec<Point>,
    /// One score per point; `None` if the file has no scores.
    scores: Option<Vec<f64>>,
    /// Candidates that the detector rejected; empty for a file. They continue the FROC curve below
    /// the detector's threshold.
    rejected: Vec<Detection>,
}

/// Scores the detections of the image to which a file of marks belongs, and draws an overlay if
/// asked to.
pub(super) fn score(input: &Input, pairs: &Pairs, out: &OutputFolder) -> Result<ValidationRow, BatchError> {
    let options = pairs.options;
    let group = match &options.grouping {
        Some(grouping) => {
            let named = grouping.group_of(&input.name);
            Some(named.map_err(|problem| BatchError::Pairing { file: input.path.clone(), problem })?)
        }
        None => None,
    };
    let marks = read(&input.path, &options.read)?.points;
    let is_detector = |d: &Detected| matches!(d, Detected::Detector(_));
    let to_detect = is_detector(&options.detected) || options.versus.as_ref().is_some_and(is_detector);
    let image = if to_detect || options.overlays || options.size.is_none() {
        Some(picture(input, pairs, to_detect || options.overlays)?)
    } else {
        None
    };
    let shape = image.as_ref().map_or((0, 0), |image| (image.ncols(), image.nrows()));
    let size = options.size.unwrap_or(shape);
    let scale = options.scales.scale_of(&input.path, size.0)?;
    let against =
        Against { size, um_per_px: scale.map(|s| s.micrometres_per_pixel()), matching: &options.matching };

    let found = find(input, &options.detected, pairs, image.as_ref())?;
    let (score, matching, judged) = against.marks(&marks, &found)?;
    let all = score.n_marks + score.n_detections;
    if all > 0 && score.marks_inside + score.detections_inside == 0 {
        return Err(BatchError::Pairing {
            file: input.path.clone(),
            problem: format!(
                "nothing to score: all {} marks and {} detections lie in the border of {} px that is not \
                 counted, or outside the image of {} × {} px: give a narrower border, or check size and \
                 coordinates",
                score.n_marks, score.n_detections, options.matching.border, size.0, size.1
            ),
        });
    }
    let turned = turned(&marks, &found.points, size, &options.matching, score.strict.dice)?;
    if let (true, Some(image)) = (options.overlays, &image) {
        let marked = drawn(&marks, &found.points, &matching, &score);
        let picture = overlay_with_border(image, &marked, spacing_of(&score), options.matching.border);
        out.write(&format!("{}.overlay.png", input.name), &encode_png(&picture)?)?;
    }
    let versus = match &options.versus {
        Some(versus) => {
            let other = find(input, versus, pairs, image.as_ref())?;
            let (score, _, judged) = against.marks(&marks, &other)?;
            let (between, ..) = against.marks(&other.points, &found)?;
            Some(VersusRow { score, judged, between })
        }
        None => None,
    };
    let expected_false_alarms = found.scores.as_ref().and_then(|scores| expected(scores, &matching));
    let file = input.path.display().to_string();
    Ok(ValidationRow {
        file,
        name: input.name.clone(),
        group,
        score,
        judged,
        expected_false_alarms,
        turned,
        versus,
    })
}

/// Settings for scoring the detections of one image: its size in px, its scale and the options of
/// pairing.
struct Against<'a> {
    size: (usize, usize),
    um_per_px: Option<f64>,
    matching: &'a MatchOptions,
}

impl Against<'_> {
    /// Pairs detections with marks. Returns the score, the pairs, and the outcomes of all
    /// detections with rejected candidates; the outcomes are `None` if the detections have no
    /// scores.
    fn marks(
        &self,
        marks: &[Point],
        found: &Found,
    ) -> Result<(Score, Matching, Option<JudgedImage>), BatchError> {
        let (width, height) = self.size;
        let (score, matching) = validate(marks, &found.points, width, height, self.matching)?;
        let score = Score { um_per_px: self.um_per_px, ..score };
        let judged = match &found.scores {
            Some(scores) => {
                let rejected = &found.rejected;
                let points: Vec<Point> =
                    found.points.iter().copied().chain(rejected.iter().map(|d| d.centre)).collect();
                let scores: Vec<f64> =
                    scores.iter().copied().chain(rejected.iter().map(|d| d.score)).collect();
                let judged = judge(marks, &points, &scores, self.size, self.matching)?;
                Some(JudgedImage { area_mm2: score.area_mm2(), ..judged })
            }
            None => None,
        };
        Ok((score, matching, judged))
    }
}

/// Returns the number of false alarms that the scores predict: the sum of 1 − score over the
/// detections that count as hits or false alarms. Returns `None` if the score of such a detection
/// is missing or not between 0 and 1.
fn expected(scores: &[f64], matching: &Matching) -> Option<f64> {
    let hits = matching.pairs.iter().filter(|p| p.counted).map(|p| p.detection);
    let mut counted: Vec<usize> = hits.chain(matching.false_alarms.iter().copied()).collect();
    // a fixed order of summation gives the same last digits whatever the order of the pairs
    counted.sort_unstable();
    let lack = |d: usize| scores.get(d).filter(|s| (0. ..=1.).contains(*s)).map(|s| 1. - s);
    counted.into_iter().map(lack).sum()
}

/// Reads the image that belongs to a file of marks. `pixels_matter` is `false` if only the size of
/// the image is needed; it only affects the error message.
fn picture(input: &Input, pairs: &Pairs, pixels_matter: bool) -> Result<Plane, BatchError> {
    let name = image_name(&input.path);
    let missing = || match (&pairs.options.images, pixels_matter) {
        (Some(given), _) => nothing_in(given, &format!("image {name}.png or {name}.tif")),
        (None, true) => {
            format!("no image {name}.png or {name}.tif lies beside it: give the folder of the images")
        }
        (None, false) => {
            "the size of its image is not known, since no image of its name lies beside it: give the size \
             of the images, or their folder"
                .into()
        }
    };
    let path = pairs
        .image(&input.path)
        .ok_or_else(|| BatchError::Pairing { file: input.path.clone(), problem: missing() })?;
    Ok(read_image(&Input { path, name })?.1)
}

/// Returns the error text for files that were not found. `given` is the folder that was searched,
/// or the file that the user named instead of a folder and that has another name. `sought`
/// describes the files.
fn nothing_in(given: &Path, sought: &str) -> String {
    let given_as = given.display();
    if given.is_file() {
        format!(
            "{given_as} has another name, so it does not belong to these marks: give a folder, or the {sought}"
        )
    } else {
        format!("no {sought} in {given_as}: add the file, or give another folder")
    }
}

/// Reads the detections that belong to a file of marks, or finds them in the image.
fn find(
    input: &Input,
    detected: &Detected,
    pairs: &Pairs,
    image: Option<&Plane>,
) -> Result<Found, BatchError> {
    let missing = |problem: String| BatchError::Pairing { file: input.path.clone(), problem };
    match (detected, image) {
        (Detected::Files { path: given, read: options }, _) => {
            let path = pairs.detections(&input.path, detected).ok_or_else(|| {
                missing(nothing_in(given, &format!("detections {}.csv", image_name(&input.path))))
            })?;
            read(&path, options)
        }
        (Detected::Detector(options), Some(image)) => {
            let path = pairs.image(&input.path).unwrap_or_else(|| input.path.clone());
            let found = detect_in(&Input { path, name: input.name.clone() }, image, options)?;
            let scores = found.cones.iter().map(|d| d.score).collect();
            Ok(Found { points: found.centres(), scores: Some(scores), rejected: found.rejected })
        }
        (Detected::Detector(_), None) => {
            Err(missing("no image to detect cones in: give the folder of the images".into()))
        }
    }
}

/// Reads the points of a file in px. A file without points counts as a file with scores, since no
/// score is missing.
fn read(path: &Path, options: &ReadOptions) -> Result<Found, BatchError> {
    let file = read_coordinates(path, options)?;
    match file.unit {
        Some(unit) if unit != LengthUnit::Pixel => Err(BatchError::NotPixels { file: path.to_owned(), unit }),
        _ => {
            let scores = file.scores.or_else(|| file.points.is_empty().then(Vec::new));
            Ok(Found { points: file.points, scores, rejected: Vec::new() })
        }
    }
}

/// Returns the hexagonal spacing of the marks in px; without marks, the largest distance allowed in
/// a pair.
fn spacing_of(score: &Score) -> f64 {
    hexagonal_spacing(score.marks_inside, score.area_px).unwrap_or(score.limit_px)
}

/// Returns the rings of an overlay: hits, misses, false alarms, and in grey the detections that do
/// not count, because they lie in the border strip or are paired with a mark there.
fn drawn(marks: &[Point], found: &[Point], matching: &Matching, score: &Score) -> Vec<OverlayMark> {
    let radius = RING * spacing_of(score);
    let mark = |p: Point, kind: MarkKind| OverlayMark { x: p.x, y: p.y, radius, kind };
    let uncounted = (0..found.len()).filter(|&d| matching.detections_in_border[d]);
    let lost = matching.pairs.iter().filter(|p| !p.counted && !matching.detections_in_border[p.detection]);
    let hits = matching.pairs.iter().filter(|p| p.counted).map(|p| p.detection);
    uncounted
        .chain(lost.map(|p| p.detection))
        .map(|d| mark(found[d], MarkKind::Uncounted))
        .chain(hits.map(|d| mark(found[d], MarkKind::Hit)))
        .chain(matching.misses.iter().map(|&m| mark(marks[m], MarkKind::Miss)))
        .chain(matching.false_alarms.iter().map(|&d| mark(found[d], MarkKind::FalseAlarm)))
        .collect()
}
