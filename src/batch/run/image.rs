//! Work on one image of a run: finding the cones, analysing them and writing the image's folder.

use super::cones::{Cones, Origin, cones_of};
use super::done::{Done, METRICS, OVERLAY, POINTS, Seconds, earlier_cones};
use super::record::metrics;
use super::resume::{earlier, fingerprint};
use super::{IMAGES, Job};
use crate::batch::analysis::{Analysis, Layout, Specimen, analyse, write};
use crate::batch::detect::{mark_cones, overlay_of, read_image};
use crate::batch::output::{Standing, hex};
use crate::batch::{BatchError, Input};
use crate::image::Plane;
use crate::mosaic::{LengthUnit, Mosaic};
use crate::report::{ConesFrom, DetectionRecord, ImageRecord};
use sha2::{Digest, Sha256};
use std::time::Instant;

/// Processes one image and writes its folder, or keeps the results of an earlier run if they are
/// still valid. Returns the results that stay in memory, and the line that is shown to the user.
pub(super) fn one_image(input: &Input, job: &Job) -> Result<(Done, String), BatchError> {
    let mut clock = Instant::now();
    // returns the seconds since the last call, as each stage ends
    let mut lap = || std::mem::replace(&mut clock, Instant::now()).elapsed().as_secs_f64();
    let plan = &job.options.plan;
    let (bytes, image) = read_image(input)?;
    let sha256 = hex(&Sha256::digest(&bytes));
    drop(bytes);
    let scale = plan.scales.scale_of(&input.path, image.ncols())?;
    let window = job.windows.of(&input.path, &image, scale)?;
    let label = plan.labels.of(&input.path, scale)?;
    let origin = job.origin(input, &image, &window)?;
    let options_sha256 = fingerprint(plan, scale, &window, &label, &origin)?;
    if !job.options.fresh
        && let Some(kept) = earlier(job, input, &sha256, &options_sha256)
    {
        job.out.keep(&format!("{IMAGES}/{}/", input.name));
        let line = format!("{} cones, kept from an earlier run", kept.record.mosaic.n);
        return Ok((kept, line));
    }
    let read = lap();

    let cones = cones_of(&origin, input, &image, &window, scale, job)?;
    let detect = lap();
    let (mosaic, _) = Mosaic::new(cones.points.clone(), window, LengthUnit::Pixel, scale)
        .map_err(|source| BatchError::Mosaic { file: input.path.clone(), source })?;
    let specimen =
        Specimen { input, mosaic, outside: cones.outside, image: Some(&image), found: cones.found.as_ref() };
    let mut analysis = analyse(&specimen, plan, &job.references)?;
    analysis.warnings.extend(job.windows.warning(&image));
    let [measure, compare] = analysis.seconds;
    lap();

    let record = record_of(input, &image, &cones, &analysis, [sha256, options_sha256]);
    job.replace(input, &origin, |folder| {
        folder.write(POINTS, &cones.csv)?;
        folder.write(OVERLAY, &picture(&image, &cones, &specimen)?)?;
        write(&analysis, &specimen, plan, folder, Layout::Folder)?;
        folder.write_json(METRICS, &metrics(&record, &analysis))
    })?;
    let seconds = Seconds { read, detect, measure, compare, report: lap() };
    let line = cones.line();
    tracing::debug!(file = record.file, cones = record.mosaic.n, line);
    tracing::trace!(file = record.file, ?seconds);
    let Analysis { landmarks, regions, .. } = analysis;
    Ok((Done { record, landmarks, regions, seconds: Some(seconds) }, line))
}

impl Job<'_> {
    /// Replaces the folder of an image with a new one that `fill` writes.
    ///
    /// If an earlier run used a person's corrections and this run does not, the corrected
    /// `points.csv` is first copied to the folder of earlier results. The same is done if the
    /// record of the earlier run does not state the origin of its cones.
    fn replace(
        &self,
        input: &Input,
        origin: &Origin,
        fill: impl FnOnce(&crate::batch::output::OutputFolder) -> Result<(), BatchError>,
    ) -> Result<(), BatchError> {
        let listed = format!("{IMAGES}/{}/{POINTS}", input.name);
        let from = earlier_cones(&self.images.join(&input.name));
        let at_risk = from.is_none_or(|from| from == ConesFrom::Corrected);
        if !matches!(origin, Origin::Corrected(_)) && at_risk && self.out.standing(&listed) == Standing::Own {
            self.out.copy_away(&listed)?;
        }
        self.images.replace_folder(&input.name, fill)
    }
}

/// Draws the cones of an image on the image and encodes the result as PNG.
fn picture(image: &Plane, cones: &Cones, specimen: &Specimen) -> Result<Vec<u8>, BatchError> {
    match &cones.found {
        Some(found) => overlay_of(image, found),
        None => mark_cones(image, &cones.points, specimen.mosaic.hexagonal_spacing()),
    }
}

/// Collects the record of an image.
fn record_of(
    input: &Input,
    image: &Plane,
    cones: &Cones,
    analysis: &Analysis,
    [sha256, options_sha256]: [String; 2],
) -> ImageRecord {
    let (height, width) = image.dim();
    ImageRecord {
        file: input.path.display().to_string(),
        name: input.name.clone(),
        sha256,
        options_sha256,
        width_px: width,
        height_px: height,
        cones_from: cones.from,
        outside: cones.outside,
        detection: cones.found.as_ref().map(|found| DetectionRecord::new(found, cones.all)),
        fourier: analysis.fourier,
        mosaic: analysis.record.clone(),
        warnings: analysis.warnings.clone(),
        odd_one_out: false,
    }
}
