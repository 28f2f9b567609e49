//! What the results of an image are: the files in its folder, and what is kept of them.

use crate::report::tables::RoiRow;
use crate::report::{ConesFrom, ImageRecord, LandmarkRecord};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// The cones.
pub(super) const POINTS: &str = "points.csv";
/// The picture with its cones.
pub(super) const OVERLAY: &str = "overlay.png";
/// All numbers.
pub(super) const METRICS: &str = "metrics.json";

/// Wall-clock seconds of the stages of one image. A core that helps another image meanwhile counts
/// on both.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(super) struct Seconds {
    pub read: f64,
    pub detect: f64,
    pub measure: f64,
    pub compare: f64,
    pub report: f64,
}

/// Parts of an image's results that are kept in memory when they are written.
pub(super) struct Done {
    pub record: ImageRecord,
    pub landmarks: Option<LandmarkRecord>,
    pub regions: Vec<RoiRow>,
    /// `None` if earlier results were kept.
    pub seconds: Option<Seconds>,
}

/// Returns where the cones of earlier results were from; `None` if that cannot be read.
pub(super) fn earlier_cones(folder: &Path) -> Option<ConesFrom> {
    #[derive(Deserialize)]
    struct Origin {
        cones_from: ConesFrom,
    }
    let text = fs::read(folder.join(METRICS)).ok()?;
    serde_json::from_slice::<Origin>(&text).ok().map(|o| o.cones_from)
}
