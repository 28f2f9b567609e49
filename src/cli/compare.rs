use super::Done;
use super::common::Common;
use super::measure::{MosaicArgs, marked, say_failures, warned};
use super::short_table;
use anyhow::Result;
use clap::Args;
use conemosaic::batch::{CoordinatesOutcome, compare_files, coordinate_files};
use conemosaic::report::significant;
use conemosaic::sample::{Sampler, as_reference, sampler, samplers, samplers_by_default};
use std::path::PathBuf;

/// Compares mosaics with point samplers: l-infinity distance of pair correlation functions
#[derive(Args)]
#[command(after_help = "\
Example:
  conemosaic compare marks --window 150x150 --samplers jittered,dart-throwing --out compared

Each mosaic is compared with the mean function of samples of its own size in its own window: the greatest difference of g(r), without unit.

Writes to compared/:
  l_infinity.csv   one row a file, one column a sampler
  failures.csv     files that failed, if any; then the exit code is 2")]
pub struct Compare {
    /// Coordinate files and folders of them
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Samplers to compare with, separated by commas; all is every one, slow ones included [default: those marked * by
    /// `conemosaic sample --list`]
    #[arg(long, value_name = "A,B,…", value_delimiter = ',')]
    samplers: Vec<String>,
    #[command(flatten)]
    mosaic: MosaicArgs,
}

/// The samplers of these names, as references; those compared with by default if there are none; “all” is every one. A name
/// given twice counts once.
pub fn samplers_named(names: &[String]) -> Result<Vec<&'static dyn Sampler>> {
    if names.is_empty() {
        return Ok(samplers_by_default());
    }
    let mut found: Vec<&'static dyn Sampler> = Vec::new();
    for name in names {
        let chosen = match name.trim() {
            "all" => samplers().to_vec(),
            name => vec![sampler(name)?],
        };
        for one in chosen.into_iter().map(as_reference) {
            if !found.iter().any(|s| s.name() == one.name()) {
                found.push(one);
            }
        }
    }
    Ok(found)
}

impl Compare {
    pub fn execute(self, common: &Common) -> Result<Done> {
        let options = self.mosaic.options()?;
        let samplers = samplers_named(&self.samplers)?;
        let inputs = coordinate_files(&self.files, Some(&self.out))?;
        let outcome =
            compare_files(&inputs, &options, &samplers, common.seed, &self.out, &*common.progress())?;
        if !outcome.records.is_empty() {
            common.say(&summary(&outcome, &samplers));
        }
        common.say(&format!("Table: {}/l_infinity.csv", self.out.display()));
        say_failures(common, &outcome, &self.out);
        Ok(Done::with(&outcome.failures))
    }
}

fn summary(outcome: &CoordinatesOutcome, samplers: &[&'static dyn Sampler]) -> String {
    let headers: Vec<&str> =
        ["file", "points"].into_iter().chain(samplers.iter().map(|s| s.name())).chain(["closest"]).collect();
    let rows: Vec<Vec<String>> = outcome
        .records
        .iter()
        .map(|r| {
            let distance = |s: &&'static dyn Sampler| {
                let found = r.mosaic.l_infinity.iter().find(|d| d.sampler == s.name());
                found.map_or("–".into(), |d| significant(d.l_infinity, 3))
            };
            [marked(r), r.mosaic.n.to_string()]
                .into_iter()
                .chain(samplers.iter().map(distance))
                .chain([r.mosaic.closest_sampler().unwrap_or("–").to_owned()])
                .collect()
        })
        .collect();
    short_table(&headers, &rows, "l_infinity.csv", warned(outcome))
}
