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

/// Examples and output, for the end of the help.
const HELP: &str = include_str!("help/sample.txt").trim_ascii_end();

/// Draws a random point pattern from a sampler
///
/// Needs the name of a sampler (`conemosaic sample --list` shows them) and the number of points.
/// The points fill the unit square, x and y from 0 up to but not including 1, or another --window.
#[derive(Args)]
#[command(after_help = HELP)]
pub struct Sample {
    /// Name of the sampler; `conemosaic sample --list` shows all
    #[arg(required_unless_present_any = ["list", "target_pcf", "target_spectrum"])]
    name: Option<String>,
    /// Number of points
    ///
    /// Lattices give the nearest number that fits the window, and a few other samplers about this
    /// number; --list says which.
    #[arg(short, long, value_name = "N", required_unless_present = "list")]
    n: Option<usize>,
    /// Area in which points are drawn
    ///
    /// unit         the unit square
    /// WxH          an image of W × H px; pixel centres are whole numbers, so
    ///              it reaches from −0.5 to W − 0.5 and from −0.5 to H − 0.5,
    ///              as in `conemosaic measure --window`
    /// X0,Y0,X1,Y1  left, upper, right and lower edge
    /// FILE         a file of the corners of one or more polygons: CSV with
    ///              columns x,y, a WebPlotDigitizer project or CSV file,
    ///              or an ImageJ ROI
    #[arg(
        long,
        verbatim_doc_comment,
        value_name = "WINDOW",
        default_value = "unit",
        allow_hyphen_values = true
    )]
    window: Region,
    /// Treat opposite edges of the window as connected (periodic boundaries); rectangles only
    ///
    /// Lattices are then stretched so that they continue across the edges. Poisson disks are always
    /// drawn with periodic boundaries.
    #[arg(long)]
    torus: bool,
    /// Parameter of the sampler and its value; may be given several times
    ///
    /// `conemosaic sample --list` shows the parameters with units, ranges and defaults.
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    set: Vec<(String, String)>,
    /// Number of relaxation steps, the same as --set steps=K
    #[arg(long, value_name = "K")]
    steps: Option<usize>,
    /// PNG or TIFF image, stretched over the window, whose brightness is the density of the points
    ///
    /// Only the ratios of its grey values matter. Values below 1/1000 of the largest count as
    /// 1/1000 of it. Some samplers only draw points of even density. [default: even density]
    #[arg(long, value_name = "FILE")]
    density: Option<PathBuf>,
    /// CSV file for the points [default: they are printed to the terminal]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// List the samplers and their parameters
    #[arg(long, conflicts_with_all = ["name", "n", "out", "target_pcf", "target_spectrum"])]
    list: bool,
    #[command(flatten)]
    target: TargetArgs,
}

impl Sample {
    /// Draws the points and writes them, or lists the samplers.
    ///
    /// # Errors
    /// Fails if an option is wrong, the points cannot be drawn, or the file cannot be written.
    pub fn execute(self, common: &Common) -> Result<Done> {
        let (false, Some(n)) = (self.list, self.n) else {
            // the list is what was asked for, so --quiet does not hide it
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
            // on standard error, as the points themselves may go to standard output
            let _ = writeln!(std::io::stderr(), "{}", fit_in_words(&fit));
        }
        Ok(Done::Completely)
    }

    /// Writes points and fit to their files, or the points to standard output.
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

    /// Returns the window in which points are drawn.
    fn window(&self) -> Result<Window> {
        let bounds = match &self.window {
            Region::Unit => Rectangle::new(0., 0., 1., 1.)?,
            Region::Size(w, h) => Rectangle::new(-0.5, -0.5, w - 0.5, h - 0.5)?,
            Region::Edges([x0, y0, x1, y1]) => Rectangle::new(*x0, *y0, *x1, *y1)?,
            Region::File(path) if self.torus => {
                bail!("the polygon of {} has no opposite edges: --torus needs a rectangle", path.display())
            }
            Region::File(path) => return Ok(read_outline(path, &ReadOptions::default())?.window),
            Region::Auto | Region::Image => {
                bail!(
                    "`sample` reads no images for --window: give unit, WxH, X0,Y0,X1,Y1 or a file of corners"
                )
            }
        };
        Ok(if self.torus { Window::Torus(bounds) } else { Window::Rectangle(bounds) })
    }

    /// Returns the sampler with the parameters and the density set by options.
    ///
    /// `None` if no such option is set, so that the sampler `default` can be used as it is.
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
            bail!("{} draws points of even density only; --density works with {able}", default.name());
        }
        Ok(dense)
    }
}

/// Reads the density from an image.
fn density(path: &Path) -> Result<Density> {
    let plane = image::read(path)?;
    let (rows, columns) = plane.dim();
    let values: Vec<f64> = plane.iter().map(|&v| f64::from(v)).collect();
    Density::new(columns, rows, &values).with_context(|| path.display().to_string())
}

/// Parses the value of `--set`.
fn setting(text: &str) -> Result<(String, String), String> {
    let parts = text.split_once('=').filter(|(name, value)| !name.is_empty() && !value.is_empty());
    let (name, value) = parts.ok_or("expected NAME=VALUE, such as steps=20")?;
    Ok((name.to_owned(), value.to_owned()))
}

/// Returns a table of every sampler and a table of every parameter.
fn list() -> String {
    let marked = |s: &dyn Sampler| format!("{}{}", s.name(), if s.by_default() { " *" } else { "" });
    let rows: Vec<Vec<String>> = samplers().iter().map(|s| vec![marked(*s), s.about().to_owned()]).collect();
    let made = table(&["sampler", "points that it draws"], &rows);
    let made = format!("{made}\n* samplers that run and compare use unless --samplers names others");
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
    format!("{made}\n\nParameters, set with --set PARAMETER=VALUE:\n{set}")
}
