//! Readers of coordinates in `.zip` and `.tar` archives, with the feature `archives`.

use super::error::{Located, ReadFault, clipped, listed};
use super::text::decode;
use super::{RawFile, imagej, webplotdigitizer};
use std::io::{Cursor, Read};

/// Limit on the unpacked size of one ROI, in bytes: 4 million sub-pixel points of 12 bytes each.
///
/// A ROI that unpacks to more is refused, so that a small archive cannot fill the memory.
const LARGEST_ROI: u64 = 48 << 20;
/// Limit on the unpacked size of all ROIs of a set together, in bytes: 16 million sub-pixel points.
const LARGEST_SET: u64 = 192 << 20;

/// Reads a `RoiSet.zip` that ImageJ's ROI manager saved.
pub(super) fn read_set(bytes: &[u8], wanted: imagej::Wanted) -> Result<RawFile, Located> {
    let broken = |detail: &dyn std::fmt::Display| ReadFault::Archive {
        expected: "a set of ImageJ ROIs (.zip)",
        detail: clipped(&detail.to_string(), 120),
    };
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(|e| broken(&e))?;
    let mut datasets = Vec::new();
    let mut others = Vec::new();
    let mut budget = LARGEST_SET;
    for index in 0..archive.len() {
        let member = archive.by_index(index).map_err(|e| broken(&e))?;
        let name = member.name().map_err(|e| broken(&e))?.into_owned();
        // Apple's archiver adds this folder, with a shadow of every file that is not a ROI itself.
        if !name.to_ascii_lowercase().ends_with(".roi") || name.starts_with("__MACOSX/") {
            others.push(name);
            continue;
        }
        let limit = LARGEST_ROI.min(budget);
        let mut roi = Vec::new();
        let read = member.take(limit + 1).read_to_end(&mut roi);
        read.map_err(|e| Located::member(&name, broken(&e)))?;
        let size = roi.len() as u64;
        if size > limit {
            return Err(Located::member(&name, ReadFault::TooLarge { limit_mib: limit >> 20 }));
        }
        budget -= size;
        datasets.push(imagej::parse(&name, &roi, wanted).map_err(|fault| Located::member(&name, fault))?);
    }
    if !datasets.is_empty() {
        return Ok(imagej::file(datasets));
    }
    let spreadsheet = others.iter().any(|name| name.starts_with("xl/") || name == "content.xml");
    Err(ReadFault::NotInArchive {
        expected: "ImageJ ROIs (.roi)",
        found: if spreadsheet { "a spreadsheet".into() } else { listed(others.iter().map(String::as_str)) },
        remedy: if spreadsheet { "save it as CSV" } else { "save the set with ImageJ's ROI manager" },
    }
    .into())
}

/// Reads a WebPlotDigitizer project from a `.tar` archive.
///
/// It contains the image and, in some folder, `wpd.json`.
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
        // A member cannot be larger than its archive, unless it claims to be sparse: the limit
        // keeps such a claim from filling the memory.
        entry.take(bytes.len() as u64).read_to_end(&mut json).map_err(broken)?;
        if json.len() as u64 != size {
            let detail = format!("wpd.json should have {size} bytes, but has {}", json.len());
            return Err(ReadFault::Archive { expected: "a WebPlotDigitizer project (.tar)", detail }.into());
        }
        let text = decode(&json).map_err(|fault| Located::member(&path, fault))?;
        return webplotdigitizer::read_json(&text).map_err(|located| Located::member(&path, located.fault));
    }
    Err(ReadFault::NotInArchive {
        expected: "wpd.json",
        found: listed(members.iter().map(String::as_str)),
        remedy: "save the project with WebPlotDigitizer (File, Save Project)",
    }
    .into())
}
