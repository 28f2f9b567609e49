use super::detection::{describe, detect_in, overlay_of, read_image, write_detections};
use super::failures::write_failures;
use super::image_figure::figure;
use super::image_window::ImageWindows;
use super::labels::Label;
use super::measured::{distances, not_compared, pcf_table, record_of, warnings_of};
use super::outputs::OutputFolder;
use super::verdicts::{self, verdicts_on};
use super::work::for_each;
use super::{BatchError, Crop, Failure, ImageWindow, Input, Labels, MapRequest, Progress, ScaleSource, maps};
use crate::compare::{ReferenceCurve, References, SamplerCurves, VerdictOptions};
use crate::detect::{DetectOptions, Detections, fourier_spacing, weights};
use crate::geometry::Window;
use crate::image::Plane;
use crate::mosaic::{LengthUnit, Mosaic, Scale};
use crate::report::{
    DetectionRecord, ImageRecord, LandmarkRecord, MetricGroup, MetricSelection, Subject, Summary,
    SummaryKind, page,
};
use crate::sample::Sampler;
use crate::stats::{Histogram, MeasureOptions, Measures, PcfOptions, measure};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fs;
use std::path::Path;
use std::time::Instant;

const IMAGES: &str = "images";
const METRICS: &str = "metrics.json";
/// What an image's folder holds.
const FILES: [&str; 5] = ["points.csv", "overlay.png", "pcf.csv", METRICS, "figure.svg"];

/// Options of the main job.
#[derive(Clone)]
pub struct RunOptions {
    /// How cones are found.
    pub detect: DetectOptions,
    /// How mosaics are measured.
    pub measure: MeasureOptions,
    /// What they are compared with.
    pub samplers: Vec<&'static dyn Sampler>,
    /// Simulate each sampler at every mosaic's own n and window; `None`: distances only.
    pub verdict: Option<VerdictOptions>,
    /// Maps of every mosaic and what is read off them.
    pub maps: Option<MapRequest>,
    /// Seed of the samplers.
    pub seed: u64,
    /// Where scales come from.
    pub scales: ScaleSource,
    /// The area of each image that counts.
    pub window: ImageWindow,
    /// The rectangle of that area that counts; `None`: all of it.
    pub crop: Option<Crop>,
    /// What is known of the images, and which belong together.
    pub labels: Labels,
    /// Columns of `summary.csv`.
    pub metrics: MetricSelection,
    /// Keep the results of an earlier run for images and options that did not change.
    pub resume: bool,
    /// The command line, for `run.json`.
    pub command: Vec<String>,
}

impl RunOptions {
    /// Names of the samplers compared with.
    pub fn sampler_names(&self) -> Vec<String> {
        self.samplers.iter().map(|s| s.name().to_owned()).collect()
    }

    /// The columns of `summary.csv`.
    pub fn summary(&self) -> Summary {
        Summary::new(SummaryKind::Images, &self.metrics, &self.sampler_names(), self.labels.columns())
    }
}

/// What came of a run.
#[derive(Clone, Debug)]
pub struct RunOutcome {
    /// One record an image, in the order of the inputs.
    pub records: Vec<ImageRecord>,
    /// Images without results.
    pub failures: Vec<Failure>,
    /// Images whose earlier results were kept.
    pub reused: usize,
}

/// Wall-clock seconds of the stages of one image. A core that helps another image meanwhile counts on both.
#[derive(Clone, Copy, Debug, Default, Serialize)]
struct Seconds {
    read: f64,
    detect: f64,
    measure: f64,
    compare: f64,
    report: f64,
}

/// All of `metrics.json`.
#[derive(Serialize)]
struct Metrics<'a> {
    #[serde(flatten)]
    record: &'a ImageRecord,
    histogram: &'a Histogram,
    pcf_options: PcfOptions,
    samplers: Vec<SamplerNote<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    landmarks: Option<&'a LandmarkRecord>,
}

/// What of `metrics.json` stands outside the record and is wanted again by `--resume`.
#[derive(Deserialize)]
struct Kept {
    #[serde(default)]
    landmarks: Option<LandmarkRecord>,
}

/// How a sampler's mean curve was made.
#[derive(Serialize)]
struct SamplerNote<'a> {
    sampler: &'a str,
    n: usize,
    realisations: usize,
    ri: Option<f64>,
    /// From the table that comes with the program.
    shipped: bool,
}

struct Done {
    record: ImageRecord,
    landmarks: Option<LandmarkRecord>,
    seconds: Option<Seconds>,
}

