use super::Done;
use super::common::Common;
use super::maps::MapArgs;
use super::metrics::SummaryArgs;
use super::rois::RoiArgs;
use super::scale::ScaleArgs;
use super::short_table;
use anyhow::Result;
use clap::Args;
use conemosaic::batch::{
    CoordinatesOptions, CoordinatesOutcome, Crop, Labels, Region, coordinate_files, measure_files,
};
use conemosaic::mosaic::io::{Origin, ReadOptions};
use conemosaic::report::{Cell, CoordinatesRecord, MetricSelection, PowerScale, Subject, counted};
use conemosaic::stats::{
    Deviation, EdgeCorrection, FunctionOptions, Kernel, MeasureOptions, PcfOptions, SpectrumOptions,
};
use std::path::{Path, PathBuf};

/// How coordinate files are to be understood.
#[derive(Args)]
pub struct CoordinateArgs {
    /// What the file calls the centre of the top-left pixel: 0, 0.5 (ImageJ, WebPlotDigitizer) or 1 (MATLAB)
    /// [default: as the kind of file says, otherwise 0]
    #[arg(long, value_name = "O", value_parser = origin, help_heading = "Coordinates")]
    origin: Option<Origin>,
    /// y points up, as in WebPlotDigitizer's XY axes: the height of the image in the unit of the file
    #[arg(long, value_name = "HEIGHT", help_heading = "Coordinates")]
    flip_y: Option<f64>,
    /// Take only the dataset (WebPlotDigitizer) or region (ImageJ) of this name
    #[arg(long, value_name = "NAME", help_heading = "Coordinates")]
    dataset: Option<String>,
}

fn origin(text: &str) -> Result<Origin, String> {
    text.parse().map_err(|_| "expected 0, 0.5 or 1".to_owned())
}

impl CoordinateArgs {
    pub fn options(&self) -> Result<ReadOptions> {
        let options = ReadOptions { origin: self.origin, flip_y: self.flip_y, dataset: self.dataset.clone() };
        options.validate()?;
        Ok(options)
    }
}

/// Where points could have been seen, and how they are measured.
#[derive(Args)]
pub struct MosaicArgs {
    /// Where points could have been seen: auto (what was imaged of the image of that name beside the file: without black
    /// margins), image (all of it), unit (square), WxH (an image of that size) or X0,Y0,X1,Y1 in the unit of the
    /// coordinates, or a FILE of corners, read as the coordinates are (--origin, --flip-y): CSV of x,y (a blank line or a
    /// column “ring” parts rings, rings within rings are holes), WebPlotDigitizer project or ImageJ ROI
    #[arg(long, value_name = "WINDOW", default_value = "auto", allow_hyphen_values = true)]
    window: Region,
    /// Of that window only this rectangle: WxH (centred in it) or X0,Y0,X1,Y1, in the unit of the coordinates, or with px or
    /// um behind it; points outside are left out
    #[arg(long, value_name = "RECT", allow_hyphen_values = true, conflicts_with = "torus")]
    crop: Option<Crop>,
    /// Opposite edges of the window are the same place
    #[arg(long)]
    torus: bool,
    /// Standard deviation: sample (n − 1) or population (n, as in the tables of Lanaro et al.)
    #[arg(long, value_name = "SD", default_value = "sample", value_parser = ["sample", "population"])]
    sd: String,
    #[command(flatten)]
    coordinates: CoordinateArgs,
    #[command(flatten)]
    pcf: PcfArgs,
    #[command(flatten)]
    scale: ScaleArgs,
}

/// How the pair correlation function is estimated. The unit s is the hexagonal spacing of the mosaic.
#[derive(Args)]
#[command(next_help_heading = "Pair correlation function (s: hexagonal spacing)")]
pub struct PcfArgs {
    /// What makes up for pairs hidden by the border; torus needs --torus
    #[arg(long, value_name = "E", default_value = "set-covariance", value_parser = ["set-covariance", "translation", "isotropic", "torus", "none"])]
    edge: String,
    /// Shape of the smoothing kernel
    #[arg(long, value_name = "K", default_value = "gaussian", value_parser = ["gaussian", "box", "triangle"])]
    kernel: String,
    /// Standard deviation of the kernel in s (0.005–1)
    #[arg(long, value_name = "S", default_value_t = PcfOptions::default().bandwidth)]
    bandwidth: f64,
    /// First bin in s (at least 1.5 bandwidths)
    #[arg(long, value_name = "S", default_value_t = PcfOptions::default().r_min)]
    r_min: f64,
    /// End of the last bin in s (at most 50; default 2.5); with measure --functions it is their last distance instead, in
    /// the unit of the coordinates
    #[arg(long, value_name = "S")]
    r_max: Option<f64>,
    /// Number of bins (1–2000)
    #[arg(long, value_name = "N", default_value_t = PcfOptions::default().bins)]
    bins: usize,
}

