use super::args::{Common, CoordinateArgs, Defaults, DetectArgs, PlanArgs};
use super::{Done, ending_words, short_table, warnings_table};
use anyhow::{Result, bail};
use clap::Args;
use conemosaic::batch::{
    ConeSource, Crop, GivenCones, ImageWindow, RunOptions, RunOutcome, image_files, run_files,
};
use conemosaic::compare::VerdictOptions;
use conemosaic::mosaic::io::ReadOptions;
use conemosaic::report::{
    Cell, Subject, Summary, SummaryKind, by_need, counted, expected_errors, significant,
};
use std::path::PathBuf;

/// The main job: finds cones, measures the mosaic, compares it with samplers, reports — for files and folders
#[derive(Args)]
#[command(after_help = "\
Examples:
  conemosaic run images --scale-table scales.csv --out report
  conemosaic run images --cones marks --origin 1 --out by_hand

Writes to report/:
  summary.csv               one row per image; `conemosaic metrics` says what each column is
  groups.csv                with --group-by: mean, SD and number of every column by group
  index.html                the same as a page, with figures
  images/NAME/points.csv    cone centres: x_px,y_px,score (0,0: first pixel's centre)
  images/NAME/overlay.png   the image with its cones marked
  images/NAME/figure.svg    picture, points, nearest neighbours, g(r)
  images/NAME/pcf.csv       g(r) of the mosaic and the samplers (r in spacings)
  images/NAME/metrics.json  everything measured
  landmarks.csv             with --maps: one row per image, peak (PCD) and centroid (CDC) of density;
                            and of each image maps.csv (one row per cone), maps.svg, profiles.csv,
                            fourier_map.csv (spacing by the spectrum of the image, from place to place)
  verdicts.csv              with --verdict: one row per image and sampler; and of each image
                            envelope.csv and verdict.svg
  rois.csv                  with --rois or --roi-side: one row per region
  functions.csv, density_recovery.csv, cells.csv, spectrum.csv, spectrum.png
                            in images/NAME, with --functions and --spectrum; see measure --help
  run.json                  version, options, seed, hashes of the inputs, timings
  failures.csv              images that failed, if any; then the exit code is 2

A run into the same folder goes on: results of images, options and a program that did not change are
kept. Cones that you have corrected in images/NAME/points.csv are used, and everything else is made
anew from them. Ctrl-C finishes the images in hand; the same command goes on later.")]
pub struct Run {
    /// Images (PNG, TIFF; 8 or 16 bit, grey or colour) and folders of them
    #[arg(required = true)]
    paths: Vec<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Take the cones from here instead of finding them: hand marks, corrected points, another program's. A folder, or
    /// one file; NAME.csv, NAME_coords.csv or NAME/points.csv belong to the image NAME
    #[arg(long, value_name = "PATH", help_heading = "Given cones")]
    cones: Option<PathBuf>,
    #[command(flatten)]
    coordinates: CoordinateArgs,
    #[command(flatten)]
    detect: DetectArgs,
    /// Also simulate every sampler at each mosaic's own number of cones and window: the p-value of each, and the
    /// distances at which it differs
    #[arg(long, help_heading = "Comparison with samplers")]
    verdict: bool,
    /// Simulations of each sampler for --verdict (39–9999)
    #[arg(long, value_name = "N", requires = "verdict", default_value_t = VerdictOptions::default().simulations, help_heading = "Comparison with samplers")]
    simulations: usize,
    /// The area that counts, for cones as for density: auto (all that was imaged: black margins and the corners between
    /// tiles of a montage are left out), image (all of it), WxH (centred) or X0,Y0,X1,Y1, in px, or in µm with um behind
    /// it, or a FILE of corners: CSV of x,y in px (x_um,y_um: in µm; a blank line or a column “ring” separates rings,
    /// rings within rings are holes), WebPlotDigitizer project or ImageJ ROI
    #[arg(long, value_name = "WINDOW", default_value = "auto", allow_hyphen_values = true)]
    window: ImageWindow,
    /// Of that area only this rectangle: WxH (centred in the image) or X0,Y0,X1,Y1, in px, or in µm with um behind it
    #[arg(long, value_name = "RECT", allow_hyphen_values = true)]
    crop: Option<Crop>,
    /// Start anew instead of keeping what an earlier run has finished
    #[arg(long)]
    fresh: bool,
    /// Find the cones anew even where a person has corrected them; the corrected files are put away
    #[arg(long)]
    replace_corrections: bool,
    /// The default since 0.2: keep what an earlier run with the same options has finished
    #[arg(long, hide = true, conflicts_with = "fresh")]
    resume: bool,
    #[command(flatten)]
    plan: PlanArgs,
}

impl Run {
    pub fn execute(self, common: &Common) -> Result<Done> {
        let read = self.coordinates.options()?;
        if self.cones.is_none() && read != ReadOptions::default() {
            bail!("--origin, --flip-y and --dataset say how given cones are read: add --cones PATH");
        }
        let verdict = VerdictOptions { simulations: self.simulations, ..VerdictOptions::default() };
        let verdict = self.verdict.then_some(verdict);
        let plan = self.plan.plan(&read, Defaults { compare: true, verdict, seed: common.seed })?;
        let cones = match &self.cones {
            Some(place) => ConeSource::Given(GivenCones::find(place, read)?),
            None => ConeSource::Detector(self.detect.options()?),
        };
        let options = RunOptions {
            plan,
            cones,
            window: self.window.clone(),
            crop: self.crop,
            fresh: self.fresh,
            replace_corrections: self.replace_corrections,
            command: std::env::args().collect(),
        };
        let window = match &options.window {
            ImageWindow::Rectangle(rectangle) => Some(("--window", rectangle)),
            ImageWindow::Auto | ImageWindow::Image | ImageWindow::File(_) => None,
        };
        for (option, rectangle) in window.into_iter().chain(options.crop.iter().map(|crop| ("--crop", crop)))
        {
            if options.plan.scales.is_unknown() && rectangle.in_micrometres() {
                bail!("{option} {rectangle} needs a scale: give --um-per-px or another of the scale options");
            }
        }
        let inputs = image_files(&self.paths, Some(&self.out))?;
        let outcome = run_files(&inputs, &options, &self.out, &*common.progress())?;
        common.say(&self.words(&outcome, &options.plan.summary(SummaryKind::Images)));
        common.say(&ending_words(&outcome.ending, inputs.len()));
        Ok(Done::of(&outcome.failures, &outcome.ending))
    }

    fn words(&self, outcome: &RunOutcome, summary: &Summary) -> String {
        let scaled = outcome.records.iter().any(|r| r.mosaic.um_per_unit.is_some());
        let headers = [
            "image",
            "modality",
            "cones",
            if scaled { "cones/mm²" } else { "cones/px²" },
            if scaled { "spacing µm" } else { "spacing px" },
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
                let spacing = r
                    .mosaic
                    .stats
                    .spacing
                    .map(|s| if scaled { s * r.mosaic.um_per_unit.unwrap_or(f64::NAN) } else { s });
                let least = r.mosaic.l_infinity.iter().map(|d| d.l_infinity).min_by(f64::total_cmp);
                let number = |value: Option<f64>| Cell::from(value).readable();
                vec![
                    format!("{}{}", r.name, if r.warnings.is_empty() { "" } else { " !" }),
                    r.detection
                        .as_ref()
                        .map_or_else(|| r.cones_from.name().to_owned(), |d| d.modality.to_string()),
                    r.mosaic.n.to_string(),
                    number(density),
                    number(spacing),
                    r.mosaic.stats.nearest.ri.map_or("–".into(), |ri| significant(ri, 3)),
                    r.mosaic.closest_sampler().unwrap_or("–").to_owned(),
                    least.map_or("–".into(), |d| significant(d, 2)),
                    r.detection.as_ref().map_or("–".into(), expected_errors),
                ]
            })
            .collect();
        let mut text = String::new();
        let need = by_need(&outcome.records);
        let subjects: Vec<Subject> = need.iter().map(|&k| Subject::Image(&outcome.records[k])).collect();
        if let Some((headers, rows)) = summary.readable(&subjects).filter(|(_, rows)| !rows.is_empty()) {
            let headers: Vec<&str> = headers.iter().map(String::as_str).collect();
            text = format!("{}\n\n", short_table(&headers, &rows, "summary.csv"));
        } else if !rows.is_empty() {
            text = short_table(&headers, &rows, "summary.csv");
            let warned = need.iter().map(|&k| &outcome.records[k]);
            let warned = warned.map(|r| (r.name.as_str(), r.warnings.as_slice()));
            text.push_str(&warnings_table(warned, "summary.csv"));
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
        if self.plan.maps_asked() {
            text.push_str(&format!("\nMaps:    {out}/landmarks.csv"));
        }
        if !outcome.failures.is_empty() {
            let failed = counted(outcome.failures.len(), "image");
            text.push_str(&format!("\n{failed} failed: {out}/failures.csv"));
        }
        text
    }
}
