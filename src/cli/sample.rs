use super::Done;
use super::args::Common;
use super::args::{TargetArgs, fit_in_words, write_fit};
use anyhow::{Context, Result, bail};
use clap::Args;
use conemosaic::batch::Region;
use conemosaic::compare::{POOR_FIT, TargetFit, target_fit};
use conemosaic::geometry::{Point, Rectangle, Window};
use conemosaic::image;
use conemosaic::mosaic::io::{ReadOptions, format_plain_points, read_outline, write_plain_points};
use conemosaic::report::{counted, table};
use conemosaic::sample::{Density, Sampler, sampler, samplers};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Draws points from a sampler, in the unit square or another window
#[derive(Args)]
#[command(after_help = "\
Examples:
  conemosaic sample --list
  conemosaic sample dart-throwing -n 1024 --seed 7 --out points.csv
  conemosaic sample bnot -n 1024 --steps 20 --torus
  conemosaic sample deering -n 1500 --window 150x150 --set eccentricity=0.3
  conemosaic sample bnot -n 5000 --density picture.png --out stipples.csv
  conemosaic sample --target-pcf measured/retina.pcf.csv -n 1024 --out like_retina.csv

Writes x,y in [0, 1)² or the window, to the terminal without --out. With --target-pcf also NAME.fit.json
beside --out: how near the points come to the curve.")]
pub struct Sample {
    /// Name of the sampler
    #[arg(required_unless_present_any = ["list", "target_pcf", "target_spectrum"])]
    name: Option<String>,
    /// Number of points; a lattice makes the nearest number it can
    #[arg(short, long, value_name = "N", required_unless_present = "list")]
    n: Option<usize>,
    /// Where points are drawn: unit (square), WxH (an image of that size, whose pixels have centres at whole numbers: −0.5 to
    /// W − 0.5, as for `measure --window`) or X0,Y0,X1,Y1, or a FILE of corners: CSV of x,y, WebPlotDigitizer project or
    /// ImageJ ROI
    #[arg(long, value_name = "WINDOW", default_value = "unit", allow_hyphen_values = true)]
    window: Region,
    /// Opposite edges are the same place: lattices close on themselves (Poisson disks always do)
    #[arg(long)]
    torus: bool,
    /// Set a parameter of the sampler; may be repeated. `--list` says which there are, their units and ranges
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    set: Vec<(String, String)>,
    /// Steps of a relaxation: short for --set steps=K
    #[arg(long, value_name = "K")]
    steps: Option<usize>,
    /// Points as dense as this PNG or TIFF is bright, stretched over the window [default: even density]
    ///
    /// Its grey values, 0 to 1, are densities relative to each other; below 1/1000 of the greatest they count as that.
    #[arg(long, value_name = "FILE")]
    density: Option<PathBuf>,
    /// File for the points
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// List the samplers
    #[arg(long, conflicts_with_all = ["name", "n", "out", "target_pcf", "target_spectrum"])]
    list: bool,
    #[command(flatten)]
    target: TargetArgs,
}

impl Sample {
    pub fn execute(self, common: &Common) -> Result<Done> {
        let (false, Some(n)) = (self.list, self.n) else {
            // asked for: printed even if quiet
            let _ = writeln!(std::io::stdout(), "{}", list());
            return Ok(Done::Completely);
        };
        let window = self.window()?;
        let target = self.target.target()?;
        let default: &dyn Sampler = match (&target, &self.name) {
            (Some(target), _) => &target.shaped,
            (None, name) => sampler(name.as_deref().unwrap_or_default())?,
        };
        let changed = self.changed(default)?;
        let chosen = changed.as_deref().unwrap_or(default);
        let bar = common.steps();
        let mut rng = ChaCha8Rng::seed_from_u64(common.seed);
        let points = chosen.sample_watched(n, &window, &mut rng, &mut |step, of| bar.at(step, of))?;
        bar.end();
        let rows = target.as_ref().and_then(|t| t.pcf.as_deref());
        let fit = rows.and_then(|rows| target_fit(&points, &window, rows).ok());
        self.write(&points, fit.as_ref(), common)?;
        if let Some(fit) = fit.filter(|fit| !common.quiet || fit.l_infinity > POOR_FIT) {
            // the points themselves may be going to the terminal
            let _ = writeln!(std::io::stderr(), "{}", fit_in_words(&fit));
        }
        Ok(Done::Completely)
    }

