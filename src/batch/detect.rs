use super::analysis::CONFIDENT;
use super::output::{Ending, ResultFolder, Standing, for_each, write_failures};
use super::window::Cut;
use super::{BatchError, Failure, Input, Progress, ScaleSource};
use crate::detect::{DetectOptions, Detection, Detections, detect};
use crate::geometry::Point;
use crate::image::{Plane, decode, read_bytes};
use crate::mosaic::Scale;
use crate::mosaic::io::format_points;
use crate::report::{MarkKind, OverlayMark, counted, encode_png, overlay};
use std::path::Path;

/// Radius of the ring drawn around each cone, in cone spacings. It is less than half a spacing, so
/// that the rings of neighbours stay apart.
const RING: f64 = 0.3;

/// Results of detecting cones in a batch of images.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DetectionOutcome {
    /// Number of images with results.
    pub images: usize,
    /// Total number of cones found.
    pub cones: usize,
    /// Images without results, each with the reason.
    pub failures: Vec<Failure>,
    /// End of the batch: complete, or stopped early.
    pub ending: Ending,
}

/// Options of [`detect_files`]: additional files to write, and whether corrections may be replaced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DetectionExtras {
    /// `true` to write `NAME.overlay.png`: the image with its cones marked.
    pub overlay: bool,
    /// `true` to write `NAME.rejected.csv`: the candidates that the detector considered and
    /// rejected.
    pub rejected: bool,
    /// `true` to replace files of coordinates that a person made or corrected; the replaced files
    /// are moved to the folder of earlier results. `false` to process no image to which such a file
    /// belongs, and to report it as failed.
    pub replace_corrections: bool,
}

/// Detects cones in every image and writes `NAME.csv`, and the additional files that `extras` asks
/// for, into `out`.
///
/// `NAME.csv` has the columns x_px, y_px and score, and also x_um and y_um if the scale is known.
///
/// # Errors
/// Fails if `out` cannot be written to. Images that fail are listed in the outcome and in
/// `failures.csv`.
pub fn detect_files(
    inputs: &[Input],
    options: &DetectOptions,
    scales: &ScaleSource,
    extras: DetectionExtras,
    out: &Path,
    progress: &dyn Progress,
) -> Result<DetectionOutcome, BatchError> {
    let out = ResultFolder::open(out)?;
    let worked = for_each(inputs, progress, |input| {
        if input.name.eq_ignore_ascii_case("failures") {
            return Err(BatchError::Reserved { file: input.path.clone() });
        }
        let (_, image) = read_image(input)?;
        let scale = scales.scale_of(&input.path, image.ncols())?;
        let names = ["csv", "rejected.csv"].map(|kind| format!("{}.{kind}", input.name));
        let [cones, rejected] = &names;
        if !extras.replace_corrections {
            refuse_foreign(&out, cones)?;
            if extras.rejected {
                refuse_foreign(&out, rejected)?;
            }
        }
        let found = detect_in(input, &image, options)?;
        out.write(cones, &formatted(&found.cones, scale))?;
        if extras.rejected {
            out.write(rejected, &formatted(&found.rejected, scale))?;
        }
        if extras.overlay {
            out.write(&format!("{}.overlay.png", input.name), &overlay_of(&image, &found)?)?;
        }
        Ok((found.cones.len(), describe(&found)))
    });
    write_failures(&out, &worked.failures)?;
    let ending = out.close(worked.left)?;
    let cones = worked.done.iter().sum();
    Ok(DetectionOutcome { images: worked.done.len(), cones, failures: worked.failures, ending })
}

/// Fails if the file `name` was made or changed by a person, so that it is not replaced. Hand marks
/// may have the same name as a file of detections, and like corrections they are hours of work.
fn refuse_foreign(out: &ResultFolder, name: &str) -> Result<(), BatchError> {
    match out.standing(name) {
        Standing::Missing | Standing::Own => Ok(()),
        Standing::Changed => Err(BatchError::Foreign { path: out.join(name) }),
    }
}

/// Reads an image file. Returns its bytes and the decoded image.
pub(super) fn read_image(input: &Input) -> Result<(Vec<u8>, Plane), BatchError> {
    let bytes = read_bytes(&input.path)?;
    let image = decode(&bytes, &input.path.display().to_string())?;
    Ok((bytes, image))
}

/// Detects cones in an image. An error names the image file.
pub(super) fn detect_in(
    input: &Input,
    image: &Plane,
    options: &DetectOptions,
) -> Result<Detections, BatchError> {
    detect(image, options).map_err(|source| BatchError::Detect { file: input.path.clone(), source })
}

/// Detects cones in the part of an image that its window leaves, in px of the whole image, so that
/// nothing outside the window has a say.
pub(super) fn detect_within(
    input: &Input,
    image: &Plane,
    cut: Option<&Cut>,
    options: &DetectOptions,
) -> Result<Detections, BatchError> {
    let Some(cut) = cut else { return detect_in(input, image, options) };
    let mut found = detect_in(input, &cut.part, options)?;
    found.move_by(cut.left, cut.top);
    Ok(found)
}

/// Returns the content of a CSV file of detections: columns x_px, y_px and score, and also x_um and
/// y_um if the scale is known.
pub(super) fn formatted(found: &[Detection], scale: Option<Scale>) -> Vec<u8> {
    let centres: Vec<Point> = found.iter().map(|d| d.centre).collect();
    let scores: Vec<f64> = found.iter().map(|d| d.score).collect();
    format_points(&centres, Some(&scores), scale).into_bytes()
}

/// Draws a ring around each of `points` on the image and encodes the result as PNG.
///
/// `spacing` is the cone spacing in px; `None` if it is unknown, as for a single cone.
pub(super) fn mark_cones(
    image: &Plane,
    points: &[Point],
    spacing: Option<f64>,
) -> Result<Vec<u8>, BatchError> {
    // a single cone has no spacing: 10 px give a visible ring
    let spacing = spacing.unwrap_or(10.);
    let mark = |p: &Point| OverlayMark { x: p.x, y: p.y, radius: RING * spacing, kind: MarkKind::Detection };
    let marks: Vec<OverlayMark> = points.iter().map(mark).collect();
    Ok(encode_png(&overlay(image, &marks, spacing))?)
}

/// Draws a ring around each detected cone on the image and encodes the result as PNG.
pub(super) fn overlay_of(image: &Plane, found: &Detections) -> Result<Vec<u8>, BatchError> {
    let marks: Vec<OverlayMark> = found
        .cones
        .iter()
        .map(|d| OverlayMark {
            x: d.centre.x,
            y: d.centre.y,
            radius: RING * found.spacing_map.at(d.centre),
            kind: MarkKind::Detection,
        })
        .collect();
    Ok(encode_png(&overlay(image, &marks, found.spacing))?)
}

/// Returns the line that is shown to the user about the detections in one image.
pub(super) fn describe(found: &Detections) -> String {
    let cones = counted(found.cones.len(), "cone");
    let doubt = |confidence: f64| if confidence < CONFIDENT { " (uncertain)" } else { "" };
    let [modality, spacing] = [found.modality_confidence, found.spacing_confidence].map(doubt);
    format!("{cones}, {}{modality}, spacing {:.1} px{spacing}", found.modality, found.spacing)
}