/// The main job: detects, measures, compares and reports every image into `out`.
///
/// Writes `images/NAME/` (`points.csv`, `overlay.png`, `metrics.json`, `pcf.csv`, `figure.svg`), `summary.csv`,
/// `index.html`, `run.json`, `groups.csv` if groups are wanted and, if an image failed, `failures.csv`; for maps `images/NAME/` (`maps.csv`, `maps.svg`,
/// `profiles.csv`, `fourier_map.csv`) and `landmarks.csv`. An image's folder appears when it is complete.
///
/// # Errors
/// If the file of a window cannot be read or `out` cannot be written to. Images that fail are in the outcome and in
/// `failures.csv`.
pub fn run_files(
    inputs: &[Input],
    options: &RunOptions,
    out: &Path,
    progress: &dyn Progress,
) -> Result<RunOutcome, BatchError> {
    let started = Instant::now();
    options.verdict.iter().try_for_each(VerdictOptions::validate)?;
    options.labels.validate()?;
    options.maps.iter().try_for_each(MapRequest::validate)?;
    refuse_overlap(inputs, &out.join(IMAGES))?;
    let windows = ImageWindows::new(&options.window, options.crop.as_ref())?;
    let out = OutputFolder::create(out)?;
    let images = OutputFolder::create(&out.join(IMAGES))?;
    let references = References::new(options.samplers.clone(), options.measure.pcf, options.seed);
    let (done, failures) = for_each(inputs, progress, |input| {
        one_image(input, options, &windows, &references, &images).inspect_err(|_| {
            // results of an earlier run would look like this one's; what cannot be removed is not ours
            let _ = images.remove_results(&input.name, &known_files());
        })
    });
    write_failures(&out, &failures)?;

    let (samplers, summary) = (options.sampler_names(), options.summary());
    let subjects: Vec<(&str, Subject)> =
        done.iter().map(|d| (d.record.name.as_str(), Subject::Image(&d.record))).collect();
    let rows: Vec<_> = subjects.iter().map(|(_, subject)| summary.row(subject)).collect();
    out.write_table("summary.csv", &summary.header(), &rows)?;
    options.labels.write_groups(&out, &summary, &subjects)?;
    if options.verdict.is_some() {
        let found = done.iter().map(|d| (d.record.file.as_str(), d.record.mosaic.verdicts.as_slice()));
        let (header, rows) = verdicts::table(found);
        out.write_table("verdicts.csv", &header, &rows)?;
    }
    let landmarks: Vec<Option<LandmarkRecord>> = done.iter().map(|d| d.landmarks.clone()).collect();
    if options.maps.is_some() {
        maps::write_landmarks(&out, landmarks.iter().flatten())?;
    }
    let records: Vec<ImageRecord> = done.iter().map(|d| d.record.clone()).collect();
    let reasons: Vec<(&str, &str)> = failures.iter().map(|f| (f.file.as_str(), f.reason.as_str())).collect();
    out.write("index.html", page(&records, &landmarks, &reasons, &samplers).as_bytes())?;
    out.write_json("run.json", &run_json(options, &done, &failures, started))?;
    let reused = done.iter().filter(|d| d.seconds.is_none()).count();
    Ok(RunOutcome { records, failures, reused })
}

/// The folder of an image's results takes the place of what stood there: no input may.
fn refuse_overlap(inputs: &[Input], images: &Path) -> Result<(), BatchError> {
    let Ok(results) = images.canonicalize() else { return Ok(()) };
    let within = |input: &&Input| input.path.canonicalize().is_ok_and(|path| path.starts_with(&results));
    match inputs.iter().find(within) {
        Some(input) => Err(BatchError::Overlap { file: input.path.clone(), folder: images.to_owned() }),
        None => Ok(()),
    }
}

