use super::args::{Common, CoordinateArgs, Defaults, DetectArgs, PlanArgs};
use super::{Done, ending_words, short_table, warnings_table};
use anyhow::{Result, bail};
use clap::Args;
use conemosaic::batch::{
    ChannelPatterns, ConeSource, Crop, GivenCones, ImageWindow, RunOptions, RunOutcome, image_files,
    run_files,
};
use conemosaic::compare::VerdictOptions;
use conemosaic::mosaic::io::ReadOptions;
use conemosaic::report::{
    Cell, Subject, Summary, SummaryKind, by_need, counted, expected_errors, significant,
};
use std::path::PathBuf;

/// Examples, files written, and what a second run keeps, for the end of the help.
const HELP: &str = include_str!("help/run.txt").trim_ascii_end();

/// Finds cones, measures their mosaic and writes a report
///
/// Takes images of the human retina. It finds the cones of each image (or takes them from files,
/// with --cones), measures their mosaic, compares it with random point patterns (samplers) and
/// writes tables, figures and a page. No option but --out is needed; with a scale, results are also
/// given in µm, per mm² and in degrees.
#[derive(Args)]
#[command(after_help = HELP)]
pub struct Run {
    /// Images, and folders of them: PNG or TIFF, 8 or 16 bit, grey or colour
    #[arg(required = true)]
    paths: Vec<PathBuf>,
    /// Folder for the results; it is created if it does not exist
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Folder of coordinate files, or one file, of cones to measure instead of detecting them
    ///
    /// The cones may be marked by hand, corrected, or found by another program. The cones of image
    /// NAME are in NAME.csv, NAME_coords.csv or NAME/points.csv.
    #[arg(long, value_name = "PATH", help_heading = "Given cones")]
    cones: Option<PathBuf>,
    #[command(flatten)]
    coordinates: CoordinateArgs,
    #[command(flatten, next_help_heading = "Detection")]
    detect: DetectArgs,
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
    /// Area of the image that is measured; cones outside it do not count
    ///
    /// auto         all that was imaged, without black margins and the black
    ///              corners between the tiles of a montage
    /// image        the whole image
    /// WxH          a rectangle in the middle of the image, in px, or in µm
    ///              with the suffix um, such as 55x55um
    /// X0,Y0,X1,Y1  left, upper, right and lower edge, in px, or all in µm
    ///              with the suffix um at the end, such as 0,0,55,55um
    /// FILE         a file of the corners of one or more polygons: CSV with
    ///              columns x,y in px or x_um,y_um in µm, a WebPlotDigitizer
    ///              project or CSV file, or an ImageJ ROI
    ///
    /// In CSV a blank line or a new value in a column “ring” begins a new
    /// polygon. A polygon inside another is a hole.
    #[arg(long, verbatim_doc_comment, help_heading = None, value_name = "WINDOW", default_value = "auto", allow_hyphen_values = true)]
    window: ImageWindow,
    /// Rectangle to which the window is cut [default: no cut]
    ///
    /// WxH (in the middle of the image) or X0,Y0,X1,Y1, in px, or in µm with the suffix um, such as
    /// 55x55um.
    #[arg(long, help_heading = None, value_name = "RECT", allow_hyphen_values = true)]
    crop: Option<Crop>,
    /// Images of the same field by two channels, whose cones are compared
    ///
    /// Each channel is a modality and a pattern of the file name with one *,
    /// such as confocal=confocal_*,split=split_det_*. Images that match the two
    /// and share what the * stands for are a pair. A column “pair” of --manifest
    /// says the same: rows with the same text there. Writes pairs.csv and
    /// pairs/NAME.csv.
    #[arg(
        long,
        verbatim_doc_comment,
        help_heading = "Detection",
        value_name = "PATTERNS",
        conflicts_with = "modality"
    )]
    pair: Option<ChannelPatterns>,
    /// Compute everything anew instead of keeping finished results of an earlier run
    #[arg(long, help_heading = None)]
    fresh: bool,
    /// Detect cones anew even in images whose points.csv a person has corrected
    ///
    /// The corrected files are moved to .conemosaic/earlier in the folder of the results.
    #[arg(long, help_heading = None)]
    replace_corrections: bool,
    /// Keep finished results of an earlier run with the same options: the default since 0.2
    #[arg(long, hide = true, conflicts_with = "fresh")]
    resume: bool,
    #[command(flatten)]
    plan: PlanArgs,
}

impl Run {
    /// Analyses all images, writes the results and prints the main ones.
    ///
    /// # Errors
    /// Fails if an option is wrong, there are no images, or the results cannot be written.
    pub fn execute(self, common: &Common) -> Result<Done> {
        let read = self.coordinates.options()?;
        if self.cones.is_none() && read != ReadOptions::default() {
            bail!("--origin, --flip-y and --dataset say how the files of --cones are read: add --cones PATH");
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
            pairs: self.pair.clone(),
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
                bail!("{option} {rectangle} needs a scale: give --um-per-px or another scale option");
            }
        }
        let inputs = image_files(&self.paths, Some(&self.out))?;
        let outcome = run_files(&inputs, &options, &self.out, &*common.progress())?;
        common.say(&self.words(&outcome, &options.plan.summary(SummaryKind::Images)));
        common.say(&ending_words(&outcome.ending, inputs.len()));
        Ok(Done::of(&outcome.failures, &outcome.ending))
    }

    /// Returns the text that is printed at the end.
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
            "expected errors",
        ];
        // images that a person should look at come first, because a long table is cut
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
        for pair in &outcome.pairs {
            let ([one, other], [a, b]) = (&pair.modalities, pair.shares);
            text.push_str(&format!(
                "pair {}: {} cones in both, {} in {one} alone, {} in {other} alone (shares {a:.3}, {b:.3}; F1 {:.3})\n",
                pair.name, pair.both, pair.alone[0], pair.alone[1], pair.f1
            ));
            pair.warnings.iter().for_each(|warning| text.push_str(&format!("  note: {warning}\n")));
        }
        outcome.remarks.iter().for_each(|remark| text.push_str(&format!("note: {remark}\n")));
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
        if !outcome.pairs.is_empty() {
            text.push_str(&format!("\nPairs:   {out}/pairs.csv"));
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
