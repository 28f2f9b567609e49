use super::Done;
use super::common::Common;
use super::detect::DetectArgs;
use super::maps::MapArgs;
use super::metrics::SummaryArgs;
use super::scale::ScaleArgs;
use super::short_table;
use anyhow::{Result, bail};
use clap::Args;
use conemosaic::batch::{Crop, ImageWindow, RunOptions, RunOutcome, image_files, run_files};
use conemosaic::compare::VerdictOptions;
use conemosaic::report::{Cell, Subject, Summary, by_need, counted, expected_errors, significant};
use conemosaic::sample::samplers_named;
use conemosaic::stats::MeasureOptions;
use std::path::PathBuf;

/// The main job: finds cones, measures the mosaic, compares it with samplers, reports — for files and folders
#[derive(Args)]
#[command(after_help = "\
Example:
  conemosaic run images --scale-table scales.csv --out report

Writes to report/:
  summary.csv               one row an image; `conemosaic metrics` says what each column is
  groups.csv                with --group-by: mean, SD and number of every column by group
  index.html                the same as a page, with figures
  images/NAME/points.csv    cone centres: x_px,y_px,score (0,0: first pixel's centre)
  images/NAME/overlay.png   the image with its cones marked
  images/NAME/figure.svg    picture, points, nearest neighbours, g(r)
  images/NAME/pcf.csv       g(r) of the mosaic and the samplers (r in spacings)
  images/NAME/metrics.json  everything measured
  landmarks.csv             with --maps: one row an image, peak (PCD) and centroid (CDC) of density; and of each image
                            maps.csv (one row a cone), maps.svg, profiles.csv, and fourier_map.csv (spacing by
                            the spectrum of the image, from place to place)
  verdicts.csv              with --verdict: one row an image and sampler; and of each image
                            envelope.csv and verdict.svg
  run.json                  version, options, seed, hashes of the inputs, timings
  failures.csv              images that failed, if any; then the exit code is 2")]
pub struct Run {
    /// Images (PNG, TIFF; 8 or 16 bit, grey or colour) and folders of them
    #[arg(required = true)]
    paths: Vec<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    detect: DetectArgs,
    /// Samplers to compare with, separated by commas; all is every one, slow ones included; none is none [default: those marked * by
    /// `conemosaic sample --list`]
    #[arg(long, value_name = "A,B,…", value_delimiter = ',')]
    samplers: Vec<String>,
    /// Also simulate every sampler at each mosaic's own number of cones and window: the p-value of each, and the
    /// distances at which it differs
    #[arg(long)]
    verdict: bool,
    /// Simulations of each sampler for --verdict (39–9999)
    #[arg(long, value_name = "N", requires = "verdict", default_value_t = VerdictOptions::default().simulations)]
    simulations: usize,
    /// The area that counts, for cones as for density: auto (all that was imaged: black margins and the corners between
    /// tiles of a montage are left out), image (all of it), WxH (centred) or X0,Y0,X1,Y1, in px, or in µm with um behind
    /// it, or a FILE of corners: CSV of x,y in px (x_um,y_um: in µm; a blank line or a column “ring” parts rings, rings
    /// within rings are holes), WebPlotDigitizer project or ImageJ ROI
    #[arg(long, value_name = "WINDOW", default_value = "auto", allow_hyphen_values = true)]
    window: ImageWindow,
    /// Of that area only this rectangle: WxH (centred in the image) or X0,Y0,X1,Y1, in px, or in µm with um behind it
    #[arg(long, value_name = "RECT", allow_hyphen_values = true)]
    crop: Option<Crop>,
    #[command(flatten)]
    summary: SummaryArgs,
    /// Keep what an earlier run with the same options has finished
    #[arg(long)]
    resume: bool,
    #[command(flatten)]
    maps: MapArgs,
    #[command(flatten)]
    scale: ScaleArgs,
}

impl Run {
    pub fn execute(self, common: &Common) -> Result<Done> {
        let options = RunOptions {
            detect: self.detect.options()?,
            measure: MeasureOptions::default(),
            samplers: samplers_named(&self.samplers)?,
            verdict: self
                .verdict
                .then(|| VerdictOptions { simulations: self.simulations, ..VerdictOptions::default() }),
            maps: self.maps.request()?,
            seed: common.seed,
            scales: self.scale.source()?,
            window: self.window.clone(),
            crop: self.crop,
            labels: self.summary.labels()?,
            metrics: self.summary.metrics(),
            resume: self.resume,
            command: std::env::args().collect(),
        };
        let window = match &options.window {
            ImageWindow::Rectangle(rectangle) => Some(("--window", rectangle)),
            ImageWindow::Auto | ImageWindow::Image | ImageWindow::File(_) => None,
        };
        for (option, rectangle) in window.into_iter().chain(options.crop.iter().map(|crop| ("--crop", crop)))
        {
            if options.scales.is_unknown() && rectangle.in_micrometres() {
                bail!("{option} {rectangle} needs a scale: give --um-per-px or another of the scale options");
            }
        }
        let inputs = image_files(&self.paths, Some(&self.out))?;
        let outcome = run_files(&inputs, &options, &self.out, &*common.progress())?;
        common.say(&self.words(&outcome, &options.summary()));
        Ok(Done::with(&outcome.failures))
    }

    fn words(&self, outcome: &RunOutcome, summary: &Summary) -> String {
        let scaled = outcome.records.iter().any(|r| r.mosaic.um_per_unit.is_some());
        let headers = [
            "image",
            "modality",
            "cones",
            if scaled { "cones/mm²" } else { "cones/px²" },
            "spacing px",
            "RI",
            "closest to",
            "l∞",
            "errors",
        ];
        // what needs the eye of a person comes first: a long table is cut
        let rows: Vec<Vec<String>> = by_need(&outcome.records)
            .into_iter()
            .map(|k| {
                let r = &outcome.records[k];
                let density = if scaled { r.mosaic.density_per_mm2() } else { Some(r.mosaic.stats.density) };
                let least = r.mosaic.l_infinity.iter().map(|d| d.l_infinity).min_by(f64::total_cmp);
                let number = |value: Option<f64>| Cell::from(value).readable();
                vec![
                    format!("{}{}", r.name, if r.warnings.is_empty() { "" } else { " !" }),
                    r.detection.modality.to_string(),
                    r.mosaic.n.to_string(),
                    number(density),
                    number(r.mosaic.stats.spacing),
                    r.mosaic.stats.nearest.ri.map_or("–".into(), |ri| significant(ri, 3)),
                    r.mosaic.closest_sampler().unwrap_or("–").to_owned(),
                    least.map_or("–".into(), |d| significant(d, 2)),
                    expected_errors(&r.detection),
                ]
            })
            .collect();
        let mut text = String::new();
        let need = by_need(&outcome.records);
        let subjects: Vec<Subject> = need.iter().map(|&k| Subject::Image(&outcome.records[k])).collect();
        if let Some((headers, rows)) = summary.readable(&subjects).filter(|(_, rows)| !rows.is_empty()) {
            let headers: Vec<&str> = headers.iter().map(String::as_str).collect();
            text = format!("{}\n\n", short_table(&headers, &rows, "summary.csv", false));
        } else if !rows.is_empty() {
            let warned = outcome.records.iter().any(|r| !r.warnings.is_empty());
            text = short_table(&headers, &rows, "summary.csv", warned);
            text.push_str("\n\n");
        }
        let cones: usize = outcome.records.iter().map(|r| r.mosaic.n).sum();
        text.push_str(&format!("{} in {}", counted(cones, "cone"), counted(outcome.records.len(), "image")));
        if outcome.reused > 0 {
            text.push_str(&format!(" ({} kept from an earlier run)", outcome.reused));
        }
        let out = self.out.display();
        text.push_str(&format!("\nTable:   {out}/summary.csv\nPage:    {out}/index.html"));
        if !outcome.records.is_empty() {
            text.push_str(&format!("\nFigures: {out}/images/NAME/figure.svg"));
        }
        if self.maps.asked() {
            text.push_str(&format!("\nMaps:    {out}/landmarks.csv"));
        }
        if !outcome.failures.is_empty() {
            let failed = counted(outcome.failures.len(), "image");
            text.push_str(&format!("\n{failed} failed: {out}/failures.csv"));
        }
        text
    }
}
