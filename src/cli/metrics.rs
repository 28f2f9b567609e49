use super::Done;
use super::args::Common;
use anyhow::Result;
use clap::Args;
use conemosaic::report::{dictionary, dictionary_csv, dictionary_text};

/// What every column of every table means: definition, unit, edge rule, source
#[derive(Args)]
#[command(after_help = "\
Examples:
  conemosaic metrics                 read them
  conemosaic metrics --csv           the same for a program
  conemosaic measure marks --out measured --metrics nearest,voronoi")]
pub struct Metrics {
    /// List them (the default)
    #[arg(long)]
    list: bool,
    /// As CSV, one row per column
    #[arg(long, conflicts_with_all = ["list", "markdown"])]
    csv: bool,
    /// As a page in Markdown
    #[arg(long, conflicts_with = "list")]
    markdown: bool,
}

impl Metrics {
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
