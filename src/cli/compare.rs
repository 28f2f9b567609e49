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

/// Compares mosaics with point samplers: distances of pair correlation functions, and what they are worth
#[derive(Args)]
#[command(after_help = "\
Example:
  conemosaic compare marks --window 150x150 --samplers jittered,dart-throwing --out compared

Each mosaic is compared with the mean function of samples of its own size in its own window: l-infinity is the greatest difference of g(r), \
without unit. Two patterns of one and the same process differ too, the more the fewer their points. So every sampler is simulated at the \
mosaic's own number of points and window, and the verdict says whether the mosaic could be one of those:
  as bridson: p = 0.31                                 its g(r) lies among the simulations
  differs from bnot: p = 0.005, at r = 0.90–1.10 s     it leaves their 95 % envelope there (s: hexagonal spacing)

Writes to compared/, beside what `conemosaic measure` writes:
  regularity.csv     nearest neighbours: mean, standard deviation, regularity index (as Table 1 of Lanaro et al.)
  l_infinity.csv     one row per file, one column per sampler (as their Table 2)
  finding.csv        their main finding on these mosaics: rank correlation of the two, with p-value (5 mosaics or more)
  verdicts.csv       one row per file and sampler: p-values, where it differs, what is usual; its l-infinity is to the mean of
                     those simulations, that of l_infinity.csv to the mean curve for mosaics of about this size
  NAME.envelope.csv  g(r) of the mosaic; mean and envelope of each sampler
  NAME.verdict.svg   the same as a figure
  failures.csv       files that failed, if any; then the exit code is 2")]
pub struct Compare {
    /// Coordinate files and folders of them
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Simulations of each sampler for a verdict (39–9999); the smallest p-value is 1/(N + 1)
    #[arg(long, value_name = "N", default_value_t = VerdictOptions::default().simulations)]
    simulations: usize,
    /// Distances only, without simulations: faster
    #[arg(long, conflicts_with = "simulations")]
    no_verdict: bool,
    #[command(flatten)]
    mosaic: MosaicArgs,
    #[command(flatten)]
    plan: PlanArgs,
}

impl Compare {
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

/// One row a file: regularity and the distance to every sampler.
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

/// One row a file: the samplers it could be of, or how it differs from the one nearest to it.
fn verdicts(outcome: &CoordinatesOutcome) -> String {
    let headers = ["file", "l∞ to simulations", "usual", "95 %", "p of l∞", "verdict by the envelope of g"];
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

/// A line a sampler, or one for all of them where nothing was tested.
fn findings(findings: &[FindingRecord]) -> String {
    let tested = |f: &&FindingRecord| f.correlation.is_some();
    match findings.iter().find(tested) {
        Some(_) => findings.iter().map(|f| format!("\n  {}", f.words())).collect(),
        None => findings.first().map(|f| format!(" {}", f.reason())).unwrap_or_default(),
    }
}
