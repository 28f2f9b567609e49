use super::coordinates::{CoordinatesOptions, CoordinatesOutcome, line_about, load, options_json, record};
use super::failures::write_failures;
use super::measured::{distances, not_compared};
use super::outputs::OutputFolder;
use super::region::Regions;
use super::verdicts::{self, verdicts_on};
use super::work::for_each;
use super::{BatchError, Input, Progress};
use crate::compare::{References, VerdictOptions};
use crate::report::{CoordinatesRecord, FindingRecord, tables};
use crate::sample::Sampler;
use crate::stats::measure;
use std::path::Path;
use std::sync::Arc;

/// What mosaics are compared with, and how.
#[derive(Clone)]
pub struct CompareOptions {
    /// The samplers.
    pub samplers: Vec<&'static dyn Sampler>,
    /// Simulate each at every mosaic's own n and window; `None`: distances only.
    pub verdict: Option<VerdictOptions>,
    /// Seed of everything random.
    pub seed: u64,
}

/// Writes `regularity.csv` and `l_infinity.csv` (the paper's Tables 1 and 2: one row a file), `finding.csv` (one row a
/// sampler: rank correlation of the two) and, for verdicts, `verdicts.csv`, `NAME.envelope.csv` and `NAME.verdict.svg`.
///
/// # Errors
/// If an option is out of range, the file of a window cannot be read or `out` cannot be written to. Files that fail are
/// in the outcome and in `failures.csv`.
pub fn compare_files(
    inputs: &[Input],
    options: &CoordinatesOptions,
    with: &CompareOptions,
    out: &Path,
    progress: &dyn Progress,
) -> Result<CoordinatesOutcome, BatchError> {
    with.verdict.iter().try_for_each(VerdictOptions::validate)?;
    let regions = Regions::new(&options.region, &options.read)?;
    let out = OutputFolder::create(out)?;
    let (samplers, seed) = (&with.samplers, with.seed);
    let references = References::new(samplers.clone(), options.measure.pcf, seed);
    let (records, failures) = for_each(inputs, progress, |input| {
        let (mosaic, outside) = load(input, options, &regions)?;
        let measures = measure(&mosaic, &options.measure);
        let curves = match &measures.pcf {
            Ok(_) => references.curves(mosaic.len(), mosaic.window()).unwrap_or_default(),
            Err(_) => Arc::default(),
        };
        let mut record = record(input, &mosaic, outside, &measures, distances(&measures, &curves)?);
        record.warnings.extend(not_compared(&measures, samplers, &curves));
        let (verdicts, none) = verdicts_on(&mosaic, &measures, samplers, with.verdict.as_ref(), seed);
        record.warnings.extend(none);
        record.mosaic.verdicts = verdicts::records(&verdicts);
        verdicts::write(&out, &format!("{}.", input.name), &input.name, &measures, &verdicts)?;
        let closest = record.mosaic.closest_sampler().unwrap_or("none");
        let line = format!("{}, closest to {closest}", line_about(&record));
        Ok((record, line))
    });
    let names: Vec<String> = samplers.iter().map(|s| s.name().to_owned()).collect();
    out.write(tables::REGULARITY.file, &tables::REGULARITY.csv(&records)?)?;
    let layout = tables::Layout { samplers: &names, parts: &[] };
    out.write(tables::L_INFINITY.file, &tables::L_INFINITY.csv_as(&layout, &records)?)?;
    let findings = findings(&records, &names, seed);
    out.write(tables::FINDING.file, &tables::FINDING.csv(&findings)?)?;
    if with.verdict.is_some() {
        let found = records.iter().map(|r| (r.file.as_str(), r.mosaic.verdicts.as_slice()));
        verdicts::write_table(&out, found)?;
    }
    let samplers = serde_json::json!({ "names": names, "seed": seed, "verdict": with.verdict });
    out.write_json("options.json", &options_json(options, samplers))?;
    write_failures(&out, &failures)?;
    Ok(CoordinatesOutcome { records, failures, findings })
}

/// The paper's main finding on these mosaics, one record a sampler: regularity against distance.
fn findings(records: &[CoordinatesRecord], samplers: &[String], seed: u64) -> Vec<FindingRecord> {
    let of = |sampler: &String| {
        let both = |r: &CoordinatesRecord| Some((r.mosaic.stats.nearest.ri?, r.mosaic.distance_to(sampler)?));
        let pairs: Vec<(f64, f64)> = records.iter().filter_map(both).collect();
        FindingRecord::of(sampler, &pairs, seed)
    };
    samplers.iter().map(of).collect()
}
