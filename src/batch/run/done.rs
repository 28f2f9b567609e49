//! The results of an image: the files in its folder, and the parts that stay in memory.

use crate::report::tables::RoiRow;
use crate::report::{ConesFrom, ImageRecord, LandmarkRecord};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// File of the cones.
pub(super) const POINTS: &str = "points.csv";
/// File of the image with its cones marked.
pub(super) const OVERLAY: &str = "overlay.png";
/// File of all numbers.
pub(super) const METRICS: &str = "metrics.json";

/// Wall-clock seconds of the stages of one image.
///
/// While a thread waits in one image it may help another; that time counts for both.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(super) struct Seconds {
    /// Reading the image, its window and its labels.
    pub read: f64,
    /// Detecting or reading the cones.
    pub detect: f64,
    /// Measuring the mosaic of the cones.
    pub measure: f64,
    /// Comparing the mosaic with samplers.
    pub compare: f64,
    /// Writing the image's folder.
    pub report: f64,
}

/// Parts of an image's results that stay in memory after they are written.
pub(super) struct Done {
    /// The record of the image, from which tables and the page are made.
    pub record: ImageRecord,
    /// The landmarks of its maps, if maps were asked for.
    pub landmarks: Option<LandmarkRecord>,
    /// Rows of `rois.csv` that belong to the image.
    pub regions: Vec<RoiRow>,
    /// Seconds of the stages; `None` if earlier results were kept.
    pub seconds: Option<Seconds>,
}

/// Returns the origin of the cones in earlier results; `None` if it cannot be read.
pub(super) fn earlier_cones(folder: &Path) -> Option<ConesFrom> {
    #[derive(Deserialize)]
    struct Origin {
        cones_from: ConesFrom,
    }
    let text = fs::read(folder.join(METRICS)).ok()?;
    serde_json::from_slice::<Origin>(&text).ok().map(|o| o.cones_from)
}
