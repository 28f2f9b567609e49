use super::failures::write_failures;
use super::measured::warnings_of;
use super::outputs::OutputFolder;
use super::region::{Region, Regions};
use super::work::for_each;
use super::{
    BatchError, Crop, Failure, Input, Labels, MapRequest, Progress, RoiRequest, ScaleSource, maps, rois,
};
use crate::geometry::{Point, Window};
use crate::mosaic::io::{ReadOptions, read_coordinates};
use crate::mosaic::{LengthUnit, Mosaic};
use crate::report::{
    CoordinatesRecord, FindingRecord, MetricSelection, MosaicRecord, PowerScale, Subject, Summary,
    SummaryKind, counted, spectrum_png, tables,
};
use crate::stats::{
    FunctionOptions, MeasureOptions, Measures, SpectrumOptions, StatsError, functions, measure, spectrum,
};
use std::path::Path;

/// How coordinate files are read and measured.
#[derive(Clone)]
pub struct CoordinatesOptions {
    /// How the files are to be understood.
    pub read: ReadOptions,
    /// Where points could have been seen.
    pub region: Region,
    /// The rectangle of that window that counts; `None`: all of it.
    pub crop: Option<Crop>,
    /// Opposite edges of the window are the same place; not with a crop.
    pub torus: bool,
    /// Where scales come from.
    pub scales: ScaleSource,
    /// What is known of the files, and which belong together.
    pub labels: Labels,
    /// Columns of `summary.csv`.
    pub metrics: MetricSelection,
    /// How mosaics are measured.
    pub measure: MeasureOptions,
    /// Power spectra to be written, by [`measure_files`], and how they are drawn.
    pub spectrum: Option<(SpectrumOptions, PowerScale)>,
    /// Distances at which G, F, J, K, L and g are written, by [`measure_files`], with a table of points.
    pub functions: Option<FunctionOptions>,
    /// Maps and what is read off them, by [`measure_files`].
    pub maps: Option<MapRequest>,
    /// Regions to be measured as mosaics of their own, by [`measure_files`].
    pub rois: Option<RoiRequest>,
}

impl CoordinatesOptions {
    /// The columns of `summary.csv`.
    pub fn summary(&self) -> Summary {
        Summary::new(SummaryKind::Coordinates, &self.metrics, &[], self.labels.columns())
    }
}

/// What came of measuring or comparing coordinate files.
#[derive(Clone, Debug)]
pub struct CoordinatesOutcome {
    /// One record a file, in the order of the inputs.
    pub records: Vec<CoordinatesRecord>,
    /// Files without results.
    pub failures: Vec<Failure>,
    /// How regularity hangs together with the distance to each sampler; empty where nothing was compared.
    pub findings: Vec<FindingRecord>,
}

/// Writes `summary.csv` (one row a file) and the same as `summary.json`, `groups.csv` if groups are wanted, `NAME.pcf.csv` (r in hexagonal spacings, g), and if asked for `NAME.spectrum.csv` and
/// `.png`, `NAME.maps.csv` and `.svg`, `NAME.profiles.csv` and `landmarks.csv` (one row a file), `rois.csv` (one row a region).
///
/// # Errors
/// If the file of a window cannot be read or `out` cannot be written to. Files that fail are in the outcome and in `failures.csv`.
pub fn measure_files(
    inputs: &[Input],
    options: &CoordinatesOptions,
    out: &Path,
    progress: &dyn Progress,
) -> Result<CoordinatesOutcome, BatchError> {
    options.labels.validate()?;
    options.maps.iter().try_for_each(MapRequest::validate)?;
    options.rois.iter().try_for_each(RoiRequest::validate)?;
    options.rois.iter().try_for_each(|request| request.refuse_overlap(out))?;
    let regions = Regions::new(&options.region, &options.read)?;
    let out = OutputFolder::create(out)?;
    let (found, failures) = for_each(inputs, progress, |input| {
        let (mosaic, outside) = load(input, options, &regions)?;
        let measures = measure(&mosaic, &options.measure);
        let mut record = record(input, &mosaic, outside, &measures, Vec::new());
        let label = options.labels.of(&input.path, mosaic.scale())?;
        label.put_on(&mut record.mosaic, &mut record.warnings);
        out.write(&format!("{}.pcf.csv", input.name), &tables::pcf_csv(&measures, &[])?)?;
        if let Some(distances) = &options.functions {
            let found = functions(mosaic.points(), mosaic.window(), &measures.neighbours, distances)?;
            let recovery = measures.density_recovery.as_ref().ok();
            for (kind, bytes) in [
                ("functions", tables::functions_csv(&found)?),
                ("density_recovery", tables::density_recovery_csv(recovery)?),
                ("points", tables::points_csv(&mosaic, &measures)?),
            ] {
                out.write(&format!("{}.{kind}.csv", input.name), &bytes)?;
            }
        }
        if let Some((power, scale)) = &options.spectrum
            && let Err(missing) = write_spectrum(&out, &input.name, &mosaic, power, *scale)?
        {
            record.warnings.push(format!("no spectrum: {missing}"));
        }
        let map = |request| {
            maps::write(
                &out,
                &format!("{}.", input.name),
                &input.name,
                &input.path,
                (&mosaic, &measures),
                request,
            )
        };
        let landmarks = options.maps.as_ref().map(map).transpose()?;
        let region = |request| rois::rows(input, &mosaic, &record.mosaic, options, request);
        let regions = options.rois.as_ref().map(region).transpose()?;
        let line = line_about(&record);
        Ok(((input.name.clone(), record, landmarks, regions.unwrap_or_default()), line))
    });
    let (mut names, mut records, mut landmarks, mut of_regions) = (vec![], vec![], vec![], vec![]);
    for (name, record, landmark, regions) in found {
        names.push(name);
        records.push(record);
        landmarks.extend(landmark);
        of_regions.extend(regions);
    }
    let summary = options.summary();
    let subjects: Vec<(&str, Subject)> =
        names.iter().map(String::as_str).zip(records.iter().map(Subject::Coordinates)).collect();
    out.write("summary.csv", &summary.csv(subjects.iter().map(|(_, subject)| *subject))?)?;
    let objects: Result<Vec<_>, _> = subjects.iter().map(|(_, subject)| summary.json(subject)).collect();
    out.write_json("summary.json", &objects?)?;
    options.labels.write_groups(&out, &summary, &subjects)?;
    if options.maps.is_some() {
        maps::write_landmarks(&out, &landmarks)?;
    }
    if options.rois.is_some() {
        rois::write(&out, &summary, &of_regions)?;
    }
    out.write_json("options.json", &options_json(options, serde_json::Value::Null))?;
    write_failures(&out, &failures)?;
    Ok(CoordinatesOutcome { records, failures, findings: Vec::new() })
}

