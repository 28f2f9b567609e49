use super::analysis::{
    Analysis, Layout, Plan, Specimen, analyse, write, write_landmarks, write_rois, write_verdicts,
};
use super::output::{Ending, ResultFolder, Worked, for_each, write_failures};
use super::window::Regions;
use super::{BatchError, Crop, Failure, Input, Progress, Region};
use crate::geometry::{Point, Window};
use crate::mosaic::io::{ReadOptions, read_coordinates};
use crate::mosaic::{LengthUnit, Mosaic};
use crate::report::tables::{self, RoiRow};
use crate::report::{CoordinatesRecord, FindingRecord, LandmarkRecord, Subject, SummaryKind, counted};
use std::path::{Path, PathBuf};

/// Options of reading and analysing coordinate files.
#[derive(Clone)]
pub struct CoordinatesOptions {
    /// The plan: what is computed and written for each mosaic.
    pub plan: Plan,
    /// Options of reading the files.
    pub read: ReadOptions,
    /// The window: the area in which points could have been seen.
    pub region: Region,
    /// Folder of the images from which windows are taken, or path of the only image. `None` if each
    /// image lies beside its coordinate file.
    pub images: Option<PathBuf>,
    /// A rectangle to which the window is cut, so that points outside the rectangle do not count.
    /// `None` if the entire window counts.
    pub crop: Option<Crop>,
    /// `true` to join opposite edges of the window, which makes it a torus. The window must then be
    /// a rectangle, and there should be no crop.
    pub torus: bool,
}

/// Results of measuring or comparing coordinate files.
#[derive(Clone, Debug)]
pub struct CoordinatesOutcome {
    /// Records of the files with results, in the order of the inputs.
    pub records: Vec<CoordinatesRecord>,
    /// Files without results, each with the reason.
    pub failures: Vec<Failure>,
    /// Correlation of the regularity index with the distance to each sampler, over all files; empty
    /// after [`measure_files`].
    pub findings: Vec<FindingRecord>,
    /// End of the batch: complete, or stopped early.
    pub ending: Ending,
}

/// Parts of a file's results that stay in memory after they are written.
struct Done {
    /// The record of the file, from which tables are made.
    record: CoordinatesRecord,
    /// The landmarks read off the maps; `None` without maps.
    landmarks: Option<LandmarkRecord>,
    /// Rows of `rois.csv` that belong to the file.
    regions: Vec<RoiRow>,
}

/// Measures the points of coordinate files and writes the results into `out`.
///
/// Always writes `summary.csv` (one row per file), the same as `summary.json`, `options.json`, and
/// `NAME.pcf.csv` for each file. As the plan asks, it also writes `groups.csv`, `verdicts.csv`,
/// `landmarks.csv` and `rois.csv` for the batch, and for each file `NAME.functions.csv`,
/// `.density_recovery.csv`, `.points.csv`, `.spectrum.csv`, `.spectrum.png`, `.maps.csv`,
/// `.maps.svg`, `.profiles.csv`, `.envelope.csv` and `.verdict.svg`.
///
/// # Errors
/// Fails if an option is out of range, a window is to be read from a file and that file cannot be
/// read, or `out` cannot be written to. Coordinate files that fail are listed in the outcome and in
/// `failures.csv`.
pub fn measure_files(
    inputs: &[Input],
    options: &CoordinatesOptions,
    out: &Path,
    progress: &dyn Progress,
) -> Result<CoordinatesOutcome, BatchError> {
    work_through(inputs, options, out, progress, |_, _| Ok(Vec::new()))
}

/// Measures the points of coordinate files, compares them with samplers and writes the results into
/// `out`.
///
/// Writes the same files as [`measure_files`]. Adds `regularity.csv` and `l_infinity.csv` (one row
/// per file, as in Tables 1 and 2 of Lanaro et al. 2020,
/// <https://doi.org/10.1088/2399-6528/ab8064>) and `finding.csv` (one row per sampler: rank
/// correlation of regularity index and l-infinity distance).
///
/// # Errors
/// Fails under the same conditions as [`measure_files`].
pub fn compare_files(
    inputs: &[Input],
    options: &CoordinatesOptions,
    out: &Path,
    progress: &dyn Progress,
) -> Result<CoordinatesOutcome, BatchError> {
    work_through(inputs, options, out, progress, |out, done| {
        let names = options.plan.sampler_names();
        let records = || done.iter().map(|d| &d.record);
        out.write(tables::REGULARITY.file, &tables::REGULARITY.csv(records())?)?;
        let layout = tables::Layout { samplers: &names, parts: &[] };
        out.write(tables::L_INFINITY.file, &tables::L_INFINITY.csv_as(&layout, records())?)?;
        let findings = findings(done, &names, options.plan.seed);
        out.write(tables::FINDING.file, &tables::FINDING.csv(&findings)?)?;
        Ok(findings)
    })
}