    fn write(&self, points: &[Point], fit: Option<&TargetFit>, common: &Common) -> Result<()> {
        if let Some(path) = &self.out {
            write_plain_points(path, points)?;
            common.say(&format!("{}: {}", counted(points.len(), "point"), path.display()));
            if let Some(fit) = fit {
                common.say(&format!("fit: {}", write_fit(path, points.len(), fit)?.display()));
            }
        } else {
            match std::io::stdout().write_all(format_plain_points(points).as_bytes()) {
                Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
                    return Err(error).context("cannot print the points");
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn window(&self) -> Result<Window> {
        let bounds = match &self.window {
            Region::Unit => Rectangle::new(0., 0., 1., 1.)?,
            Region::Size(w, h) => Rectangle::new(-0.5, -0.5, w - 0.5, h - 0.5)?,
            Region::Edges([x0, y0, x1, y1]) => Rectangle::new(*x0, *y0, *x1, *y1)?,
            Region::File(path) if self.torus => {
                bail!("the polygon of {} has no opposite edges: --torus goes with rectangles", path.display())
            }
            Region::File(path) => return Ok(read_outline(path, &ReadOptions::default())?.window),
            Region::Auto | Region::Image => {
                bail!("there is no image here: --window needs unit, WxH, X0,Y0,X1,Y1 or a file of corners")
            }
        };
        Ok(if self.torus { Window::Torus(bounds) } else { Window::Rectangle(bounds) })
    }

    /// The sampler with what is set and the density, if anything is.
    fn changed(&self, default: &dyn Sampler) -> Result<Option<Box<dyn Sampler>>> {
        let steps = self.steps.map(|steps| steps.to_string());
        let set = self.set.iter().map(|(name, value)| (name.as_str(), value.as_str()));
        let settings: Vec<(&str, &str)> = set.chain(steps.as_deref().map(|steps| ("steps", steps))).collect();
        let configured = if settings.is_empty() { None } else { Some(default.configure(&settings)?) };
        let Some(path) = &self.density else { return Ok(configured) };
        let density = density(path)?;
        let dense = configured.as_deref().unwrap_or(default).with_density(&density);
        if dense.is_none() {
            let able = samplers().iter().filter(|s| s.with_density(&density).is_some()).map(|s| s.name());
            let able = able.collect::<Vec<_>>().join(", ");
            bail!("{} makes points of even density: --density goes with {able}", default.name());
        }
        Ok(dense)
    }
}

fn density(path: &Path) -> Result<Density> {
    let plane = image::read(path)?;
    let (rows, columns) = plane.dim();
    let values: Vec<f64> = plane.iter().map(|&v| f64::from(v)).collect();
    Density::new(columns, rows, &values).with_context(|| path.display().to_string())
}

fn setting(text: &str) -> Result<(String, String), String> {
    let parts = text.split_once('=').filter(|(name, value)| !name.is_empty() && !value.is_empty());
    let (name, value) = parts.ok_or("expected NAME=VALUE, such as steps=20")?;
    Ok((name.to_owned(), value.to_owned()))
}

/// Every sampler, then every parameter.
fn list() -> String {
    let marked = |s: &dyn Sampler| format!("{}{}", s.name(), if s.by_default() { " *" } else { "" });
    let rows: Vec<Vec<String>> = samplers().iter().map(|s| vec![marked(*s), s.about().to_owned()]).collect();
    let made = table(&["sampler", "what it makes"], &rows);
    let made = format!("{made}\n* run and compare take these unless --samplers names others");
    let parameters = samplers().iter().flat_map(|s| s.parameters().into_iter().map(move |p| (s.name(), p)));
    let rows: Vec<Vec<String>> = parameters
        .map(|(sampler, p)| {
            let range = format!("{} {}", p.range_in_words(), p.unit).trim_end().to_owned();
            vec![sampler.to_owned(), p.name.to_owned(), range, p.default_in_words(), p.meaning.to_owned()]
        })
        .collect();
    if rows.is_empty() {
        return made;
    }
    let set = table(&["sampler", "parameter", "values", "default", "what it does"], &rows);
    format!("{made}\n\nTo be set by --set PARAMETER=VALUE:\n{set}")
}
