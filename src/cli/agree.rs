use super::args::Common;
use super::{Done, short_table};
use anyhow::Result;
use clap::Args;
use conemosaic::batch::{AgreementOptions, AgreementOutcome, Grouping, agree_files};
use conemosaic::mosaic::io::GroupTable;
use conemosaic::report::{Cell, FigureFormat, counted};
use std::path::PathBuf;

/// Holds graders, sessions or programs against each other: paired differences, limits of agreement, intraclass correlation
#[derive(Args)]
#[command(after_help = "\
Examples:
  conemosaic measure grader1 --window 150x150 --out one
  conemosaic measure grader2 --window 150x150 --out two
  conemosaic agree one two --metrics density,nn_mean --out agreed
  conemosaic agree one two --group-by prefix:2 --out agreed

Images are paired by file name, without folder and extension (nor _coords).

Writes to agreed/:
  agreement.csv    one row per column and pair of graders: means, mean difference (first − second) with its 95 % interval, SD,
                   95 % limits of agreement with intervals (Bland & Altman 1999); ICC(2,1), absolute agreement, and ICC(3,1),
                   consistency, with intervals (McGraw & Wong 1996); SD within an image, repeatability (1.96 √2 times
                   it), coefficient of variation. With more than two graders also a row over all of them
                   Intervals take images as independent, unless --group-by or --group-table says which are of one subject:
                   then limits are those for repeated measurements (Bland & Altman 2007), with intervals by Zou (2013)
  differences.csv  one row per image, column and pair
  unpaired.csv     images that a grader lacks
  agreement.svg    (.pdf, .png: --figures) Bland–Altman plots of density and nearest-neighbour distance, or of the first two columns")]
pub struct Agree {
    /// Tables of each: summary.csv, a folder that holds one, or any CSV with a column name or file
    #[arg(required = true, num_args = 2..)]
    tables: Vec<PathBuf>,
    /// Columns to compare, separated by commas [default: all that hold numbers in every table]
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', visible_alias = "metrics")]
    columns: Vec<String>,
    /// Images of one subject belong together: prefix:N (the first N parts of the name between underscores) or a regular
    /// expression whose first group is the subject
    #[arg(long, value_name = "RULE", group = "grouping")]
    group_by: Option<Grouping>,
    /// The same by a CSV of name,group; a name may be the beginning of many
    #[arg(long, value_name = "FILE", group = "grouping")]
    group_table: Option<PathBuf>,
    /// Formats of the figure, separated by commas: svg (always), pdf, png (300 dpi)
    #[arg(long, value_name = "F,…", value_delimiter = ',', default_value = "svg")]
    figures: Vec<FigureFormat>,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

impl Agree {
    pub fn execute(self, common: &Common) -> Result<Done> {
        let columns: Vec<String> = self.columns.iter().map(|c| c.trim().to_owned()).collect();
        let grouping = match &self.group_table {
            Some(path) => Some(Grouping::Table(GroupTable::read(path)?)),
            None => self.group_by,
        };
        let options = AgreementOptions { columns, grouping, figures: self.figures };
        let outcome = agree_files(&self.tables, &options, &self.out)?;
        common.say(&words(&outcome));
        common.say(&outcome.method());
        if !outcome.unpaired.is_empty() {
            let lacking = counted(outcome.unpaired.len(), "image");
            common.say(&format!("{lacking} without a partner: {}", self.out.join("unpaired.csv").display()));
        }
        common.say(&format!("Tables: {}", self.out.join("*.csv").display()));
        common.say(&format!("Figure: {}", self.out.join("agreement.svg").display()));
        Ok(Done::Completely)
    }
}

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
