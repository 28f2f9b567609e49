use super::error::{Located, ReadFault, clipped, listed};
use super::text::decode;
use super::{Dataset, Dialect, Origin, RawFile};
use crate::geometry::Point;
use crate::mosaic::LengthUnit;
use serde::Deserialize;
use std::io::{Cursor, Read};

/// A project: version 4 holds its datasets at the top, version 3 inside `wpd`. Other keys do not matter here:
/// `x` and `y` are the places clicked, in pixels from the top-left corner, whatever the axes.
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

/// A project as JSON, `wpd.json`.
pub(super) fn read_json(text: &str) -> Result<RawFile, Located> {
    let broken = |e: serde_json::Error| ReadFault::Json { detail: clipped(&e.to_string(), 120) };
    let project: Project = serde_json::from_str(text.trim()).map_err(broken)?;
    let series = project.version4.or_else(|| project.wpd.map(|v3| v3.series)).ok_or_else(|| {
        ReadFault::Json { detail: "neither datasetColl nor wpd.dataSeries at the top".into() }
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

/// Refuses a project as `.tar`, for which this library was built without the feature `archives`.
#[cfg(not(feature = "archives"))]
pub(super) fn read_tar(_bytes: &[u8]) -> Result<RawFile, Located> {
    Err(ReadFault::Archive {
        expected: "a WebPlotDigitizer project (.tar)",
        detail: "this build has no feature “archives”: unpack it and give wpd.json".into(),
    }
    .into())
}

/// A project as `.tar`: the image and, in some folder, `wpd.json`.
#[cfg(feature = "archives")]
pub(super) fn read_tar(bytes: &[u8]) -> Result<RawFile, Located> {
    let broken = |e: std::io::Error| ReadFault::Archive {
        expected: "a WebPlotDigitizer project (.tar)",
        detail: clipped(&e.to_string(), 120),
    };
    let mut archive = tar::Archive::new(Cursor::new(bytes));
    let mut members = Vec::new();
    for entry in archive.entries().map_err(broken)? {
        let entry = entry.map_err(broken)?;
        let path = String::from_utf8_lossy(&entry.path_bytes()).into_owned();
        if path.rsplit('/').next() != Some("wpd.json") {
            members.push(path);
            continue;
        }
        let size = entry.size();
        let mut json = Vec::new();
        // A member cannot be larger than its archive, unless it claims to be sparse.
        entry.take(bytes.len() as u64).read_to_end(&mut json).map_err(broken)?;
        if json.len() as u64 != size {
            let detail = format!("wpd.json should have {size} bytes, {} are there", json.len());
            return Err(ReadFault::Archive { expected: "a WebPlotDigitizer project (.tar)", detail }.into());
        }
        let text = decode(&json).map_err(|fault| Located::member(&path, fault))?;
        return read_json(&text).map_err(|located| Located::member(&path, located.fault));
    }
    Err(ReadFault::NotInArchive {
        expected: "wpd.json",
        found: listed(members.iter().map(String::as_str)),
        remedy: "save the project with WebPlotDigitizer (File, Save Project)",
    }
    .into())
}
