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

/// Examples, the rule of scoring, and files written, for the end of the help.
const HELP: &str = include_str!("help/validate.txt").trim_ascii_end();

/// Scores detected cones against cones marked by hand
///
/// Takes a folder of hand marks, and either detections (--detections) or images, in which it
/// detects the cones itself. It computes sensitivity, false discovery rate, Dice coefficient,
/// localisation error and agreement of density for each image, and, from the scores of detections,
/// FROC (sensitivity against false alarms) and reliability.
#[derive(Args)]
#[command(after_help = HELP)]
pub struct Validate {
    /// Folder of hand marks NAME_coords.csv or NAME.csv, or one file of them
    #[arg(long, value_name = "PATH")]
    reference: PathBuf,
    /// Folder of detections NAME.csv or NAME_coords.csv, or one file of them
    ///
    /// They may come from this program or from another. [default: cones are detected in --images]
    #[arg(long, value_name = "PATH", required_unless_present = "images")]
    detections: Option<PathBuf>,
    /// Folder of images NAME.png or NAME.tif, or one image [default: beside the marks]
    ///
    /// Cones are detected in them unless --detections are given; overlays and the sizes of the
    /// images are taken from them.
    #[arg(long, value_name = "PATH")]
    images: Option<PathBuf>,
    /// Folder for the results; it is created if it does not exist
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Also write each image with its hits, misses and false alarms marked
    #[arg(long)]
    overlay: bool,
    /// Width and height of the images in px, such as 150x150 [default: read from the images]
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(usize, usize)>,
    /// Coordinate that --detections give to the centre of the top-left pixel: 0, 0.5 or 1
    #[arg(long, value_name = "O", default_value = "0", value_parser = origin)]
    detections_origin: Origin,
    /// Rule that pairs marks with detections where several are near
    ///
    /// nearest  every mark claims its nearest detection; if several marks
    ///          claim the same one, the closest gets it (Cunefare et al. 2017)
    /// optimal  as many pairs as possible and, among those, the pairs of
    ///          least total distance (Hungarian assignment)
    #[arg(long, verbatim_doc_comment, value_name = "A", default_value = "nearest", value_parser = PossibleValuesParser::new(Assignment::VARIANTS), help_heading = "Scoring")]
    assignment: String,
    /// Width of the border in which marks and detections do not count, in px (0 or more)
    ///
    /// The default is that of Cunefare et al. (2017).
    #[arg(long, value_name = "PX", default_value_t = 7., help_heading = "Scoring")]
    border: f64,
    /// Largest distance between a mark and its detection, in neighbour distances (above 0)
    ///
    /// The unit is the median nearest-neighbour distance of the marks of the image. The default is
    /// that of Cunefare et al. (2017). It is generous: unrelated marks of the same regularity reach
    /// a Dice of .8 to .9 by it, and below .45 with 0.4.
    #[arg(long, value_name = "F", default_value_t = 0.75, help_heading = "Scoring")]
    reach: f64,
    /// Rule that tells which images are of one subject
    ///
    /// prefix:N        the first N parts of the file name between underscores
    /// any other text  a regular expression: its first group in the file
    ///                 name, or all that it matches if it has no group
    ///
    /// [default: every image counts as independent]
    #[arg(
        long,
        verbatim_doc_comment,
        value_name = "RULE",
        group = "grouping",
        help_heading = "Groups and intervals"
    )]
    group_by: Option<Grouping>,
    /// CSV file that tells which images are of one subject, instead of a rule
    ///
    /// Columns: name,group. A name may be the beginning of several file names.
    #[arg(long, value_name = "FILE", group = "grouping", help_heading = "Groups and intervals")]
    group_table: Option<PathBuf>,
    /// Number of bootstrap resamples for the confidence intervals (2000–1000000)
    ///
    /// Intervals are 95 %, bias-corrected and accelerated (BCa). Groups are resampled if there are
    /// any, otherwise images.
    #[arg(long, value_name = "N", default_value_t = RESAMPLES as u32, value_parser = clap::value_parser!(u32).range(2000..=1_000_000), help_heading = "Groups and intervals")]
    resamples: u32,
    /// Second set of detections, or marks of another grader, to compare with
    ///
    /// A folder of files NAME.csv or NAME_coords.csv, or one such file.
    #[arg(long, value_name = "PATH", group = "second", help_heading = "Comparison with other detections")]
    versus: Option<PathBuf>,
    /// Coordinate that --versus gives to the centre of the top-left pixel: 0, 0.5 or 1
    #[arg(long, value_name = "O", default_value = "0", requires = "versus", value_parser = origin, help_heading = "Comparison with other detections")]
    versus_origin: Origin,
    /// Second detector to compare with, on the same images
    ///
    /// `--detector` explains the values.
    #[arg(long, value_name = "D", group = "second", value_parser = PossibleValuesParser::new(Detector::VARIANTS), help_heading = "Comparison with other detections")]
    versus_detector: Option<String>,
    #[command(flatten)]
    marks: CoordinateArgs,
    #[command(flatten, next_help_heading = "Detection (without --detections)")]
    detect: DetectArgs,
    #[command(flatten)]
    scale: ScaleArgs,
}

/// Parses the value of `--size`, width and height in px.
fn size(text: &str) -> Result<(usize, usize), String> {
    let parts: Option<Vec<usize>> = text.split('x').map(|p| p.parse().ok().filter(|v| *v > 0)).collect();
    match parts.as_deref() {
        Some(&[width, height]) => Ok((width, height)),
        _ => Err(format!("“{text}” is not a size: expected WxH in px, such as 150x150")),
    }
}

/// Parses the value of an option for the origin of coordinates.
fn origin(text: &str) -> Result<Origin, String> {
    text.parse().map_err(|_| "expected 0, 0.5 or 1".to_owned())
}

/// Number of images with the lowest Dice coefficients that the printed text lists.
const WORST: usize = 5;

impl Validate {
    /// Scores the detections, writes the results and prints the main ones.
    ///
    /// # Errors
    /// Fails if an option is wrong, there are no marks, or the results cannot be written.
    pub fn execute(self, common: &Common) -> Result<Done> {
        let options = self.options(common.seed)?;
        let outcome = validate_files(&self.reference, &options, &self.out, &*common.progress())?;
        common.say(&self.summary(&outcome));
        let total = outcome.rows.len() + outcome.failures.len() + outcome.ending.left;
        common.say(&ending_words(&outcome.ending, total));
        Ok(Done::of(&outcome.failures, &outcome.ending))
    }

    /// Returns the options of the validation after checking them.
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
                bail!(
                    "--detections-origin {} needs --detections: cones that are detected here count from 0",
                    self.detections_origin
                )
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

    /// Returns the text that is printed at the end.
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
                        format!("{:.4}", r.score.strict.dice),
                    ]
                })
                .collect();
            text.push_str(&table(&["lowest Dice", "misses", "false alarms", "Dice", "strict"], &worst));
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
                    "p: paired sign-flip permutation test; Dice between the two sets of detections: {:.4} (mean over images)\n",
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