fn one_image(
    input: &Input,
    options: &RunOptions,
    windows: &ImageWindows,
    references: &References,
    images: &OutputFolder,
) -> Result<(Done, String), BatchError> {
    let mut seconds = Seconds::default();
    let mut clock = Instant::now();
    let mut lap = |stage: &mut f64| {
        *stage = clock.elapsed().as_secs_f64();
        clock = Instant::now();
    };
    let (bytes, image) = read_image(input)?;
    let (height, width) = image.dim();
    let scale = options.scales.scale_of(&input.path, width)?;
    let window = windows.of(&input.path, &image, scale)?;
    let sha256 = hex(&Sha256::digest(&bytes));
    let label = options.labels.of(&input.path, scale)?;
    let options_sha256 = fingerprint(options, scale, &window, &label)?;
    drop(bytes);
    let wants_fourier =
        options.maps.is_some() || options.metrics.has_any_of(MetricGroup::Fourier, SummaryKind::Images);
    if options.resume
        && let Some((record, landmarks)) = earlier(images, input, &sha256, &options_sha256)
        && landmarks.is_some() == options.maps.is_some()
        && (record.fourier.is_some() || !wants_fourier)
    {
        let line =
            format!("{} cones, {}, kept from an earlier run", record.mosaic.n, record.detection.modality);
        return Ok((Done { record, landmarks, seconds: None }, line));
    }
    lap(&mut seconds.read);

    let mut found = detect_in(input, &image, &options.detect)?;
    let all = found.cones.len();
    found.cones.retain(|d| window.contains(d.centre));
    lap(&mut seconds.detect);

    let (mosaic, _) = Mosaic::new(found.centres(), window.clone(), LengthUnit::Pixel, scale)
        .map_err(|source| BatchError::Mosaic { file: input.path.clone(), source })?;
    let measures = measure(&mosaic, &options.measure);
    lap(&mut seconds.measure);

    let curves = match &measures.pcf {
        Ok(_) => references.curves(mosaic.len(), &window),
        Err(_) => SamplerCurves::default(),
    };
    let (verdicts, no_verdicts) =
        verdicts_on(&mosaic, &measures, &options.samplers, options.verdict.as_ref(), options.seed);
    let mut mosaic_record = record_of(&mosaic, &measures, distances(&measures, &curves.curves)?);
    mosaic_record.verdicts = verdicts::records(&verdicts);
    lap(&mut seconds.compare);

    let mut warnings = warnings_of(Some(&found), &mosaic_record, &measures);
    warnings.extend(not_compared(&curves));
    warnings.extend(no_verdicts);
    label.put_on(&mut mosaic_record, &mut warnings);
    let fourier = wants_fourier.then(|| {
        fourier_spacing(&image).map_err(|source| BatchError::Detect { file: input.path.clone(), source })
    });
    let record = ImageRecord {
        file: input.path.display().to_string(),
        name: input.name.clone(),
        sha256,
        options_sha256,
        width_px: width,
        height_px: height,
        detection: DetectionRecord {
            detector: found.detector,
            modality: found.modality,
            modality_confidence: found.modality_confidence,
            polarity: found.polarity,
            n: all,
            ring_spacing_px: found.ring_spacing,
            ring_confidence: found.ring_confidence,
            clarity: found.clarity,
            density_spacing_px: found.spacing,
            spacing_confidence: found.spacing_confidence,
            spacing_range_px: found.spacing_map.range().into(),
            expected_false_alarms: found.expected_false_alarms(),
            expected_misses: found.expected_misses(),
        },
        fourier: fourier.transpose()?,
        warnings,
        mosaic: mosaic_record,
    };
    let mut landmarks = None;
    images.replace_folder(&input.name, &known_files(), |folder| {
        let map = |request| maps::write(folder, "", &record.name, &input.path, (&mosaic, &measures), request);
        landmarks = options.maps.as_ref().map(map).transpose()?;
        if options.maps.is_some() {
            maps::write_fourier(folder, &image, record.fourier.as_ref(), scale)?;
        }
        write_image_folder(folder, &image, &found, &mosaic, &measures, &curves.curves, &record)?;
        folder.write_json(METRICS, &metrics(&record, &measures, &curves.curves, landmarks.as_ref()))?;
        verdicts::write(folder, "", &record.name, &measures, &verdicts)
    })?;
    lap(&mut seconds.report);
    let line = describe(&found);
    tracing::debug!(
        file = record.file,
        modality = %found.modality,
        polarity = found.polarity.name(),
        ring_spacing_px = found.ring_spacing,
        ring_confidence = found.ring_confidence,
        spacing_px = found.spacing,
        cones = found.cones.len(),
    );
    tracing::trace!(file = record.file, ?seconds);
    Ok((Done { record, landmarks, seconds: Some(seconds) }, line))
}

/// Every file that an image's folder of results may hold.
fn known_files() -> Vec<&'static str> {
    [&FILES[..], &verdicts::FILES, &maps::OF_IMAGE].concat()
}

