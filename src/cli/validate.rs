use super::args::{Common, CoordinateArgs, DetectArgs, ScaleArgs};
use super::{Done, ending_words, remedies};
use anyhow::{Result, bail};
use clap::Args;
use clap::builder::PossibleValuesParser;
use conemosaic::batch::{Detected, Grouping, ValidationOptions, ValidationOutcome, validate_files};
use conemosaic::compare::{Assignment, MatchOptions, RESAMPLES};
use conemosaic::detect::{DetectOptions, Detector};
use conemosaic::mosaic::io::{GroupTable, Origin, ReadOptions};
use conemosaic::report::{counted, table};
use std::path::PathBuf;
use strum::VariantNames;

/// Holds detections against hand-plotted marks: sensitivity, FDR, Dice, agreement, FROC, reliability
#[derive(Args)]
#[command(after_help = "\
Examples:
  conemosaic validate --reference marks --origin 1 --images marks --group-by prefix:2 --out scores
  conemosaic validate --reference marks --detections cones --images marks --overlay --out scores
  conemosaic validate --reference marks --images marks --versus-detector classical --out scores
  conemosaic validate --reference grader1 --detections cones --versus grader2 --size 150x150 --out scores

Marks are NAME_coords.csv or NAME.csv. A mark matches the nearest detection within 0.75 × the median nearest-neighbour distance of the marks; 7 px along the border do not count (Cunefare et al. 2017). Detections have columns x and y, and may have one called score, confidence or probability.

Writes to scores/:
  index.html          all of it as a page, the worst images first
  validation.csv      one row per image
  validation.json     means, pooled rates, intervals, and everything below
  bland_altman.svg    agreement of count and density
  groups.csv          with --group-by or --group-table: one row per group
  froc.csv, .svg      with scores: sensitivity and false alarms over the threshold
  reliability.csv, .svg  with scores from 0 to 1: are they the probability of a hit?
  comparison.csv, .svg   with --versus: paired differences of two detectors or graders
  NAME.overlay.png    with --overlay: hits, misses and false alarms
  failures.csv        marks that could not be scored, if any; then the exit code is 2")]
pub struct Validate {
    /// Folder of hand marks, or one file of them
    #[arg(long, value_name = "PATH")]
    reference: PathBuf,
    /// Folder of detections NAME.csv or NAME_coords.csv, of this program or another, or one file of them
    #[arg(long, value_name = "PATH", required_unless_present = "images")]
    detections: Option<PathBuf>,
    /// Folder of images NAME.png or NAME.tif, or one image: to detect cones in unless --detections are given, for sizes and
    /// overlays [default: beside the marks]
    #[arg(long, value_name = "PATH")]
    images: Option<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Also draw hits, misses and false alarms on the images
    #[arg(long)]
    overlay: bool,
    /// Size of the images in px [default: from the images]
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(usize, usize)>,
    /// What the detections call the centre of the top-left pixel: 0, 0.5 or 1
    #[arg(long, value_name = "O", default_value = "0", value_parser = origin)]
    detections_origin: Origin,
    /// Who gets whom where several are near: nearest (as published) or optimal (Hungarian, one to one)
    #[arg(long, value_name = "A", default_value = "nearest", value_parser = PossibleValuesParser::new(Assignment::VARIANTS), help_heading = "Scoring")]
    assignment: String,
    /// Width in px of the border in which nothing counts
    #[arg(long, value_name = "PX", default_value_t = 7., help_heading = "Scoring")]
    border: f64,
    /// Reach of a mark, as a fraction of the median nearest-neighbour distance of the marks
    #[arg(long, value_name = "F", default_value_t = 0.75, help_heading = "Scoring")]
    reach: f64,
    /// Images of one subject belong together: prefix:N (the first N parts of the name between underscores) or a regular
    /// expression whose first group is the subject
    #[arg(long, value_name = "RULE", group = "grouping", help_heading = "Groups and intervals")]
    group_by: Option<Grouping>,
    /// The same by a CSV of name,group; a name may be the beginning of many
    #[arg(long, value_name = "FILE", group = "grouping", help_heading = "Groups and intervals")]
    group_table: Option<PathBuf>,
    /// Resamples of the bootstrap (BCa, 95 %), of groups if there are any, else of images; 2000 or more
    #[arg(long, value_name = "N", default_value_t = RESAMPLES as u32, value_parser = clap::value_parser!(u32).range(2000..=1_000_000), help_heading = "Groups and intervals")]
    resamples: u32,
    /// Compare with these detections, or marks of another grader: NAME.csv or NAME_coords.csv
    #[arg(long, value_name = "PATH", group = "second", help_heading = "Comparison of two")]
    versus: Option<PathBuf>,
    /// What they call the centre of the top-left pixel: 0, 0.5 or 1
    #[arg(long, value_name = "O", default_value = "0", requires = "versus", value_parser = origin, help_heading = "Comparison of two")]
    versus_origin: Origin,
    /// Compare with this detector on the same images
    #[arg(long, value_name = "D", group = "second", value_parser = PossibleValuesParser::new(Detector::VARIANTS), help_heading = "Comparison of two")]
    versus_detector: Option<String>,
    #[command(flatten)]
    marks: CoordinateArgs,
    #[command(flatten, next_help_heading = "Detection, without --detections")]
    detect: DetectArgs,
    #[command(flatten)]
    scale: ScaleArgs,
}

