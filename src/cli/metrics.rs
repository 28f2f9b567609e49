use super::Done;
use super::args::Common;
use anyhow::Result;
use clap::Args;
use conemosaic::report::{dictionary, dictionary_csv, dictionary_text};

/// Examples for the end of the help.
const HELP: &str = include_str!("help/metrics.txt").trim_ascii_end();

/// Explains every column of every table that the program writes
///
/// Prints, for each column, its definition, unit, treatment of the border and source, in the groups
/// that --metrics accepts. It needs no files.
#[derive(Args)]
#[command(after_help = HELP)]
pub struct Metrics {
    /// Print the columns as text; this is the default
    #[arg(long)]
    list: bool,
    /// Print the columns as CSV, one row per column
    #[arg(long, conflicts_with_all = ["list", "markdown"])]
    csv: bool,
    /// Print the columns as a page in Markdown
    #[arg(long, conflicts_with = "list")]
    markdown: bool,
}

impl Metrics {
    /// Prints the columns in the format asked for.
    ///
    /// # Errors
    /// Fails if the CSV cannot be made.
    pub fn execute(self, common: &Common) -> Result<Done> {
        let text = if self.csv {
            String::from_utf8_lossy(&dictionary_csv()?).into_owned()
        } else if self.markdown {
            dictionary()
        } else {
            dictionary_text()
        };
        common.say(text.trim_end());
        Ok(Done::Completely)
    }
}
