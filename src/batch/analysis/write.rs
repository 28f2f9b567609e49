//! Files that are written for one mosaic.
//!
//! In a folder of the mosaic's own, the files have plain names, such as `pcf.csv`. In a folder that
//! several mosaics share, the name of the mosaic and a dot come first.

use super::{Analysis, Plan, Specimen, figure, maps, verdicts};
use crate::batch::BatchError;
use crate::batch::output::{OutputFolder, write_figure};
use crate::report::{spectrum_png, tables};

/// Name of the table of g(r) and of the samplers' curves. This and all names below lack the name of
/// the mosaic.
const PCF: &str = "pcf.csv";
/// Name of the figure of the mosaic, without extension.
const FIGURE: &str = "figure";
/// Names of the tables of functions of distance: G, F, J, K, L and g, and the density recovery
/// profile.
const FUNCTIONS: [&str; 2] = ["functions.csv", "density_recovery.csv"];
/// Names of the power spectrum as a table and as a picture.
const SPECTRUM: [&str; 2] = ["spectrum.csv", "spectrum.png"];
/// Names of the table of points with their neighbours and cells: first in a shared folder, then in
/// a folder of the mosaic's own. The names differ because `points.csv` in an image's folder already
/// holds the cones as they were found.
const POINTS: [&str; 2] = ["points.csv", "cells.csv"];

/// Kind of folder into which the files of a mosaic are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::batch) enum Layout {
    /// Every mosaic has a folder of its own. Files have plain names, and `figure.svg` is written
    /// too.
    Folder,
    /// All mosaics share one folder. Each file name begins with the name of the mosaic, and
    /// `figure.svg` is left out.
    Beside,
}

/// Writes the files of a mosaic into `folder`.
///
/// # Errors
/// Fails if a figure cannot be drawn or a file cannot be written.
pub(in crate::batch) fn write(
    analysis: &Analysis,
    specimen: &Specimen,
    plan: &Plan,
    folder: &OutputFolder,
    layout: Layout,
) -> Result<(), BatchError> {
    let (name, mosaic, measures) = (&specimen.input.name, &specimen.mosaic, &analysis.measures);
    let called = |file: &str| match layout {
        Layout::Folder => file.to_owned(),
        Layout::Beside => format!("{name}.{file}"),
    };
    folder.write(&called(PCF), &tables::pcf_csv(measures, &analysis.curves.curves)?)?;
    if layout == Layout::Folder {
        let drawn = figure::figure(
            name,
            specimen.image,
            mosaic,
            measures,
            &analysis.record,
            &analysis.curves.curves,
        )?;
        write_figure(folder, FIGURE, &drawn, &plan.figures)?;
    }
    if let Some(found) = &analysis.functions {
        let recovery = measures.density_recovery.as_ref().ok();
        let table = if layout == Layout::Folder { POINTS[1] } else { POINTS[0] };
        folder.write(&called(FUNCTIONS[0]), &tables::functions_csv(found)?)?;
        folder.write(&called(FUNCTIONS[1]), &tables::density_recovery_csv(recovery)?)?;
        folder.write(&called(table), &tables::points_csv(mosaic, measures)?)?;
    }
    if let (Some(found), Some((_, scale))) = (&analysis.spectrum, plan.spectrum) {
        folder.write(&called(SPECTRUM[0]), &tables::spectrum_csv(found)?)?;
        folder.write(&called(SPECTRUM[1]), &spectrum_png(found, scale)?)?;
    }
    if let Some(found) = &analysis.maps {
        maps::write(folder, &called(""), name, (mosaic, found), &plan.figures)?;
        if let Some(image) = specimen.image.filter(|_| layout == Layout::Folder) {
            maps::write_fourier(folder, image, analysis.fourier.as_ref(), mosaic.scale())?;
        }
    }
    verdicts::write(folder, &called(""), name, (measures, &analysis.verdicts), &plan.figures)
}
