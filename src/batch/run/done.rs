//! Results of an image: names of the files in the image's folder, and the parts of the results that
//! stay in memory.

use crate::report::tables::RoiRow;
use crate::report::{ConesFrom, ImageRecord, LandmarkRecord};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// Name of the file of the cones.
pub(super) const POINTS: &str = "points.csv";
/// Name of the file that shows the image with its cones marked.
pub(super) const OVERLAY: &str = "overlay.png";
/// Name of the file with all numbers about the image.
pub(super) const METRICS: &str = "metrics.json";

/// Wall-clock time of each stage of the work on one image, in seconds.
///
/// A thread that waits during the work on one image may work on another image; that time is counted
/// for both images.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(super) struct Seconds {
    /// Time for reading the image and deriving its window and labels.
    pub read: f64,
    /// Time for detecting or reading the cones.
    pub detect: f64,
    /// Time for measuring the mosaic of the cones.
    pub measure: f64,
    /// Time for comparing the mosaic with samplers.
    pub compare: f64,
    /// Time for writing the image's folder.
    pub report: f64,
}

/// Parts of an image's results that stay in memory after they are written.
pub(super) struct Done {
    /// The record of the image, from which tables and the page are made.
    pub record: ImageRecord,
    /// The landmarks read off the image's maps; `None` if no maps were asked for.
    pub landmarks: Option<LandmarkRecord>,
    /// Rows of `rois.csv` that belong to the image.
    pub regions: Vec<RoiRow>,
    /// Time of each stage; `None` if the results of an earlier run were kept.
    pub seconds: Option<Seconds>,
}

/// Returns the origin of the cones in the results of an earlier run, which lie in `folder`; `None`
/// if it cannot be read.
pub(super) fn earlier_cones(folder: &Path) -> Option<ConesFrom> {
    #[derive(Deserialize)]
    struct Origin {
        cones_from: ConesFrom,
    }
    let text = fs::read(folder.join(METRICS)).ok()?;
    serde_json::from_slice::<Origin>(&text).ok().map(|o| o.cones_from)
}