fn size(text: &str) -> Result<(usize, usize), String> {
    let parts: Option<Vec<usize>> = text.split('x').map(|p| p.parse().ok().filter(|v| *v > 0)).collect();
    match parts.as_deref() {
        Some(&[width, height]) => Ok((width, height)),
        _ => Err(format!("“{text}” is no size: expected WxH in px")),
    }
}

fn origin(text: &str) -> Result<Origin, String> {
    text.parse().map_err(|_| "expected 0, 0.5 or 1".to_owned())
}

/// So many of the worst images are named.
const WORST: usize = 5;

impl Validate {
    pub fn execute(self, common: &Common) -> Result<Done> {
        let options = self.options(common.seed)?;
        let outcome = validate_files(&self.reference, &options, &self.out, &*common.progress())?;
        common.say(&self.summary(&outcome));
        let total = outcome.rows.len() + outcome.failures.len() + outcome.ending.left;
        common.say(&ending_words(&outcome.ending, total));
        Ok(Done::of(&outcome.failures, &outcome.ending))
    }

    fn options(&self, seed: u64) -> Result<ValidationOptions> {
        let matching = MatchOptions {
            border: self.border,
            fraction: self.reach,
            assignment: self.assignment.parse::<Assignment>().map_err(anyhow::Error::msg)?,
        };
        matching.validate()?;
        let files = |path: &PathBuf, origin: Origin| Detected::Files {
            path: path.clone(),
            read: ReadOptions { origin: Some(origin), ..ReadOptions::default() },
        };
        let detect = self.detect.options()?;
        let detected = match &self.detections {
            Some(given) => files(given, self.detections_origin),
            None if self.detections_origin != Origin::Zero => {
                bail!("--detections-origin {}: there are no --detections", self.detections_origin)
            }
            None => Detected::Detector(detect.clone()),
        };
        let versus = match (&self.versus, &self.versus_detector) {
            (Some(given), _) => Some(files(given, self.versus_origin)),
            (None, Some(name)) => {
                let detector = name.parse::<Detector>().map_err(anyhow::Error::msg)?;
                Some(Detected::Detector(DetectOptions { detector, ..detect }))
            }
            (None, None) => None,
        };
        let grouping = match &self.group_table {
            Some(path) => Some(Grouping::Table(GroupTable::read(path)?)),
            None => self.group_by.clone(),
        };
        Ok(ValidationOptions {
            read: self.marks.options()?,
            detected,
            versus,
            images: self.images.clone(),
            size: self.size,
            matching,
            grouping,
            scales: self.scale.source()?,
            overlays: self.overlay,
            resamples: self.resamples as usize,
            seed,
        })
    }

    fn summary(&self, outcome: &ValidationOutcome) -> String {
        let mut text = String::new();
        for path in &outcome.ignored {
            text.push_str(&format!("not marks of any image, left out: {}\n", path.display()));
        }
        if let Some(analysis) = &outcome.analysis {
            for (_, table) in analysis.tables() {
                text.push_str(&table.to_text());
                text.push_str("\n\n");
            }
            let mut rows: Vec<_> = outcome.rows.iter().collect();
            rows.sort_by(|a, b| a.score.rates.dice.total_cmp(&b.score.rates.dice));
            let worst: Vec<Vec<String>> = rows
                .iter()
                .take(WORST)
                .map(|r| {
                    let rates = &r.score.rates;
                    vec![
                        r.name.clone(),
                        rates.fn_.to_string(),
                        rates.fp.to_string(),
                        format!("{:.4}", rates.dice),
                    ]
                })
                .collect();
            text.push_str(&table(&["lowest Dice", "misses", "false alarms", "Dice"], &worst));
            let pooled = &analysis.summary.pooled;
            text.push_str(&format!(
                "\n\n{}; {} hits, {} misses, {} false alarms; assignment: {}\n{}\n",
                counted(analysis.summary.images, "image"),
                pooled.tp,
                pooled.fn_,
                pooled.fp,
                self.assignment,
                analysis.method,
            ));
            if let Some(comparison) = &analysis.comparison {
                text.push_str(&format!(
                    "p: paired sign-flip permutation test; Dice between the two: {:.4} (mean over images)\n",
                    comparison.between.dice
                ));
            }
            for note in &analysis.notes {
                text.push_str(&format!("note: {}\n", remedies::with_options(note)));
            }
            text.push('\n');
        }
        let out = self.out.display();
        text.push_str(&format!("Page:  {out}/index.html\nTable: {out}/validation.csv"));
        if !outcome.failures.is_empty() {
            let failed = counted(outcome.failures.len(), "file");
            text.push_str(&format!("\n{failed} of marks failed: {out}/failures.csv"));
        }
        text
    }
}