fn write_image_folder(
    folder: &OutputFolder,
    image: &Plane,
    found: &Detections,
    mosaic: &Mosaic,
    measures: &Measures,
    curves: &[ReferenceCurve],
    record: &ImageRecord,
) -> Result<(), BatchError> {
    write_detections(&folder.join("points.csv"), &found.cones, mosaic.scale())?;
    folder.write("overlay.png", &overlay_of(image, found)?)?;
    let (header, rows) = pcf_table(measures, curves);
    folder.write_table("pcf.csv", &header, &rows)?;
    let figure = figure(&record.name, Some(image), mosaic, measures, &record.mosaic, curves)?;
    folder.write("figure.svg", figure.as_bytes())
}

fn metrics<'a>(
    record: &'a ImageRecord,
    measures: &'a Measures,
    curves: &'a [ReferenceCurve],
    landmarks: Option<&'a LandmarkRecord>,
) -> Metrics<'a> {
    let samplers = curves
        .iter()
        .map(|c| SamplerNote {
            sampler: &c.sampler,
            n: c.n,
            realisations: c.realisations,
            ri: c.ri,
            shipped: c.shipped,
        })
        .collect();
    let pcf_options = measures.pcf.as_ref().map_or_else(|_| PcfOptions::default(), |pcf| pcf.options);
    Metrics { record, histogram: &measures.histogram, pcf_options, samplers, landmarks }
}

/// What identifies the options that one image's results depend on, the networks' weights among them.
fn fingerprint(
    options: &RunOptions,
    scale: Option<Scale>,
    window: &Window,
    label: &Label,
) -> Result<String, BatchError> {
    let samplers: Vec<&str> = options.samplers.iter().map(|s| s.name()).collect();
    let relevant = serde_json::to_vec(&(
        env!("CARGO_PKG_VERSION"),
        &options.detect,
        &options.measure,
        samplers,
        options.verdict,
        options.maps,
        options.seed,
        scale,
        window,
        (&label.labels, label.place),
    ))?;
    let mut digest = Sha256::new_with_prefix(relevant);
    weights().iter().for_each(|file| digest.update(file));
    Ok(hex(&digest.finalize()))
}

/// The record of an earlier run and what was read off its maps, if it is complete and belongs to the same image and
/// options.
fn earlier(
    images: &OutputFolder,
    input: &Input,
    sha256: &str,
    options_sha256: &str,
) -> Option<(ImageRecord, Option<LandmarkRecord>)> {
    let folder = images.join(&input.name);
    if !FILES.iter().all(|file| folder.join(file).is_file()) {
        return None;
    }
    let text = fs::read(folder.join(METRICS)).ok()?;
    let record: ImageRecord = serde_json::from_slice(&text).ok()?;
    let files_of_verdicts = || verdicts::FILES.iter().all(|file| folder.join(file).is_file());
    if !record.mosaic.verdicts.is_empty() && !files_of_verdicts() {
        return None;
    }
    let Kept { landmarks } = serde_json::from_slice(&text).ok()?;
    if landmarks.is_some() && !maps::OF_IMAGE.iter().all(|file| folder.join(file).is_file()) {
        return None;
    }
    let same = record.sha256 == sha256 && record.options_sha256 == options_sha256;
    let file = input.path.display().to_string();
    same.then(|| {
        let landmarks = landmarks.map(|l| LandmarkRecord { file: file.clone(), ..l });
        (ImageRecord { file, name: input.name.clone(), ..record }, landmarks)
    })
}

fn run_json(
    options: &RunOptions,
    done: &[Done],
    failures: &[Failure],
    started: Instant,
) -> serde_json::Value {
    let images: Vec<_> = done
        .iter()
        .map(|d| {
            serde_json::json!({
                "file": d.record.file, "name": d.record.name, "sha256": d.record.sha256, "seconds": d.seconds,
            })
        })
        .collect();
    serde_json::json!({
        "program": "conemosaic",
        "version": env!("CARGO_PKG_VERSION"),
        "command": options.command,
        "options": {
            "detect": options.detect,
            "measure": options.measure,
            "samplers": options.samplers.iter().map(|s| s.name()).collect::<Vec<_>>(),
            "verdict": options.verdict,
            "maps": options.maps,
            "window": options.window.to_string(),
            "crop": options.crop.map(|c| c.to_string()),
            "scale": options.scales.describe(),
            "manifest": options.labels.manifest.as_ref().map(|m| m.file()),
            "resume": options.resume,
        },
        "seed": options.seed,
        "threads": rayon::current_num_threads(),
        "seconds": started.elapsed().as_secs_f64(),
        "images": images,
        "failures": failures,
    })
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}
