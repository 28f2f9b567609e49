use super::Plan;
use super::measured::warnings_of;
use crate::batch::output::OutputFolder;
use crate::batch::{BatchError, Input, Length};
use crate::geometry::{Rectangle, Window};
use crate::mosaic::io::RoiTable;
use crate::mosaic::{LengthUnit, Mosaic};
use crate::report::tables::{RoiRow, rois_csv};
use crate::report::{CoordinatesRecord, MosaicRecord, Summary};
use crate::stats::{grown, lies_in, measure, sliding};
use rayon::prelude::*;
use std::path::Path;

/// Name of the table of the regions, with one row per region.
const FILE: &str = "rois.csv";

/// Options of regions of interest, the same for every mosaic of a batch.
#[derive(Clone, Debug)]
pub struct RoiRequest {
    /// Source of the rectangles (boxes) in which the regions lie.
    pub source: RoiSource,
    /// Number of bound cells (Voronoi cells strictly inside the box) that each box is to contain, 1
    /// to 100 000. A box with fewer bound cells grows about its centre until it contains that
    /// number. `None` if boxes stay as they are.
    pub cells: Option<usize>,
}

/// Source of the boxes of regions of interest.
#[derive(Clone, Debug)]
pub enum RoiSource {
    /// Boxes are read from a table.
    Table(RoiTable),
    /// Boxes are squares at regular steps over the bounds of the window.
    Sliding {
        /// Side of the squares.
        side: Length,
        /// Distance from one square to the next. `None` for a distance of `side`, so that the
        /// squares tile the window.
        step: Option<Length>,
    },
}

impl RoiRequest {
    /// Checks that every field is in its range.
    ///
    /// # Errors
    /// Fails if the number of cells is out of range.
    pub fn validate(&self) -> Result<(), BatchError> {
        match self.cells {
            Some(n) if !(1..=100_000).contains(&n) => Err(crate::stats::StatsError::Option {
                option: "number of cells of the regions",
                value: n as f64,
                range: "1 to 100000",
            }
            .into()),
            _ => Ok(()),
        }
    }

    /// Fails if the table of regions is the very file to which the regions would be written.
    pub(in crate::batch) fn refuse_overlap(&self, out: &Path) -> Result<(), BatchError> {
        let RoiSource::Table(table) = &self.source else { return Ok(()) };
        let (read, written) = (Path::new(table.file()).canonicalize(), out.join(FILE).canonicalize());
        match (read, written) {
            (Ok(read), Ok(written)) if read == written => {
                Err(BatchError::Overlap { file: table.file().into(), folder: out.to_owned() })
            }
            _ => Ok(()),
        }
    }

    /// Returns the options as JSON, for the record of a batch.
    pub(super) fn describe(&self) -> serde_json::Value {
        let source = match &self.source {
            RoiSource::Table(table) => serde_json::json!({ "table": table.file() }),
            RoiSource::Sliding { side, step } => serde_json::json!({ "side": side, "step": step }),
        };
        serde_json::json!({ "source": source, "cells": self.cells })
    }

    /// Returns the boxes of a mosaic, each with its name, in the unit of the mosaic's coordinates.
    fn boxes(&self, input: &Input, mosaic: &Mosaic) -> Result<Vec<(String, Rectangle)>, BatchError> {
        let file = &input.path;
        match &self.source {
            RoiSource::Table(table) => {
                let factor = factor(table, mosaic, file)?;
                let name = file.file_name().unwrap_or_default().to_string_lossy();
                let boxes = table.boxes_of(&name)?;
                let scaled = |f: &Rectangle| {
                    Rectangle::new(f.x0() * factor, f.y0() * factor, f.x1() * factor, f.y1() * factor)
                };
                boxes.into_iter().map(|roi| Ok((roi.name.clone(), scaled(&roi.frame)?))).collect()
            }
            RoiSource::Sliding { side, step } => {
                let side = side.of("the side of the regions", mosaic, file)?;
                let step = step.map_or(Ok(side), |step| step.of("the step of the regions", mosaic, file))?;
                let boxes = sliding(&mosaic.window().bounds(), side, step)?;
                if boxes.is_empty() {
                    return Err(BatchError::NoRoi { file: file.clone(), side });
                }
                let named = |([row, column], frame): ([usize; 2], _)| (format!("r{row}c{column}"), frame);
                Ok(boxes.into_iter().map(named).collect())
            }
        }
    }
}

