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
            let rows: Vec<Vec<String>> =
                samplers().iter().map(|s| vec![s.name().to_owned(), s.about().to_owned()]).collect();
            // asked for: printed even if quiet
            let _ = writeln!(std::io::stdout(), "{}", table(&["sampler", "what it makes"], &rows));
            return Ok(Done::Completely);
        };
        let window = if self.torus { Window::unit_torus() } else { Window::unit_square() };
        let points = sampler(name)?.sample(n, &window, &mut ChaCha8Rng::seed_from_u64(common.seed))?;
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
}