/// Measures every file and writes the files that [`measure_files`] and [`compare_files`] have in
/// common. `more` writes any other files and returns the findings.
fn work_through(
    inputs: &[Input],
    options: &CoordinatesOptions,
    out: &Path,
    progress: &dyn Progress,
    more: impl FnOnce(&ResultFolder, &[Done]) -> Result<Vec<FindingRecord>, BatchError>,
) -> Result<CoordinatesOutcome, BatchError> {
    let plan = &options.plan;
    plan.validate()?;
    plan.rois.iter().try_for_each(|request| request.refuse_overlap(out))?;
    let regions = Regions::new(options)?;
    let out = ResultFolder::open(out)?;
    let references = plan.references();
    let worked = for_each(inputs, progress, |input| {
        let (mosaic, outside) = load(input, options, &regions)?;
        let specimen = Specimen { input, mosaic, outside, image: None, found: None };
        let analysis = analyse(&specimen, plan, &references)?;
        write(&analysis, &specimen, plan, &out, Layout::Beside)?;
        let Analysis { record, warnings, landmarks, regions, .. } = analysis;
        let file = input.path.display().to_string();
        let record = CoordinatesRecord { file, name: input.name.clone(), outside, mosaic: record, warnings };
        let line = line_about(&record);
        Ok((Done { record, landmarks, regions }, line))
    });
    write_tables(&out, options, &worked)?;
    let findings = more(&out, &worked.done)?;
    write_failures(&out, &worked.failures)?;
    let ending = out.close(worked.left)?;
    let records = worked.done.into_iter().map(|d| d.record).collect();
    Ok(CoordinatesOutcome { records, failures: worked.failures, findings, ending })
}

/// Writes the tables that cover all files.
fn write_tables(
    out: &ResultFolder,
    options: &CoordinatesOptions,
    worked: &Worked<Done>,
) -> Result<(), BatchError> {
    let plan = &options.plan;
    let done = &worked.done;
    let summary = plan.summary(SummaryKind::Coordinates);
    let subjects: Vec<(&str, Subject)> =
        done.iter().map(|d| (d.record.name.as_str(), Subject::Coordinates(&d.record))).collect();
    out.write("summary.csv", &summary.csv(subjects.iter().map(|(_, subject)| *subject))?)?;
    let objects: Result<Vec<_>, _> = subjects.iter().map(|(_, subject)| summary.json(subject)).collect();
    out.write_json("summary.json", &objects?)?;
    plan.labels.write_groups(out, &summary, &subjects)?;
    if plan.maps.is_some() {
        write_landmarks(out, done.iter().filter_map(|d| d.landmarks.as_ref()))?;
    }
    if plan.rois.is_some() {
        let rows: Vec<RoiRow> = done.iter().flat_map(|d| d.regions.iter().cloned()).collect();
        write_rois(out, &summary, &rows)?;
    }
    if plan.verdict.is_some() {
        let found = done.iter().map(|d| (d.record.file.as_str(), d.record.mosaic.verdicts.as_slice()));
        write_verdicts(out, found)?;
    }
    out.write_json("options.json", &options_json(options))
}

/// Returns the content of `options.json`: how coordinates were read, measured and compared.
fn options_json(options: &CoordinatesOptions) -> serde_json::Value {
    let mut record = serde_json::json!({
        "program": "conemosaic",
        "version": env!("CARGO_PKG_VERSION"),
        "read": options.read,
        "window": options.region.to_string(),
        "images": options.images,
        "crop": options.crop.map(|c| c.to_string()),
        "torus": options.torus,
    });
    if let (Some(record), serde_json::Value::Object(plan)) = (record.as_object_mut(), options.plan.describe())
    {
        record.extend(plan);
    }
    record
}

/// Returns the line that is shown to the user about the result of one file.
fn line_about(record: &CoordinatesRecord) -> String {
    let ri = record.mosaic.stats.nearest.ri.map(|ri| format!(", RI {ri:.2}")).unwrap_or_default();
    let closest = record.mosaic.closest_sampler().map(|s| format!(", closest to {s}")).unwrap_or_default();
    format!("{}{ri}{closest}", counted(record.mosaic.n, "point"))
}

/// Correlates the regularity index with the distance to each sampler, over all files. This tests on
/// these mosaics the main finding of Lanaro et al. (2020): the more regular a mosaic is, the nearer
/// it is to BNOT and the farther from dart throwing.
fn findings(done: &[Done], samplers: &[String], seed: u64) -> Vec<FindingRecord> {
    let of = |sampler: &String| {
        let both = |d: &Done| {
            let mosaic = &d.record.mosaic;
            Some((mosaic.stats.nearest.ri?, mosaic.distance_to(sampler)?))
        };
        let pairs: Vec<(f64, f64)> = done.iter().filter_map(both).collect();
        FindingRecord::of(sampler, &pairs, seed)
    };
    samplers.iter().map(of).collect()
}

/// Reads the mosaic in a coordinate file. Also returns the number of its points that lie outside
/// the window.
///
/// The number does not include points inside the window that a crop cuts off, since it is the
/// purpose of a crop to leave them out.
fn load(
    input: &Input,
    options: &CoordinatesOptions,
    regions: &Regions,
) -> Result<(Mosaic, usize), BatchError> {
    let file = read_coordinates(&input.path, &options.read)?;
    let unit = match options.region {
        // coordinates in the unit square have no unit, whatever the file says
        Region::Unit => LengthUnit::Unit,
        _ => file.unit.unwrap_or(LengthUnit::Pixel),
    };
    let scales = &options.plan.scales;
    let (window, scale) = regions.of(&input.path, unit, scales)?;
    let mut points = file.points;
    let expansion = scales.expansion();
    // the file has µm on the slide, but results are in µm of living tissue
    if unit == LengthUnit::Micrometre && expansion != 1. {
        points.iter_mut().for_each(|p| *p = Point::new(p.x * expansion, p.y * expansion));
    }
    let outside = points.iter().filter(|&&p| !window.contains(p)).count();
    let window = match &options.crop {
        None => window,
        Some(crop) => {
            let frame = crop.frame("the crop", &input.path, &window.bounds(), unit, scale)?;
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
