use super::Done;
use super::args::Common;
use anyhow::Result;
use clap::Args;
use conemosaic::batch::remake_paper;
use conemosaic::report::{PaperResults, table};
use std::path::PathBuf;

/// Example and files written, for the end of the help.
const HELP: &str = include_str!("help/paper.txt").trim_ascii_end();

/// Repeats the computations of Lanaro et al. (2020) on samplers
///
/// Computes anew what the paper prints about point samplers, and reports what agrees, what differs,
/// and why. It needs no files.
#[derive(Args)]
#[command(after_help = HELP)]
pub struct Paper {
    /// Folder for the results; it is created if it does not exist
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Number of patterns drawn from each sampler, for each number of points (2–1000)
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u16).range(2..=1000))]
    patterns: u16,
}

impl Paper {
    /// Computes the results, writes them and prints the main ones.
    ///
    /// # Errors
    /// Fails if a sampler fails or the results cannot be written.
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

/// Returns the table of regularity indices that is printed.
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
    table(&["Table 1", "RI, printed", "RI, recomputed", "SD", "within 2 SD"], &rows)
}
