//! Results of an earlier run that still hold.
//!
//! They do if image, options, cones and program are the same and every file is as it was written.

use super::cones::Origin;
use super::done::{Done, METRICS, POINTS};
use super::{FAILED, IMAGES, Job};
use crate::batch::analysis::Plan;
use crate::batch::input::Label;
use crate::batch::output::hex;
use crate::batch::{BatchError, Input};
use crate::geometry::Window;
use crate::mosaic::Scale;
use crate::report::tables::RoiRow;
use crate::report::{ConesFrom, ImageRecord, LandmarkRecord};
use serde::Deserialize;
use sha2::{Digest, Sha256};
use std::fs;

/// Parts of `metrics.json` beside the record that are read back.
#[derive(Deserialize)]
struct Kept {
    #[serde(default)]
    landmarks: Option<LandmarkRecord>,
    #[serde(default)]
    regions: Vec<RoiRow>,
}

/// Returns a hash of everything but the image that its results depend on: the program with all its
/// weights, the plan, scale, window, labels and origin of the cones.
pub(super) fn fingerprint(
    plan: &Plan,
    scale: Option<Scale>,
    window: &Window,
    label: &Label,
    origin: &Origin,
) -> Result<String, BatchError> {
    let relevant = (BUILD, plan.identity(), scale, window, (&label.labels, label.place, &label.warning));
    let mut digest = Sha256::new_with_prefix(serde_json::to_vec(&relevant)?);
    origin.identify(&mut digest)?;
    Ok(hex(&digest.finalize()))
}

/// A hash of the program's source and weights, made when it was built.
const BUILD: &str = env!("CONEMOSAIC_BUILD_HASH");

/// Returns the results of an earlier run for an image; `None` unless they are complete, unchanged
/// and of the same image and options.
pub(super) fn earlier(job: &Job, input: &Input, sha256: &str, options_sha256: &str) -> Option<Done> {
    let plan = &job.options.plan;
    let folder = job.images.join(&input.name);
    let text = fs::read(folder.join(METRICS)).ok()?;
    let record: ImageRecord = serde_json::from_slice(&text).ok()?;
    if record.sha256 != sha256 || record.options_sha256 != options_sha256 {
        return None;
    }
    // corrected cones differ from what was written, and are already part of `options_sha256`
    let corrected = record.cones_from == ConesFrom::Corrected;
    let aside: &[&str] = if corrected { &[FAILED, POINTS] } else { &[FAILED] };
    let whole = job.out.is_whole(&format!("{IMAGES}/{}/", input.name), aside);
    if !whole || record.fourier.is_none() && plan.wants_fourier() {
        return None;
    }
    let Kept { landmarks, regions } = serde_json::from_slice(&text).ok()?;
    if landmarks.is_some() != plan.maps.is_some() {
        return None;
    }
    // an earlier failure is over; a note that cannot be removed does no harm
    let _ = fs::remove_file(folder.join(FAILED));
    let file = input.path.display().to_string();
    let landmarks = landmarks.map(|l| LandmarkRecord { file: file.clone(), ..l });
    let regions = regions.into_iter().map(|r| RoiRow { file: file.clone(), ..r }).collect();
    let record = ImageRecord { file, name: input.name.clone(), ..record };
    Some(Done { record, landmarks, regions, seconds: None })
}
