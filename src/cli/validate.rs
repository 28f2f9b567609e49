use super::Done;
use super::common::Common;
use super::detect::DetectArgs;
use super::measure::CoordinateArgs;
use anyhow::{Result, bail};
use clap::Args;
use conemosaic::batch::{Detected, ValidationOptions, ValidationOutcome, validate_files};
use conemosaic::compare::{Assignment, MatchOptions};
use conemosaic::mosaic::io::{Origin, ReadOptions};
use conemosaic::report::{counted, significant, table};
use std::path::PathBuf;

/// Holds detections against hand-plotted marks: sensitivity, false discovery rate, Dice
#[derive(Args)]
#[command(after_help = "\
Examples:
  conemosaic validate --reference marks --origin 1 --images marks --out scores
  conemosaic validate --reference marks --detections cones --out scores --assignment optimal

Marks are NAME_coords.csv or NAME.csv. A mark matches the nearest detection within 0.75 × the median nearest-neighbour distance of the marks; 7 px along the border do not count (Cunefare et al. 2017).

Writes to scores/:
  validation.csv    one row an image
  validation.json   means and pooled rates
  failures.csv      marks that could not be scored, if any; then the exit code is 2")]
pub struct Validate {
    /// Folder of hand marks
    #[arg(long, value_name = "DIR")]
    reference: PathBuf,
    /// Folder of detections NAME.csv, of this program or another
    #[arg(long, value_name = "DIR", required_unless_present = "images", conflicts_with = "images")]
    detections: Option<PathBuf>,
    /// Folder of images NAME.png or NAME.tif to detect cones in
    #[arg(long, value_name = "DIR")]
    images: Option<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Size of the images in px [default: from the image beside the marks or in --images]
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(usize, usize)>,
    /// Who gets whom where several are near: nearest (as published) or optimal (Hungarian, one to one)
    #[arg(long, value_name = "A", default_value = "nearest", value_parser = ["nearest", "optimal"])]
    assignment: String,
    /// Width in px of the border in which nothing counts
    #[arg(long, value_name = "PX", default_value_t = 7.)]
    border: f64,
    /// Reach of a mark, as a fraction of the median nearest-neighbour distance of the marks
    #[arg(long, value_name = "F", default_value_t = 0.75)]
    reach: f64,
    /// What the detections call the centre of the top-left pixel: 0, 0.5 or 1
    #[arg(long, value_name = "O", default_value = "0", conflicts_with = "images")]
    detections_origin: String,
    #[command(flatten)]
    marks: CoordinateArgs,
    #[command(flatten)]
    detect: DetectArgs,
}

fn size(text: &str) -> Result<(usize, usize), String> {
    let parts: Option<Vec<usize>> = text.split('x').map(|p| p.parse().ok().filter(|v| *v > 0)).collect();
    match parts.as_deref() {
        Some(&[width, height]) => Ok((width, height)),
        _ => Err(format!("“{text}” is no size: expected WxH in px")),
    }
}

/// So many of the worst images are named.
const WORST: usize = 5;

impl Validate {
    pub fn execute(self, common: &Common) -> Result<Done> {
        let matching = MatchOptions {
            border: self.border,
            fraction: self.reach,
            assignment: self.assignment.parse::<Assignment>().map_err(anyhow::Error::msg)?,
        };
        matching.validate()?;
        let detected = match (&self.detections, &self.images) {
            (Some(folder), _) => {
                let Ok(origin) = self.detections_origin.parse::<Origin>() else {
                    bail!("--detections-origin {}: expected 0, 0.5 or 1", self.detections_origin);
                };
                let read = ReadOptions { origin: Some(origin), ..ReadOptions::default() };
                Detected::Folder { folder: folder.clone(), read }
            }
            (None, Some(folder)) => {
                Detected::Images { folder: folder.clone(), detect: self.detect.options()? }
            }
            (None, None) => bail!("give --detections or --images"),
        };
        let options = ValidationOptions { read: self.marks.options()?, detected, size: self.size, matching };
        let outcome = validate_files(&self.reference, &options, &self.out, &*common.progress())?;
        common.say(&self.summary(&outcome));
        Ok(Done::with(&outcome.failures))
    }

    fn summary(&self, outcome: &ValidationOutcome) -> String {
        let mut text = String::new();
        for path in &outcome.ignored {
            text.push_str(&format!("not marks of any image, left out: {}\n", path.display()));
        }
        if let Some(summary) = &outcome.summary {
            let four = |v: f64| format!("{v:.4}");
            let rates = |name: &str, s: f64, f: f64, d: f64| vec![name.to_owned(), four(s), four(f), four(d)];
            let pooled = &summary.pooled;
            text.push_str(&table(
                &["", "sensitivity", "FDR", "Dice"],
                &[
                    rates("mean over images", summary.sensitivity, summary.fdr, summary.dice),
                    rates("all cones pooled", pooled.sensitivity, pooled.fdr, pooled.dice),
                ],
            ));
            text.push_str(&format!(
                "\n{}; {} hits, {} misses, {} false alarms; assignment: {}",
                counted(summary.images, "image"),
                pooled.tp,
                pooled.fn_,
                pooled.fp,
                self.assignment
            ));
            if let (Some(px), Some(s)) = (summary.localisation_px, summary.localisation_s) {
                let (px, s) = (significant(px, 2), significant(s, 2));
                text.push_str(&format!("\nmedian distance of hits: {px} px ({s} cone spacings)"));
            }
            if let Some(bias) = summary.density_bias {
                text.push_str(&format!("\ndensity against marks: {:+.1} %", 100. * bias));
                if let Some([low, high]) = summary.density_limits {
                    text.push_str(&format!(" (95 % of images {:+.1} to {:+.1} %)", 100. * low, 100. * high));
                }
            }
            let mut rows: Vec<_> = outcome.rows.iter().collect();
            rows.sort_by(|a, b| a.score.dice.total_cmp(&b.score.dice));
            let worst: Vec<Vec<String>> = rows
                .iter()
                .take(WORST)
                .map(|r| {
                    let s = &r.score;
                    vec![r.name.clone(), s.fn_.to_string(), s.fp.to_string(), four(s.dice)]
                })
                .collect();
            text.push_str("\n\n");
            text.push_str(&table(&["lowest Dice", "misses", "false alarms", "Dice"], &worst));
            text.push_str("\n\n");
        }
        let out = self.out.display();
        text.push_str(&format!("Table: {out}/validation.csv"));
        if !outcome.failures.is_empty() {
            let failed = counted(outcome.failures.len(), "file");
            text.push_str(&format!("\n{failed} of marks failed: {out}/failures.csv"));
        }
        text
    }
}
