use super::args::{Common, Defaults, PlanArgs};
use super::measure::{marked, say_failures, warned};
use super::mosaic_args::MosaicArgs;
use super::{Done, ending_words, short_table};
use anyhow::Result;
use clap::Args;
use conemosaic::batch::{CoordinatesOutcome, compare_files, coordinate_files};
use conemosaic::compare::VerdictOptions;
use conemosaic::report::{FindingRecord, VerdictRecord, significant};
use conemosaic::sample::Sampler;
use std::path::PathBuf;

/// Examples, an explanation of terms, and the files written, for the end of the help.
const HELP: &str = include_str!("help/compare.txt").trim_ascii_end();

/// Compares mosaics with random point patterns (samplers)
///
/// Takes coordinate files and measures them as `conemosaic measure` does. Each mosaic is then
/// compared, by its pair correlation function g(r), with samplers: models that draw random point
/// patterns of different regularity. The result is a distance to each sampler, and a
/// verdict: whether the mosaic could be a pattern drawn by that sampler.
#[derive(Args)]
#[command(after_help = HELP)]
pub struct Compare {
    /// Coordinate files, and folders of them
    ///
    /// CSV and other text tables, WebPlotDigitizer projects and CSV files, ImageJ results and
    /// regions (ROI).
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Folder for the results; it is created if it does not exist
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Number of simulations of each sampler for a verdict (39–9999)
    ///
    /// The smallest possible p-value is 1/(N + 1).
    #[arg(long, value_name = "N", default_value_t = VerdictOptions::default().simulations)]
    simulations: usize,
    /// Compute distances only; faster, as nothing is simulated
    #[arg(long, conflicts_with = "simulations")]
    no_verdict: bool,
    #[command(flatten)]
    mosaic: MosaicArgs,
    #[command(flatten)]
    plan: PlanArgs,
}

impl Compare {
    /// Compares the files, writes the results and prints them.
    ///
    /// # Errors
    /// Fails if an option is wrong, there are no coordinate files, or the results cannot be
    /// written.
    pub fn execute(self, common: &Common) -> Result<Done> {
        let verdict = VerdictOptions { simulations: self.simulations, ..VerdictOptions::default() };
        let verdict = (!self.no_verdict).then_some(verdict);
        let read = self.mosaic.read()?;
        let plan = self.plan.plan(&read, Defaults { compare: true, verdict, seed: common.seed })?;
        let options = self.mosaic.options(plan, read);
        let inputs = coordinate_files(&self.files, Some(&self.out))?;
        let outcome = compare_files(&inputs, &options, &self.out, &*common.progress())?;
        if !outcome.records.is_empty() {
            common.say(&distances(&outcome, &options.plan.samplers));
            if outcome.records.iter().any(|r| !r.mosaic.verdicts.is_empty()) {
                common.say(&format!("\n{}", verdicts(&outcome)));
            }
            common.say(&format!("\nRegularity and distance:{}", findings(&outcome.findings)));
        }
        common.say(&format!("\nTables: {}", self.out.join("*.csv").display()));
        say_failures(common, &outcome, &self.out);
        common.say(&ending_words(&outcome.ending, inputs.len()));
        Ok(Done::of(&outcome.failures, &outcome.ending))
    }
}

/// Returns a table with one row per file: regularity and the distance to every sampler.
fn distances(outcome: &CoordinatesOutcome, samplers: &[&'static dyn Sampler]) -> String {
    let headers: Vec<&str> = ["file", "points", "RI"]
        .into_iter()
        .chain(samplers.iter().map(|s| s.name()))
        .chain(["closest"])
        .collect();
    let rows: Vec<Vec<String>> = outcome
        .records
        .iter()
        .map(|r| {
            let distance = |s: &&'static dyn Sampler| {
                r.mosaic.distance_to(s.name()).map_or("–".into(), |d| significant(d, 3))
            };
            let ri = r.mosaic.stats.nearest.ri.map_or("–".into(), |ri| significant(ri, 3));
            [marked(r), r.mosaic.n.to_string(), ri]
                .into_iter()
                .chain(samplers.iter().map(distance))
                .chain([r.mosaic.closest_sampler().unwrap_or("–").to_owned()])
                .collect()
        })
        .collect();
    short_table(&headers, &rows, "l_infinity.csv") + &warned(outcome, "l_infinity.csv")
}

/// Returns a table with one row per file: the verdicts.
///
/// A verdict names the samplers from which the mosaic of the file could be drawn. If there are
/// none, it says how the mosaic differs from the nearest sampler.
fn verdicts(outcome: &CoordinatesOutcome) -> String {
    let headers =
        ["file", "l∞ to simulations", "usual l∞", "95 % below", "p of l∞", "verdict by the envelope of g(r)"];
    let rows: Vec<Vec<String>> = outcome
        .records
        .iter()
        .filter_map(|r| {
            let all = &r.mosaic.verdicts;
            let nearest = all.iter().min_by(|a, b| a.l_infinity.total_cmp(&b.l_infinity))?;
            let alike: Vec<&VerdictRecord> = all.iter().filter(|v| v.alike).collect();
            let told: Vec<String> = match &alike[..] {
                [] => vec![nearest.words()],
                alike => alike.iter().map(|v| v.words()).collect(),
            };
            let others = all.len() - told.len();
            let others = if others == 0 { String::new() } else { format!("; differs from {others} more") };
            let shown =
                alike.iter().min_by(|a, b| a.l_infinity.total_cmp(&b.l_infinity)).copied().unwrap_or(nearest);
            let [distance, usual, most] =
                [shown.l_infinity, shown.l_infinity_usual, shown.l_infinity_most].map(|d| format!("{d:.2}"));
            let p = significant(shown.p_l_infinity, 2);
            Some(vec![r.file.clone(), distance, usual, most, p, told.join("; ") + &others])
        })
        .collect();
    short_table(&headers, &rows, "verdicts.csv")
}

/// Returns one line per sampler, or the reason why nothing was tested.
fn findings(findings: &[FindingRecord]) -> String {
    let tested = |f: &&FindingRecord| f.correlation.is_some();
    match findings.iter().find(tested) {
        Some(_) => findings.iter().map(|f| format!("\n  {}", f.words())).collect(),
        None => findings.first().map(|f| format!(" {}", f.reason())).unwrap_or_default(),
    }
}
