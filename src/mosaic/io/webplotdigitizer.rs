use super::error::{Located, ReadFault, clipped};
use super::{Dataset, Dialect, Origin, RawFile};
use crate::geometry::Point;
use crate::mosaic::LengthUnit;
use serde::Deserialize;

/// WebPlotDigitizer project of version 3 or 4.
///
/// Version 4 has its datasets at the top level, version 3 inside `wpd`. The axes and all other keys
/// are ignored: `x` and `y` are the positions clicked, in pixels from the top-left corner, whatever
/// the axes.
#[derive(Deserialize)]
struct Project {
    #[serde(rename = "datasetColl")]
    version4: Option<Vec<Series>>,
    wpd: Option<Version3>,
}

#[derive(Deserialize)]
struct Version3 {
    #[serde(rename = "dataSeries")]
    series: Vec<Series>,
}

#[derive(Deserialize)]
struct Series {
    #[serde(default)]
    name: String,
    data: Vec<Mark>,
}

#[derive(Deserialize)]
struct Mark {
    x: f64,
    y: f64,
}

/// Reads a project from its JSON text (`wpd.json`).
pub(super) fn read_json(text: &str) -> Result<RawFile, Located> {
    let broken = |e: serde_json::Error| ReadFault::Json { detail: clipped(&e.to_string(), 120) };
    let project: Project = serde_json::from_str(text.trim()).map_err(broken)?;
    let series = project.version4.or_else(|| project.wpd.map(|v3| v3.series)).ok_or_else(|| {
        ReadFault::Json { detail: "neither datasetColl nor wpd.dataSeries at its top level".into() }
    })?;
    let datasets = series.into_iter().map(|s| Dataset {
        name: s.name,
        origin: Origin::Half,
        points: s.data.iter().map(|m| Point::new(m.x, m.y)).collect(),
    });
    Ok(RawFile {
        dialect: Dialect::WebPlotDigitizerProject,
        unit: Some(LengthUnit::Pixel),
        y_may_point_up: false,
        datasets: datasets.collect(),
        scores: None,
    })
}
