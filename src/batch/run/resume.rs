//! Check of whether the results of an earlier run are still valid for an image.
//!
//! The results are valid if image, options, cones and program are the same and every file is
//! unchanged.

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

/// Parts of `metrics.json`, besides the record of the image, that are read back.
#[derive(Deserialize)]
struct Kept {
    #[serde(default)]
    landmarks: Option<LandmarkRecord>,
    #[serde(default)]
    regions: Vec<RoiRow>,
}

/// Returns a hash of everything on which the results of an image depend, except the image itself.
/// The hash covers the program with all its weights, the plan, the scale, the window, the labels,
/// and either the options of the detector or the file of cones.
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

/// Hash of the program's source code and weights, computed when the program was built.
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
    // corrected cones differ from what the program wrote, but they are already part of
    // `options_sha256`
    let corrected = record.cones_from == ConesFrom::Corrected;
    // files that need not be unchanged
    let aside: &[&str] = if corrected { &[FAILED, POINTS] } else { &[FAILED] };
    let whole = job.out.is_whole(&format!("{IMAGES}/{}/", input.name), aside);
    if !whole || record.fourier.is_none() && plan.wants_fourier() {
        return None;
    }
    let Kept { landmarks, regions } = serde_json::from_slice(&text).ok()?;
    if landmarks.is_some() != plan.maps.is_some() {
        return None;
    }
    // the image no longer fails, so the note about a failure is removed; if it cannot be removed,
    // it does no harm
    let _ = fs::remove_file(folder.join(FAILED));
    let file = input.path.display().to_string();
    let landmarks = landmarks.map(|l| LandmarkRecord { file: file.clone(), ..l });
    let regions = regions.into_iter().map(|r| RoiRow { file: file.clone(), ..r }).collect();
    let record = ImageRecord { file, name: input.name.clone(), ..record };
    Some(Done { record, landmarks, regions, seconds: None })
}