impl PcfArgs {
    fn options(&self, r_max: Option<f64>) -> Result<PcfOptions> {
        let options = PcfOptions {
            kernel: match self.kernel.as_str() {
                "box" => Kernel::Box,
                "triangle" => Kernel::Triangle,
                _ => Kernel::Gaussian,
            },
            bandwidth: self.bandwidth,
            r_min: self.r_min,
            r_max: r_max.unwrap_or(PcfOptions::default().r_max),
            bins: self.bins,
            edge: match self.edge.as_str() {
                "translation" => EdgeCorrection::Translation,
                "isotropic" => EdgeCorrection::Isotropic,
                "torus" => EdgeCorrection::Torus,
                "none" => EdgeCorrection::None,
                _ => EdgeCorrection::SetCovariance,
            },
        };
        options.validate()?;
        Ok(options)
    }
}

impl MosaicArgs {
    pub fn options(&self) -> Result<CoordinatesOptions> {
        let deviation = if self.sd == "population" { Deviation::Population } else { Deviation::Sample };
        Ok(CoordinatesOptions {
            read: self.coordinates.options()?,
            region: self.window.clone(),
            crop: self.crop,
            torus: self.torus,
            scales: self.scale.source()?,
            labels: Labels::default(),
            metrics: MetricSelection::default(),
            measure: MeasureOptions { deviation, pcf: self.pcf.options(self.pcf.r_max)? },
            spectrum: None,
            functions: None,
            maps: None,
            rois: None,
        })
    }
}

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
  summary.csv    one row a file; `conemosaic metrics` says what each column is, here and below
  summary.json   the same
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
                 with --maps: a row a cone with side and bound cells of its window, flag (empty; edge: reaches beyond the
                 mosaic; few: not enough cells) and local values; the maps; density and spacing by distance from the CDC, in
                 rings and along the four meridians
  landmarks.csv  with --maps, one row a file: peak (pcd), centroid (cdc), isodensity area, ellipse fitted to its contour
  rois.csv       with --rois or --roi-side, one row a region: its box, flag (edge: reaches beyond the window and is cut; few:
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
    summary: SummaryArgs,
    #[command(flatten)]
    mosaic: MosaicArgs,
    /// Write the power spectrum too; its picture linear (white: 3 times the power of independent points) or in dB (−20 to
    /// +10): --spectrum, --spectrum=db
    #[arg(long, value_name = "SCALE", num_args = 0..=1, require_equals = true, default_missing_value = "linear", value_parser = ["linear", "db"], help_heading = "Power spectrum")]
    spectrum: Option<String>,
    /// Highest frequency of the spectrum in √density (0.1–20)
    #[arg(long, value_name = "F", default_value_t = SpectrumOptions::default().max_frequency, requires = "spectrum", help_heading = "Power spectrum")]
    max_frequency: f64,
    /// Also write G, F, J, K, L and g of every file, with each edge correction, and a table of its points
    #[arg(long, help_heading = "Functions of distance")]
    functions: bool,
    /// Distance between their rows, in the unit of the coordinates [default: 1/128 of --r-max]
    #[arg(long, value_name = "STEP", requires = "functions", help_heading = "Functions of distance")]
    r_step: Option<f64>,
    #[command(flatten)]
    maps: MapArgs,
    #[command(flatten)]
    rois: RoiArgs,
}

impl Measure {
    pub fn execute(mut self, common: &Common) -> Result<Done> {
        let functions = self
            .functions
            .then(|| FunctionOptions { r_step: self.r_step, r_max: self.mosaic.pcf.r_max.take() });
        let mut options = self.mosaic.options()?;
        options.functions = functions;
        options.labels = self.summary.labels()?;
        options.metrics = self.summary.metrics();
        options.maps = self.maps.request()?;
        options.rois = self.rois.request(&options.read)?;
        if let Some(scale) = &self.spectrum {
            let spectrum = SpectrumOptions { max_frequency: self.max_frequency };
            spectrum.validate()?;
            let scale = if scale == "db" { PowerScale::Decibel } else { PowerScale::Linear };
            options.spectrum = Some((spectrum, scale));
        }
        let inputs = coordinate_files(&self.files, Some(&self.out))?;
        let outcome = measure_files(&inputs, &options, &self.out, &*common.progress())?;
        if !outcome.records.is_empty() {
            common.say(&summary(&outcome, &options));
        }
        common.say(&format!("Table: {}/summary.csv", self.out.display()));
        let further = [(options.maps.is_some(), "landmarks"), (options.rois.is_some(), "rois")];
        for (_, table) in further.into_iter().filter(|(written, _)| *written) {
            common.say(&format!("Table: {}/{table}.csv", self.out.display()));
        }
        say_failures(common, &outcome, &self.out);
        Ok(Done::with(&outcome.failures))
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
    if let Some((headers, rows)) = options.summary().readable(&subjects) {
        let headers: Vec<&str> = headers.iter().map(String::as_str).collect();
        return short_table(&headers, &rows, "summary.csv", false);
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
    short_table(&headers, &rows, "summary.csv", warned(outcome))
}

/// The file's name, marked if there is a warning.
pub fn marked(record: &CoordinatesRecord) -> String {
    format!("{}{}", record.file, if record.warnings.is_empty() { "" } else { " !" })
}

pub fn warned(outcome: &CoordinatesOutcome) -> bool {
    outcome.records.iter().any(|r| !r.warnings.is_empty())
}
