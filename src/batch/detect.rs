use super::failures::write_failures;
use super::measured::CONFIDENT;
use super::outputs::OutputFolder;
use super::work::for_each;
use super::{BatchError, Failure, Input, Progress, ScaleSource};
use crate::detect::{DetectOptions, Detection, Detections, detect};
use crate::geometry::Point;
use crate::image::{Plane, decode, read_bytes};
use crate::mosaic::Scale;
use crate::mosaic::io::write_points;
use crate::report::{MarkKind, OverlayMark, counted, encode_png, overlay};
use std::fs;
use std::io::Read;
use std::path::Path;

/// Radius of the rings of an overlay, in cone spacings: inside the cone, so that neighbours' rings stay apart.
const RING: f64 = 0.3;

/// How a file of detections begins.
const DETECTIONS: &[u8] = b"x_px,y_px,score";

/// What came of detecting cones in a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DetectionOutcome {
    /// Images with results.
    pub images: usize,
    /// Cones found in all of them.
    pub cones: usize,
    /// Images without.
    pub failures: Vec<Failure>,
}

/// What is written beside the cones of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DetectionExtras {
    /// `NAME.overlay.png`: the image with its cones marked.
    pub overlay: bool,
    /// `NAME.rejected.csv`: candidates that were not taken for cones.
    pub rejected: bool,
}

/// Writes `NAME.csv` (x_px, y_px, score) for every image, and what `extras` says.
///
/// # Errors
/// If `out` cannot be written to. Images that fail are in the outcome and in `failures.csv`.
pub fn detect_files(
    inputs: &[Input],
    options: &DetectOptions,
    scales: &ScaleSource,
    extras: DetectionExtras,
    out: &Path,
    progress: &dyn Progress,
) -> Result<DetectionOutcome, BatchError> {
    let out = OutputFolder::create(out)?;
    let (cones, failures) = for_each(inputs, progress, |input| {
        if input.name.eq_ignore_ascii_case("failures") {
            return Err(BatchError::Reserved { file: input.path.clone() });
        }
        let (_, image) = read_image(input)?;
        let found = detect_in(input, &image, options)?;
        let scale = scales.scale_of(&input.path, image.ncols())?;
        let path = out.join(format!("{}.csv", input.name));
        refuse_foreign(&path)?;
        write_detections(&path, &found.cones, scale)?;
        if extras.rejected {
            let path = out.join(format!("{}.rejected.csv", input.name));
            refuse_foreign(&path)?;
            write_detections(&path, &found.rejected, scale)?;
        }
        if extras.overlay {
            out.write(&format!("{}.overlay.png", input.name), &overlay_of(&image, &found)?)?;
        }
        Ok((found.cones.len(), describe(&found)))
    });
    write_failures(&out, &failures)?;
    Ok(DetectionOutcome { images: cones.len(), cones: cones.iter().sum(), failures })
}

/// Hand marks may be called as detections are, and hours of work: only detections are replaced.
fn refuse_foreign(path: &Path) -> Result<(), BatchError> {
    let Ok(file) = fs::File::open(path) else { return Ok(()) };
    let mut start = Vec::new();
    let readable = file.take(DETECTIONS.len() as u64).read_to_end(&mut start).is_ok();
    if readable && start == DETECTIONS {
        return Ok(());
    }
    Err(BatchError::Foreign { path: path.to_owned() })
}

/// The bytes of the file and the image in them.
pub(super) fn read_image(input: &Input) -> Result<(Vec<u8>, Plane), BatchError> {
    let bytes = read_bytes(&input.path)?;
    let image = decode(&bytes, &input.path.display().to_string())?;
    Ok((bytes, image))
}

pub(super) fn detect_in(
    input: &Input,
    image: &Plane,
    options: &DetectOptions,
) -> Result<Detections, BatchError> {
    detect(image, options).map_err(|source| BatchError::Detect { file: input.path.clone(), source })
}

pub(super) fn write_detections(
    path: &Path,
    found: &[Detection],
    scale: Option<Scale>,
) -> Result<(), BatchError> {
    let centres: Vec<Point> = found.iter().map(|d| d.centre).collect();
    let scores: Vec<f64> = found.iter().map(|d| d.score).collect();
    Ok(write_points(path, &centres, Some(&scores), scale)?)
}

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

/// One line about what was found.
pub(super) fn describe(found: &Detections) -> String {
    let cones = counted(found.cones.len(), "cone");
    let doubt = |confidence: f64| if confidence < CONFIDENT { " (uncertain)" } else { "" };
    let [modality, spacing] = [found.modality_confidence, found.spacing_confidence].map(doubt);
    format!("{cones}, {}{modality}, spacing {:.1} px{spacing}", found.modality, found.spacing)
}
