//! Records of a run: `metrics.json` of every image, and `run.json` of the entire run.

use super::done::Done;
use super::{ConeSource, RunOptions};
use crate::batch::analysis::Analysis;
use crate::batch::output::Worked;
use crate::report::tables::RoiRow;
use crate::report::{ImageRecord, LandmarkRecord};
use crate::stats::{Histogram, PcfOptions};
use serde::Serialize;
use serde_json::{Value, json};
use std::time::Instant;

/// Complete content of the file `metrics.json`.
#[derive(Serialize)]
pub(super) struct Metrics<'a> {
    #[serde(flatten)]
    record: &'a ImageRecord,
    histogram: &'a Histogram,
    pcf_options: PcfOptions,
    samplers: Vec<SamplerNote<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    landmarks: Option<&'a LandmarkRecord>,
    #[serde(skip_serializing_if = "<[RoiRow]>::is_empty")]
    regions: &'a [RoiRow],
}

/// Facts about the mean curve by which a sampler was compared with the mosaic; the fields are those
/// of [`ReferenceCurve`](crate::compare::ReferenceCurve).
#[derive(Serialize)]
struct SamplerNote<'a> {
    sampler: &'a str,
    n: usize,
    realisations: usize,
    ri: Option<f64>,
    /// `true` if the curve comes from the table that comes with the program.
    shipped: bool,
}

/// Returns the content of `metrics.json` for one image.
pub(super) fn metrics<'a>(record: &'a ImageRecord, analysis: &'a Analysis) -> Metrics<'a> {
    let note = |c: &'a crate::compare::ReferenceCurve| SamplerNote {
        sampler: &c.sampler,
        n: c.n,
        realisations: c.realisations,
        ri: c.ri,
        shipped: c.shipped,
    };
    let measures = &analysis.measures;
    Metrics {
        record,
        histogram: &measures.histogram,
        pcf_options: measures.pcf.as_ref().map_or_else(|_| PcfOptions::default(), |pcf| pcf.options),
        samplers: analysis.curves.curves.iter().map(note).collect(),
        landmarks: analysis.landmarks.as_ref(),
        regions: &analysis.regions,
    }
}

/// Returns the content of `run.json`: program, options, times, and the images with their hashes.
pub(super) fn run_json(options: &RunOptions, worked: &Worked<Done>, started: Instant) -> Value {
    let image = |d: &Done| {
        json!({
            "file": d.record.file,
            "name": d.record.name,
            "sha256": d.record.sha256,
            "cones_from": d.record.cones_from,
            "seconds": d.seconds,
        })
    };
    let mut settings = options.plan.describe();
    if let Some(settings) = settings.as_object_mut() {
        let (detect, cones) = match &options.cones {
            ConeSource::Detector(detect) => (json!(detect), Value::Null),
            ConeSource::Given(given) => (Value::Null, json!(given.describe())),
        };
        settings.insert("detect".into(), detect);
        settings.insert("cones".into(), cones);
        settings.insert("window".into(), json!(options.window.to_string()));
        settings.insert("crop".into(), json!(options.crop.map(|c| c.to_string())));
        settings.insert("fresh".into(), json!(options.fresh));
    }
    json!({
        "program": "conemosaic",
        "version": env!("CARGO_PKG_VERSION"),
        "command": options.command,
        "options": settings,
        "seed": options.plan.seed,
        "threads": rayon::current_num_threads(),
        "seconds": started.elapsed().as_secs_f64(),
        "not_begun": worked.left,
        "images": worked.done.iter().map(image).collect::<Vec<_>>(),
        "failures": worked.failures,
    })
}
