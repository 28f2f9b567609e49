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
const HELP: &str = "\
Examples, on the cones of three simulated images:
  mkdir -p images marks
  conemosaic render --preset parafovea --count 3 \\
    --out images/sim.png --truth marks/sim.csv
  conemosaic measure marks --window 150x150 --um-per-px 0.42 --out measured
  conemosaic measure marks --images images --um-per-px 0.42 \\
    --crop 40x40um --out middle
  conemosaic measure marks --window 150x150 --um-per-px 0.42 \\
    --maps --map-cells 20 --out maps
  conemosaic measure marks --window 150x150 --um-per-px 0.42 \\
    --roi-side 20um --roi-cells 10 --out regions

Marks made in MATLAB count from 1: add --origin 1.

Writes to measured/ (`conemosaic metrics` explains every column of every table):
  summary.csv, summary.json
                 one row per file
  NAME.pcf.csv   pair correlation function: r in hexagonal spacings, and g
  groups.csv     with --group-by: mean, SD and number of values of every column
                 for each group
  verdicts.csv, NAME.envelope.csv, NAME.verdict.svg
                 with --verdict: see `conemosaic compare --help`
  NAME.functions.csv
                 with --functions: G, F, J, K, L and g by distance, named after
                 the edge corrections as in spatstat; lengths in the unit of
                 the coordinates
  NAME.points.csv
                 with --functions, one row per point: nearest neighbour (its
                 row, counted from 1), distance to the border, Voronoi cell
                 (dirichlet_area is its area inside the window), number of
                 sides, whether it is bound, inter-cell distance, |ψ6|,
                 direction to the nearest neighbour (0–180°) and of the hexagon
                 of neighbours (0–60°)
  NAME.density_recovery.csv
                 with --functions: density by distance from the average point
                 (Rodieck 1991)
  NAME.spectrum.csv
                 with --spectrum: mean power (1 for independent points) and
                 anisotropy (dB; 0 if there is no preferred direction) by
                 frequency, in units of √density
  NAME.spectrum.png
                 with --spectrum: power by frequency along x and y
  NAME.maps.csv  with --maps, one row per cone: side of its window, bound cells
                 in it, the local values, and a flag (empty: none; edge: the
                 window reaches beyond the mosaic; few: not enough cells)
  NAME.maps.svg  with --maps: the maps
  NAME.profiles.csv
                 with --maps: density and spacing by distance from the density
                 centroid, in rings and along the four meridians
  landmarks.csv  with --maps, one row per file: density peak (pcd) and centroid
                 (cdc), isodensity area, ellipse fitted to its contour
  rois.csv       with --rois or --roi-side, one row per region: its rectangle,
                 a flag (empty: none; edge: it reaches beyond the window and is
                 cut; few: not enough bound cells; outside: it lies outside the
                 window), and the columns of summary.csv for the points in it.
                 Voronoi cells are those of these points alone and are bound by
                 the region
  options.json   options of this measurement
  failures.csv   files that failed, if any; the exit code is then 2";

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
    /// If an option is wrong, there are no coordinate files, or the results cannot be written.
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

/// Returns the table that is printed: the columns chosen by `--metrics`, or a few of all.
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

/// Returns the name of the file, with an exclamation mark if there are warnings about it.
pub fn marked(record: &CoordinatesRecord) -> String {
    format!("{}{}", record.file, if record.warnings.is_empty() { "" } else { " !" })
}

/// Returns the warnings about the files, to be printed below a table.
pub fn warned(outcome: &CoordinatesOutcome, table: &str) -> String {
    let files = outcome.records.iter().map(|r| (r.file.as_str(), r.warnings.as_slice()));
    warnings_table(files, table)
}
