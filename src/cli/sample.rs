use super::Done;
use super::common::Common;
use anyhow::{Context, Result};
use clap::Args;
use conemosaic::geometry::Window;
use conemosaic::mosaic::io::{format_plain_points, write_plain_points};
use conemosaic::report::{counted, table};
use conemosaic::sample::{sampler, samplers};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::io::Write;
use std::path::PathBuf;

/// Draws points in the unit square from a sampler
#[derive(Args)]
#[command(after_help = "\
Examples:
  conemosaic sample --list
  conemosaic sample dart-throwing -n 1024 --seed 7 --out points.csv

Writes x,y in [0, 1)², to the terminal without --out.")]
pub struct Sample {
    /// Name of the sampler
    #[arg(required_unless_present = "list")]
    name: Option<String>,
    /// Number of points; a lattice makes the nearest number it can
    #[arg(short, long, value_name = "N", required_unless_present = "list")]
    n: Option<usize>,
    /// Opposite edges are the same place: lattices close on themselves (Poisson disks always do)
    #[arg(long)]
    torus: bool,
    /// Set a parameter of the sampler; may be repeated. `--list` says which there are, their units and ranges
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    set: Vec<(String, String)>,
    /// Steps of a relaxation: short for --set steps=K
    #[arg(long, value_name = "K")]
    steps: Option<usize>,
    /// File for the points
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// List the samplers
    #[arg(long, conflicts_with_all = ["name", "n", "out"])]
    list: bool,
}

impl Sample {
    pub fn execute(self, common: &Common) -> Result<Done> {
        let (Some(name), Some(n)) = (&self.name, self.n) else {
            // asked for: printed even if quiet
            let _ = writeln!(std::io::stdout(), "{}", list());
            return Ok(Done::Completely);
        };
        let window = if self.torus { Window::unit_torus() } else { Window::unit_square() };
        let settings = self.settings();
        let settings: Vec<(&str, &str)> = settings.iter().map(|(k, v)| (*k, v.as_str())).collect();
        let default = sampler(name)?;
        let configured = if settings.is_empty() { None } else { Some(default.configure(&settings)?) };
        let chosen = configured.as_deref().unwrap_or(default);
        let points = chosen.sample(n, &window, &mut ChaCha8Rng::seed_from_u64(common.seed))?;
        if let Some(path) = &self.out {
            write_plain_points(path, &points)?;
            common.say(&format!("{}: {}", counted(points.len(), "point"), path.display()));
        } else {
            match std::io::stdout().write_all(format_plain_points(&points).as_bytes()) {
                Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
                    return Err(error).context("cannot print the points");
                }
                _ => {}
            }
        }
        Ok(Done::Completely)
    }

    /// What is to be set: `--steps` is a setting like others.
    fn settings(&self) -> Vec<(&str, String)> {
        let set = self.set.iter().map(|(name, value)| (name.as_str(), value.clone()));
        set.chain(self.steps.map(|steps| ("steps", steps.to_string()))).collect()
    }
}

fn setting(text: &str) -> Result<(String, String), String> {
    let parts = text.split_once('=').filter(|(name, value)| !name.is_empty() && !value.is_empty());
    let (name, value) = parts.ok_or("expected NAME=VALUE, such as steps=20")?;
    Ok((name.to_owned(), value.to_owned()))
}

/// Every sampler, then every parameter.
fn list() -> String {
    let rows: Vec<Vec<String>> =
        samplers().iter().map(|s| vec![s.name().to_owned(), s.about().to_owned()]).collect();
    let made = table(&["sampler", "what it makes"], &rows);
    let parameters = samplers().iter().flat_map(|s| s.parameters().iter().map(move |p| (s.name(), p)));
    let rows: Vec<Vec<String>> = parameters
        .map(|(sampler, p)| {
            let range = format!("{} {}", p.range_in_words(), p.unit).trim_end().to_owned();
            vec![sampler.to_owned(), p.name.to_owned(), range, p.default.to_owned(), p.meaning.to_owned()]
        })
        .collect();
    if rows.is_empty() {
        return made;
    }
    let set = table(&["sampler", "parameter", "values", "default", "what it does"], &rows);
    format!("{made}\n\nTo be set by --set PARAMETER=VALUE:\n{set}")
}
