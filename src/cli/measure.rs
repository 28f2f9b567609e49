use super::args::{Common, Defaults, PlanArgs};
use super::mosaic_args::MosaicArgs;
use super::{Done, ending_words, short_table, warnings_table};
use anyhow::Result;
use clap::Args;
use conemosaic::batch::{CoordinatesOptions, CoordinatesOutcome, coordinate_files, measure_files};
use conemosaic::compare::VerdictOptions;
use conemosaic::report::{Cell, CoordinatesRecord, Subject, SummaryKind, counted};
use std::path::{Path, PathBuf};

/// Measures mosaics: coordinate files from anywhere → statistics
#[derive(Args)]
#[command(after_help = "\
Examples:
  conemosaic measure marks --window 150x150 --origin 1 --um-per-px 0.42 --out measured
  conemosaic measure marks --um-per-px 0.42 --crop 55x55um --out middle
  conemosaic measure montage.csv --um-per-px 0.42 --maps --out maps
  conemosaic measure montage.csv --um-per-px 0.42 --roi-side 40um --roi-cells 100 --out regions

Reads CSV and its relatives, WebPlotDigitizer projects and CSVs, ImageJ results and regions.

Writes to measured/:
  summary.csv    one row per file; `conemosaic metrics` says what each column is, here and below
  summary.json   the same
  verdicts.csv   with --verdict: one row per file and sampler; NAME.envelope.csv, NAME.verdict.svg
  groups.csv     with --group-by: mean, SD and number of every column by group
  NAME.pcf.csv   pair correlation function (r in hexagonal spacings, g)
  NAME.functions.csv, NAME.points.csv
                 with --functions: G, F, J, K, L and g by distance, columns named as spatstat's corrections (lengths in the
                 unit of the coordinates); per point its nearest neighbour (row, from 1), border distance, Voronoi cell
                 (dirichlet_area: within the window), sides, bound, inter-cell distance, |ψ6|, directions of its
                 nearest neighbour (0–180°) and of its hexagon (0–60°)
  NAME.density_recovery.csv
                 with --functions: density by distance from the average point (Rodieck 1991)
  NAME.spectrum.csv, NAME.spectrum.png   with --spectrum: mean power and anisotropy (dB; 0 without direction) by frequency in
                 √density (√n in the unit square; independent points have power 1), and the plane of wave vectors
  NAME.maps.csv, NAME.maps.svg, NAME.profiles.csv
                 with --maps: one row per cone with side and bound cells of its window, flag (empty; edge: reaches beyond the
                 mosaic; few: not enough cells) and local values; the maps; density and spacing by distance from the CDC, in
                 rings and along the four meridians
  landmarks.csv  with --maps, one row per file: peak (pcd), centroid (cdc), isodensity area, ellipse fitted to its contour
  rois.csv       with --rois or --roi-side, one row per region: its box, flag (edge: reaches beyond the window and is cut; few:
                 not enough bound cells; outside: none of the window), and the columns of summary.csv for the points in it,
                 by their own Voronoi cells, bound by the region
  options.json   how it was measured
  failures.csv   files that failed, if any; then the exit code is 2")]
pub struct Measure {
    /// Coordinate files and folders of them
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    mosaic: MosaicArgs,
    /// Also simulate every sampler at each mosaic's own number of points and window: the p-value of each, and the
    /// distances at which it differs
    #[arg(long, help_heading = "Comparison with samplers")]
    verdict: bool,
    /// Simulations of each sampler for --verdict (39–9999)
    #[arg(long, value_name = "N", requires = "verdict", default_value_t = VerdictOptions::default().simulations, help_heading = "Comparison with samplers")]
    simulations: usize,
    #[command(flatten)]
    plan: PlanArgs,
}

impl Measure {
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

pub fn say_failures(common: &Common, outcome: &CoordinatesOutcome, out: &Path) {
    if !outcome.failures.is_empty() {
        let failed = counted(outcome.failures.len(), "file");
        common.say(&format!("{failed} failed: {}/failures.csv", out.display()));
    }
}

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

/// The file's name, marked if there is a warning.
pub fn marked(record: &CoordinatesRecord) -> String {
    format!("{}{}", record.file, if record.warnings.is_empty() { "" } else { " !" })
}

/// The warnings of the files, as the end of a table.
pub fn warned(outcome: &CoordinatesOutcome, table: &str) -> String {
    let files = outcome.records.iter().map(|r| (r.file.as_str(), r.warnings.as_slice()));
    warnings_table(files, table)
}
