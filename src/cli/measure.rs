use super::args::{Common, Defaults, PlanArgs};
use super::mosaic_args::MosaicArgs;
use super::{Done, ending_words, short_table, warnings_table};
use anyhow::Result;
use clap::Args;
use conemosaic::batch::{CoordinatesOptions, CoordinatesOutcome, coordinate_files, measure_files};
use conemosaic::compare::VerdictOptions;
use conemosaic::report::{Cell, CoordinatesRecord, Subject, SummaryKind, counted};
use std::path::{Path, PathBuf};

/// Examples and files written, for the end of the help.
const HELP: &str = include_str!("help/measure.txt").trim_ascii_end();

/// Measures the mosaics of coordinate files
///
/// Takes files of point coordinates, made by this program, by hand or by another program, and
/// computes density, nearest-neighbour and Voronoi statistics, regularity and the pair
/// correlation function of each. It needs the window in which points could have been seen: from the
/// image of the same name, or by --window. Lengths are in the unit of the coordinates, and
/// in µm if a scale is given.
#[derive(Args)]
#[command(after_help = HELP)]
pub struct Measure {
    /// Coordinate files, and folders of them
    ///
    /// CSV and other text tables, WebPlotDigitizer projects and CSV files, ImageJ results and
    /// regions (ROI).
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Folder for the results; it is created if it does not exist
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    mosaic: MosaicArgs,
    /// Also test whether each mosaic could be drawn from each sampler, by simulation
    ///
    /// Every sampler is simulated with as many points as the mosaic has, in the same window. The
    /// result is a p-value for each sampler, and the distances at which the mosaic differs from it.
    #[arg(long, help_heading = "Comparison with samplers")]
    verdict: bool,
    /// Number of simulations of each sampler for --verdict (39–9999)
    ///
    /// The smallest possible p-value is 1/(N + 1).
    #[arg(long, value_name = "N", requires = "verdict", default_value_t = VerdictOptions::default().simulations, help_heading = "Comparison with samplers")]
    simulations: usize,
    #[command(flatten)]
    plan: PlanArgs,
}

impl Measure {
    /// Measures the files, writes the results and prints the main ones.
    ///
    /// # Errors
    /// Fails if an option is wrong, there are no coordinate files, or the results cannot be
    /// written.
    pub fn execute(self, common: &Common) -> Result<Done> {
        let verdict = VerdictOptions { simulations: self.simulations, ..VerdictOptions::default() };
        let verdict = self.verdict.then_some(verdict);
        let read = self.mosaic.read()?;
        let plan = self.plan.plan(&read, Defaults { compare: false, verdict, seed: common.seed })?;
        let options = self.mosaic.options(plan, read);
        let inputs = coordinate_files(&self.files, Some(&self.out))?;
        let outcome = measure_files(&inputs, &options, &self.out, &*common.progress())?;
        if !outcome.records.is_empty() {
            common.say(&summary(&outcome, &options));
        }
        common.say(&format!("Table: {}/summary.csv", self.out.display()));
        let further = [(options.plan.maps.is_some(), "landmarks"), (options.plan.rois.is_some(), "rois")];
        for (_, table) in further.into_iter().filter(|(written, _)| *written) {
            common.say(&format!("Table: {}/{table}.csv", self.out.display()));
        }
        say_failures(common, &outcome, &self.out);
        common.say(&ending_words(&outcome.ending, inputs.len()));
        Ok(Done::of(&outcome.failures, &outcome.ending))
    }
}

/// Prints how many files failed, if any, and where they are listed.
pub fn say_failures(common: &Common, outcome: &CoordinatesOutcome, out: &Path) {
    if !outcome.failures.is_empty() {
        let failed = counted(outcome.failures.len(), "file");
        common.say(&format!("{failed} failed: {}/failures.csv", out.display()));
    }
}

/// Returns the printed table: the columns chosen by `--metrics`, or by default eight main ones.
fn summary(outcome: &CoordinatesOutcome, options: &CoordinatesOptions) -> String {
    let subjects: Vec<Subject> = outcome.records.iter().map(Subject::Coordinates).collect();
    if let Some((headers, rows)) = options.plan.summary(SummaryKind::Coordinates).readable(&subjects) {
        let headers: Vec<&str> = headers.iter().map(String::as_str).collect();
        return short_table(&headers, &rows, "summary.csv") + &warned(outcome, "summary.csv");
    }
    let scaled = outcome.records.iter().any(|r| r.mosaic.um_per_unit.is_some());
    let density = if scaled { "points/mm²" } else { "points/unit²" };
    let headers = ["file", "points", "unit", "NN mean", "NN SD", "RI", "RI interior", density];
    let rows: Vec<Vec<String>> = outcome
        .records
        .iter()
        .map(|r| {
            let m = &r.mosaic;
            let number = |value: Option<f64>| Cell::from(value).readable();
            vec![
                marked(r),
                m.n.to_string(),
                m.unit.symbol().replace("um", "µm"),
                number(m.stats.nearest.mean),
                number(m.stats.nearest.sd),
                number(m.stats.nearest.ri),
                number(m.stats.nearest_interior.ri),
                number(if scaled { m.density_per_mm2() } else { Some(m.stats.density) }),
            ]
        })
        .collect();
    short_table(&headers, &rows, "summary.csv") + &warned(outcome, "summary.csv")
}

/// Returns the name of the file, followed by an exclamation mark if there are warnings about it.
pub fn marked(record: &CoordinatesRecord) -> String {
    format!("{}{}", record.file, if record.warnings.is_empty() { "" } else { " !" })
}

/// Returns the warnings about the files, to be printed below a table.
///
/// `table` is the file that the last line names for further warnings.
pub fn warned(outcome: &CoordinatesOutcome, table: &str) -> String {
    let files = outcome.records.iter().map(|r| (r.file.as_str(), r.warnings.as_slice()));
    warnings_table(files, table)
}