/// Returns the factor that converts lengths from the unit of a table to the unit of a mosaic's
/// coordinates. The factor is 1 if the table has no unit, or if one of the two is in the unit
/// square.
fn factor(table: &RoiTable, mosaic: &Mosaic, file: &Path) -> Result<f64, BatchError> {
    let no_scale = || BatchError::NoScale {
        what: match mosaic.unit() {
            LengthUnit::Micrometre => "the file of coordinates, unlike the table of regions,",
            LengthUnit::Pixel | LengthUnit::Unit => "the table of regions, unlike the coordinates,",
        },
        file: file.to_owned(),
    };
    match (table.unit(), mosaic.unit()) {
        (None | Some(LengthUnit::Unit), _) | (_, LengthUnit::Unit) => Ok(1.),
        (Some(given), unit) => given.factor_to(unit, mosaic.scale()).ok_or_else(no_scale),
    }
}

/// Measures each region of one mosaic as a mosaic of its own, and returns one row per region.
///
/// A region is the part of the window inside its box, with the points in that part. Its Voronoi
/// cells are computed from these points alone, and a cell counts as bound if it lies strictly
/// inside the region. A region entirely outside the window has no values. `whole` is the record of
/// the mosaic, from which regions take labels and location on the retina. The result is the same
/// for any number of threads.
///
/// # Errors
/// Fails if a table has no boxes for the file, or a length is in µm and no scale is known.
pub(super) fn rows(
    input: &Input,
    mosaic: &Mosaic,
    whole: &MosaicRecord,
    plan: &Plan,
    request: &RoiRequest,
) -> Result<Vec<RoiRow>, BatchError> {
    let one = |(name, frame): (String, Rectangle)| -> Result<RoiRow, BatchError> {
        let (points, window) = (mosaic.points(), mosaic.window());
        let mut flags = Vec::new();
        let frame = match request.cells {
            None => frame,
            Some(needed) => {
                let grown = grown(points, window, frame, needed);
                if !grown.enough {
                    flags.push("few");
                }
                grown.frame
            }
        };
        let part = window.within(&frame);
        if part.is_none() {
            flags = vec!["outside"];
        } else if !lies_in(&frame, window) {
            flags.push("edge");
        }
        let measured = |part: Window| -> Result<CoordinatesRecord, BatchError> {
            let inside = points.iter().copied().filter(|&p| part.contains(p)).collect();
            let (roi, _) = Mosaic::new(inside, part, mosaic.unit(), mosaic.scale())
                .map_err(|source| BatchError::Mosaic { file: input.path.clone(), source })?;
            let measures = measure(&roi, &plan.measure);
            let mut record = MosaicRecord::new(&roi, &measures, Vec::new());
            record.labels.clone_from(&whole.labels);
            record.place = whole.place;
            let warnings = warnings_of(None, &record, &measures, &[]);
            let (file, name) = (input.path.display().to_string(), input.name.clone());
            Ok(CoordinatesRecord { file, name, outside: 0, mosaic: record, warnings })
        };
        Ok(RoiRow {
            file: input.path.display().to_string(),
            roi: name,
            frame,
            flag: flags.join(" "),
            record: part.map(measured).transpose()?,
        })
    };
    request.boxes(input, mosaic)?.into_par_iter().map(one).collect()
}

/// Writes `rois.csv`, one row per region.
pub(in crate::batch) fn write(
    out: &OutputFolder,
    summary: &Summary,
    rows: &[RoiRow],
) -> Result<(), BatchError> {
    out.write(FILE, &rois_csv(summary, rows)?)
}
