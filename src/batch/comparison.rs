use super::coordinates::{CoordinatesOptions, CoordinatesOutcome, line_about, load, options_json, record};
use super::failures::write_failures;
use super::measured::{distances, not_compared};
use super::outputs::OutputFolder;
use super::region::Regions;
use super::verdicts::{self, verdicts_on};
use super::work::for_each;
use super::{BatchError, Input, Progress};
use crate::compare::{References, SamplerCurves, VerdictOptions};
use crate::report::{CoordinatesRecord, FindingRecord, tables};
use crate::sample::Sampler;
use crate::stats::measure;
use std::path::Path;

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
            Ok(_) => references.curves(mosaic.len(), mosaic.window()),
            Err(_) => SamplerCurves::default(),
        };
        let mut record = record(input, &mosaic, outside, &measures, distances(&measures, &curves.curves)?);
        record.warnings.extend(not_compared(&curves));
        let (verdicts, none) = verdicts_on(&mosaic, &measures, samplers, with.verdict.as_ref(), seed);
        record.warnings.extend(none);
        record.mosaic.verdicts = verdicts::records(&verdicts);
        verdicts::write(&out, &format!("{}.", input.name), &input.name, &measures, &verdicts)?;
        let closest = record.mosaic.closest_sampler().unwrap_or("none");
        let line = format!("{}, closest to {closest}", line_about(&record));
        Ok((record, line))
    });
    let names: Vec<String> = samplers.iter().map(|s| s.name().to_owned()).collect();
    let rows: Vec<_> = records.iter().map(CoordinatesRecord::regularity_row).collect();
    out.write_described(&tables::REGULARITY, &rows)?;
    let rows: Vec<_> = records.iter().map(|r| r.distance_row(&names)).collect();
    out.write_table("l_infinity.csv", &CoordinatesRecord::distance_header(&names), &rows)?;
    let findings = findings(&records, &names, seed);
    let rows: Vec<_> = findings.iter().map(FindingRecord::row).collect();
    out.write_table("finding.csv", &FindingRecord::header(), &rows)?;
    if with.verdict.is_some() {
        let found = records.iter().map(|r| (r.file.as_str(), r.mosaic.verdicts.as_slice()));
        let (header, rows) = verdicts::table(found);
        out.write_table("verdicts.csv", &header, &rows)?;
    }
    let samplers = serde_json::json!({ "names": names, "seed": seed, "verdict": with.verdict });
    out.write_json("options.json", &options_json(options, samplers))?;
    write_failures(&out, &failures)?;
    Ok(CoordinatesOutcome { records, failures, findings })
}

/// The paper's main finding on these mosaics, one record a sampler: regularity against distance.
fn findings(records: &[CoordinatesRecord], samplers: &[String], seed: u64) -> Vec<FindingRecord> {
    let of = |sampler: &String| {
        let both = |r: &CoordinatesRecord| Some((r.mosaic.nearest.ri?, r.mosaic.distance_to(sampler)?));
        let pairs: Vec<(f64, f64)> = records.iter().filter_map(both).collect();
        FindingRecord::of(sampler, &pairs, seed)
    };
    samplers.iter().map(of).collect()
}
