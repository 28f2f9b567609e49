use super::Done;
use super::args::Common;
use anyhow::Result;
use clap::Args;
use conemosaic::batch::remake_paper;
use conemosaic::report::{PaperResults, table};
use std::path::PathBuf;

/// Re-makes what Lanaro et al. print about samplers, and says what agrees, what does not, and why
#[derive(Args)]
#[command(after_help = "\
Example:
  conemosaic paper --out paper

Needs no input. Writes to paper/:
  index.html           everything on one page, in plain words
  paper.md             the same as Markdown
  figure1.svg          Figure 1: six samplers, their spectra and pair correlation functions
  table1.csv           Table 1's sampler rows, printed and re-made: mean, standard deviation, regularity index
  table2_samplers.csv  distances between the samplers of Table 2, and those that its printed rows allow
  bandwidths.csv       those distances at other bandwidths of the kernel
  triangle.csv         the triangle inequalities of all printed rows with them
  finding.csv          regularity against distance, on the printed numbers
  pcf.csv, spectra.csv the curves of Figure 1")]
pub struct Paper {
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Patterns of each sampler and number of points (2–1000)
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u16).range(2..=1000))]
    patterns: u16,
}

impl Paper {
    pub fn execute(self, common: &Common) -> Result<Done> {
        let results = remake_paper(usize::from(self.patterns), common.seed, &self.out, &*common.progress())?;
        common.say(&rows(&results));
        let document = results.document(String::new(), String::new());
        for headline in &document.headlines {
            common.say(&format!("{} {}", headline.number, headline.words));
        }
        common.say(&format!("Page: {}", self.out.join("index.html").display()));
        Ok(Done::Completely)
    }
}

fn rows(results: &PaperResults) -> String {
    let rows: Vec<Vec<String>> = results
        .rows
        .iter()
        .map(|r| {
            let number = |v: Option<f64>| v.map_or("–".into(), |v| format!("{v:.3}"));
            let verdict = if r.agrees() { "agrees" } else { "differs" };
            vec![
                r.printed.name.clone(),
                format!("{:.3}", r.printed.ri),
                number(r.ri.mean),
                number(r.ri.sd),
                verdict.to_owned(),
            ]
        })
        .collect();
    table(&["Table 1", "RI, printed", "RI, ours", "SD", "within 2 SD"], &rows)
}
