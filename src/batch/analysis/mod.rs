//! Analysis of one mosaic, from an image or from a coordinate file.
//!
//! It comprises statistics, comparison with samplers, maps, regions, warnings, and the files with
//! these results. The commands `run`, `measure` and `compare` only supply the mosaics.

mod figure;
mod maps;
mod measured;
mod plan;
mod rois;
mod verdicts;
mod write;

pub use maps::{MapRequest, MapWindow};
pub use plan::Plan;
pub use rois::{RoiRequest, RoiSource};

pub(super) use maps::write_landmarks;
pub(super) use measured::CONFIDENT;
pub(super) use rois::write as write_rois;
pub(super) use verdicts::write_table as write_verdicts;
pub(super) use write::{Layout, write};

use super::{BatchError, Input};
use crate::compare::{References, SamplerCurves, SamplerVerdict};
use crate::detect::{Detections, FourierEstimate, fourier_spacing};
use crate::image::Plane;
use crate::mosaic::Mosaic;
use crate::report::tables::RoiRow;
use crate::report::{LandmarkRecord, MosaicRecord, counted};
use crate::stats::{Functions, Maps, Measures, PowerSpectrum, functions, measure, spectrum};
use measured::{distances, not_compared, warnings_of};
use std::time::Instant;

/// A mosaic to be analysed.
pub(super) struct Specimen<'a> {
    /// The image or coordinate file from which the points come.
    pub input: &'a Input,
    /// The points inside the window, and the window.
    pub mosaic: Mosaic,
    /// Number of points in the file of coordinates or cones that lie outside the window; 0 if this
    /// program detected the points.
    pub outside: usize,
    /// The image; `None` for points from a coordinate file.
    pub image: Option<&'a Plane>,
    /// The detections from which the points come; `None` if this program did not detect them.
    pub found: Option<&'a Detections>,
}

/// The results of [`analyse`] for one mosaic.
pub(super) struct Analysis {
    /// Statistics of the mosaic, including values for each point and functions of distance.
    pub measures: Measures,
    /// The numbers that are written into summaries and records.
    pub record: MosaicRecord,
    /// Warnings about the numbers, each a sentence for the user.
    pub warnings: Vec<String>,
    /// Reference curves of the samplers, and the samplers that have none.
    pub curves: SamplerCurves,
    /// Test of the mosaic against each sampler; empty if the plan asks for none.
    pub verdicts: Vec<SamplerVerdict>,
    /// Functions of distance (G, F, J, K, L and g); `None` if the plan does not ask for them.
    pub functions: Option<Functions>,
    /// Power spectrum of the points; `None` if the plan does not ask for it or it is undefined.
    pub spectrum: Option<PowerSpectrum>,
    /// Maps of local values; `None` if the plan does not ask for them.
    pub maps: Option<Maps>,
    /// Landmarks read off the maps; `None` without maps.
    pub landmarks: Option<LandmarkRecord>,
    /// Rows of `rois.csv` that belong to the mosaic; empty if the plan asks for no regions.
    pub regions: Vec<RoiRow>,
    /// Cone spacing estimated from the spectrum of the image; `None` if no output needs it or there
    /// is no image.
    pub fourier: Option<FourierEstimate>,
    /// Wall-clock time in seconds: first of measuring, then of comparing with samplers.
    pub seconds: [f64; 2],
}

/// Computes for one mosaic everything that the plan asks for.
///
/// # Errors
/// Fails if something that the plan asks for cannot be computed for this mosaic: functions of
/// distance, maps, regions, or the spectrum of the image. Also fails if several rows of the
/// manifest fit the file. Statistics that are undefined become missing values or warnings.
pub(super) fn analyse(
    specimen: &Specimen,
    plan: &Plan,
    references: &References,
) -> Result<Analysis, BatchError> {
    let (mosaic, path) = (&specimen.mosaic, &specimen.input.path);
    let clock = Instant::now();
    let measures = measure(mosaic, &plan.measure);
    let measured = clock.elapsed().as_secs_f64();

    let curves = match &measures.pcf {
        Ok(_) => references.curves(mosaic.len(), mosaic.window()),
        Err(_) => SamplerCurves::default(),
    };
    let (verdicts, no_verdicts) =
        verdicts::verdicts_on(mosaic, &measures, &plan.samplers, plan.verdict.as_ref(), plan.seed);
    let mut record = MosaicRecord::new(mosaic, &measures, distances(&measures, &curves.curves)?);
    record.verdicts = verdicts::records(&verdicts);
    let compared = clock.elapsed().as_secs_f64();

    let mut warnings = warnings_of(specimen.found, &record, &measures, mosaic.points());
    if specimen.outside > 0 {
        let [lie, are, they] = match specimen.outside {
            1 => ["lies", "is", "it is a cone"],
            _ => ["lie", "are", "they are cones"],
        };
        warnings.push(format!(
            "{} {lie} outside the window and {are} left out of every number ({} inside): enlarge the window if {they}, \
             otherwise check the file, its origin and its unit",
            counted(specimen.outside, "point"),
            mosaic.len()
        ));
    }
    warnings.extend(not_compared(&curves));
    warnings.extend(no_verdicts);
    plan.labels.of(path, mosaic.scale())?.put_on(&mut record, &mut warnings);

    let functions = plan
        .functions
        .as_ref()
        .map(|distances| functions(mosaic.points(), mosaic.window(), &measures.neighbours, distances))
        .transpose()?;
    let spectrum = plan.spectrum.as_ref().and_then(|(options, _)| {
        spectrum(mosaic.points(), mosaic.window(), options)
            .inspect_err(|missing| warnings.push(format!("no spectrum is written: {missing}")))
            .ok()
    });
    let maps = plan
        .maps
        .as_ref()
        .map(|request| {
            Ok::<_, BatchError>(crate::stats::maps(mosaic, &measures, &request.of(mosaic, path)?)?)
        })
        .transpose()?;
    let landmarks = maps.as_ref().map(|maps| LandmarkRecord::new(&path.display().to_string(), mosaic, maps));
    let regions = match &plan.rois {
        Some(request) => rois::rows(specimen.input, mosaic, &record, plan, request)?,
        None => Vec::new(),
    };
    let fourier = match specimen.image.filter(|_| plan.wants_fourier()) {
        Some(image) => fourier_spacing(image)
            .map_err(|source| BatchError::Detect { file: path.clone(), source })
            .map(Some)?,
        None => None,
    };
    Ok(Analysis {
        measures,
        record,
        warnings,
        curves,
        verdicts,
        functions,
        spectrum,
        maps,
        landmarks,
        regions,
        fourier,
        seconds: [measured, compared - measured],
    })
}
