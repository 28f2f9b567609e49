use super::args::Common;
use super::{Done, remedies, short_table};
use anyhow::Result;
use clap::Args;
use conemosaic::batch::{AgreementOptions, AgreementOutcome, Grouping, agree_files};
use conemosaic::mosaic::io::GroupTable;
use conemosaic::report::{Cell, FigureFormat, counted};
use std::path::PathBuf;

/// Examples and files written, for the end of the help.
const HELP: &str = include_str!("help/agree.txt").trim_ascii_end();

/// Measures how well graders, sessions or programs agree
///
/// Takes two or more tables, one per grader, session or program, each with one row per image.
/// Images are paired by file name without folder, extension and the ending _coords. For every
/// column of numbers the command computes paired differences, limits of agreement and intraclass
/// correlations.
#[derive(Args)]
#[command(after_help = HELP)]
pub struct Agree {
    /// Tables to compare, one per grader
    ///
    /// Each is a summary.csv of this program, a folder that holds one, or any CSV file with a
    /// column name or file.
    #[arg(required = true, num_args = 2..)]
    tables: Vec<PathBuf>,
    /// Columns to compare, separated by commas [default: all that contain numbers in every table]
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', visible_alias = "metrics")]
    columns: Vec<String>,
    /// Rule that tells which images are of one subject
    ///
    /// prefix:N        the first N parts of the file name between underscores
    /// any other text  a regular expression: its first group in the file
    ///                 name, or all that it matches if it has no group
    ///
    /// [default: every image counts as independent]
    #[arg(long, verbatim_doc_comment, value_name = "RULE", group = "grouping")]
    group_by: Option<Grouping>,
    /// CSV file that tells which images are of one subject, instead of a rule
    ///
    /// Columns: name,group. A name may be the beginning of several file names.
    #[arg(long, value_name = "FILE", group = "grouping")]
    group_table: Option<PathBuf>,
    /// Formats of the figure, separated by commas: svg, pdf, png (300 dpi)
    ///
    /// The SVG file is always written.
    #[arg(long, value_name = "F,…", value_delimiter = ',', default_value = "svg")]
    figures: Vec<FigureFormat>,
    /// Folder for the results; it is created if it does not exist
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

impl Agree {
    /// Compares the tables, writes the results and prints them.
    ///
    /// # Errors
    /// Fails if a table cannot be read, nothing can be paired, or the results cannot be written.
    pub fn execute(self, common: &Common) -> Result<Done> {
        let columns: Vec<String> = self.columns.iter().map(|c| c.trim().to_owned()).collect();
        let grouping = match &self.group_table {
            Some(path) => Some(Grouping::Table(GroupTable::read(path)?)),
            None => self.group_by,
        };
        let options = AgreementOptions { columns, grouping, figures: self.figures };
        let outcome = agree_files(&self.tables, &options, &self.out)?;
        common.say(&words(&outcome));
        common.say(&remedies::with_options(&outcome.method()));
        if !outcome.unpaired.is_empty() {
            let lacking = counted(outcome.unpaired.len(), "image");
            common.say(&format!("{lacking} without a partner: {}", self.out.join("unpaired.csv").display()));
        }
        common.say(&format!("Tables: {}", self.out.join("*.csv").display()));
        common.say(&format!("Figure: {}", self.out.join("agreement.svg").display()));
        Ok(Done::Completely)
    }
}

/// Returns the printed table, with one row per column and pair of graders.
fn words(outcome: &AgreementOutcome) -> String {
    let headers = [
        "column",
        "first",
        "second",
        "images",
        "difference",
        "lower limit",
        "upper limit",
        "ICC(2,1)",
        "ICC(3,1)",
    ];
    let number = |value: Option<f64>| Cell::from(value).readable();
    let rows: Vec<Vec<String>> = outcome
        .columns
        .iter()
        .map(|c| {
            let found = &c.agreement.agreement;
            vec![
                c.column.clone(),
                c.graders[0].clone(),
                c.graders[1].clone(),
                found.n.to_string(),
                number(Some(found.bias)),
                number(found.limits.map(|l| l[0])),
                number(found.limits.map(|l| l[1])),
                number(c.intraclass.and_then(|i| i.agreement)),
                number(c.intraclass.and_then(|i| i.consistency)),
            ]
        })
        .collect();
    short_table(&headers, &rows, "agreement.csv")
}