/// Writes `NAME.spectrum.csv` (frequency in √density, power, anisotropy in dB) and `NAME.spectrum.png`, or says why there is none.
fn write_spectrum(
    out: &OutputFolder,
    name: &str,
    mosaic: &Mosaic,
    options: &SpectrumOptions,
    scale: PowerScale,
) -> Result<Result<(), StatsError>, BatchError> {
    let spectrum = match spectrum(mosaic.points(), mosaic.window(), options) {
        Ok(spectrum) => spectrum,
        Err(missing) => return Ok(Err(missing)),
    };
    out.write(&format!("{name}.spectrum.csv"), &tables::spectrum_csv(&spectrum)?)?;
    out.write(&format!("{name}.spectrum.png"), &spectrum_png(&spectrum, scale)?)?;
    Ok(Ok(()))
}

/// How coordinates were read and measured, and what they were compared with.
pub(super) fn options_json(options: &CoordinatesOptions, samplers: serde_json::Value) -> serde_json::Value {
    serde_json::json!({
        "program": "conemosaic",
        "version": env!("CARGO_PKG_VERSION"),
        "read": options.read,
        "window": options.region.to_string(),
        "crop": options.crop.map(|c| c.to_string()),
        "torus": options.torus,
        "scale": options.scales.describe(),
        "measure": options.measure,
        "functions": options.functions,
        "spectrum": options.spectrum.map(|(spectrum, _)| spectrum),
        "manifest": options.labels.manifest.as_ref().map(|m| m.file()),
        "maps": options.maps,
        "rois": options.rois.as_ref().map(RoiRequest::describe),
        "samplers": samplers,
    })
}

pub(super) fn line_about(record: &CoordinatesRecord) -> String {
    let ri = record.mosaic.stats.nearest.ri.map(|ri| format!(", RI {ri:.2}")).unwrap_or_default();
    format!("{}{ri}", counted(record.mosaic.n, "point"))
}

pub(super) fn record(
    input: &Input,
    mosaic: &Mosaic,
    outside: usize,
    measures: &Measures,
    l_infinity: Vec<crate::report::SamplerDistance>,
) -> CoordinatesRecord {
    let mosaic = MosaicRecord::new(mosaic, measures, l_infinity);
    let mut warnings = warnings_of(None, &mosaic, measures);
    if outside > 0 {
        warnings.push(format!("{outside} points outside the window are left out"));
    }
    let (file, name) = (input.path.display().to_string(), input.name.clone());
    CoordinatesRecord { file, name, outside, mosaic, warnings }
}

/// The mosaic in a coordinate file, and how many of its points lie outside the window (those cut off by a crop are not
/// counted: to leave them out is its purpose).
pub(super) fn load(
    input: &Input,
    options: &CoordinatesOptions,
    regions: &Regions,
) -> Result<(Mosaic, usize), BatchError> {
    let file = read_coordinates(&input.path, &options.read)?;
    let unit = match options.region {
        Region::Unit => LengthUnit::Unit,
        _ => file.unit.unwrap_or(LengthUnit::Pixel),
    };
    let (window, scale) = regions.of(&input.path, unit, &options.scales)?;
    let mut points = file.points;
    let expansion = options.scales.expansion();
    if unit == LengthUnit::Micrometre && expansion != 1. {
        points.iter_mut().for_each(|p| *p = Point::new(p.x * expansion, p.y * expansion));
    }
    let outside = points.iter().filter(|&&p| !window.contains(p)).count();
    let window = match &options.crop {
        None => window,
        Some(crop) => {
            let frame = crop.frame("--crop", &input.path, &window.bounds(), unit, scale)?;
            frame.and_then(|frame| window.within(&frame)).ok_or_else(|| BatchError::NothingCropped {
                file: input.path.clone(),
                crop: crop.to_string(),
            })?
        }
    };
    let window = match window {
        Window::Polygon(_) if options.torus => {
            return Err(BatchError::NoTorus { file: input.path.clone() });
        }
        window if options.torus => Window::Torus(window.bounds()),
        window => window,
    };
    let (mosaic, _) = Mosaic::new(points, window, unit, scale)
        .map_err(|source| BatchError::Mosaic { file: input.path.clone(), source })?;
    Ok((mosaic, outside))
}
