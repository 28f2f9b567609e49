use anyhow::{Context, Result, bail};
use clap::Args;
use conemosaic::compare::{POOR_FIT, TargetFit};
use conemosaic::files::write_atomically;
use conemosaic::report::significant;
use conemosaic::sample::{Shaped, TargetCurve};
use serde_json::json;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Options for points that should have the pair correlation function or spectrum in a file.
#[derive(Args)]
#[command(next_help_heading = "Points with a given pair correlation function or spectrum (instead of NAME)")]
pub struct TargetArgs {
    /// CSV file of a pair correlation function that the points should have
    ///
    /// Columns: r, in hexagonal spacings and up to 1 at least, and g, as in NAME.pcf.csv of
    /// `measure`. Exactly n points are drawn and moved until their g(r) fits this one. Beyond the
    /// last r, or beyond 6 spacings, g is left to chance. The largest remaining difference is
    /// printed and, with --out, written to NAME.fit.json beside the points.
    #[arg(long, value_name = "FILE", conflicts_with = "name")]
    target_pcf: Option<PathBuf>,
    /// CSV file of a radially averaged power spectrum that the points should have
    ///
    /// Columns: frequency, in units of √n, and power (1 for independent points), as in
    /// NAME.spectrum.csv of `measure --spectrum`. Beyond the last frequency the power is taken to
    /// be 1, so the table should go on until it has settled there. Smooth the spectrum or average
    /// several: the noise of a single pattern's spectrum becomes noise in g.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["name", "target_pcf"])]
    target_spectrum: Option<PathBuf>,
}

/// Target curve as read from its file.
pub struct Target {
    /// Sampler that draws points with this curve.
    pub shaped: Shaped,
    /// Rows `[r, g]` of the target, with r in hexagonal spacings; `None` if the target is a
    /// spectrum.
    pub pcf: Option<Vec<[f64; 2]>>,
}

impl TargetArgs {
    /// Reads the target curve from its file, or returns `None` if no option names a file.
    ///
    /// # Errors
    /// Fails if the file cannot be read or no point pattern has this curve.
    pub fn target(&self) -> Result<Option<Target>> {
        let (curve, pcf) = match (&self.target_pcf, &self.target_spectrum) {
            (Some(path), _) => {
                let (curve, rows) = read(path, "r and g", TargetCurve::from_pcf)?;
                (curve, Some(rows))
            }
            (None, Some(path)) => (read(path, "frequency and power", TargetCurve::from_spectrum)?.0, None),
            (None, None) => return Ok(None),
        };
        Ok(Some(Target { shaped: Shaped { curve, nearest: None }, pcf }))
    }
}

/// Returns a sentence on how well points fit their target.
///
/// The sentence is a warning, with a possible cause and its remedy, if the fit is poor.
pub fn fit_in_words(fit: &TargetFit) -> String {
    let miss = significant(fit.l_infinity, 2);
    let words =
        format!("g(r) differs from the target by at most {miss} (l∞), at r = {:.2} spacings", fit.worst_r);
    if fit.l_infinity <= POOR_FIT {
        return words;
    }
    let why = match fit.at_the_end() {
        true => {
            "g beyond the last r of the target is left to chance and disturbs the rows just before it; add rows up to 6 spacings, with g = 1 where it has settled"
        }
        false => {
            "possibly no point pattern has this g, because it is noisy or comes from points of varying density; smooth it, or measure it in a region of even density"
        }
    };
    format!("warning: {words}, more than {POOR_FIT}: {why}")
}

/// Writes the fit beside the file of the points, as NAME.fit.json, and returns its path.
///
/// # Errors
/// Fails if the file cannot be written.
pub fn write_fit(points: &Path, n: usize, fit: &TargetFit) -> Result<PathBuf> {
    let path = points.with_extension("fit.json");
    let told = json!({
        "points": n,
        "l_infinity": fit.l_infinity,
        "worst_r": fit.worst_r,
        "r": fit.r,
        "g_wanted": fit.wanted,
        "g_reached": fit.reached,
    });
    write_atomically(&path, |file| writeln!(file, "{told:#}"))
        .with_context(|| format!("cannot write {}", path.display()))?;
    Ok(path)
}

/// Reads a target curve and returns it with its rows.
///
/// `what` names the two columns in errors.
fn read<E: std::error::Error + Send + Sync + 'static>(
    path: &Path,
    what: &str,
    curve: impl Fn(&[[f64; 2]]) -> Result<TargetCurve, E>,
) -> Result<(TargetCurve, Vec<[f64; 2]>)> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let rows = rows(&text, what).with_context(|| path.display().to_string())?;
    Ok((curve(&rows).with_context(|| path.display().to_string())?, rows))
}

/// Returns the first two columns of a table.
///
/// A header, blank lines and lines that start with # are skipped; commas, semicolons and tabs
/// separate columns.
fn rows(text: &str, what: &str) -> Result<Vec<[f64; 2]>> {
    let mut rows = Vec::new();
    let mut header_allowed = true;
    for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let mut cells = line.split([',', ';', '\t']).map(str::trim);
        let number = |cell: Option<&str>| cell.and_then(|c| c.parse::<f64>().ok());
        match (number(cells.next()), number(cells.next())) {
            (Some(a), Some(b)) => rows.push([a, b]),
            _ if header_allowed => {}
            _ => bail!("line {}: “{line}” is not {what}, two numbers with a comma between them", index + 1),
        }
        header_allowed = false;
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn header_comments_and_further_columns_are_left_out() {
        let read = rows("\u{feff}# mine\nr,g,g_uniform\n\n0.1,0.5,1\n0.2;1.5\r\n", "r and g").unwrap();
        assert_eq!(read, [[0.1, 0.5], [0.2, 1.5]]);
    }

    #[test]
    fn what_is_no_number_is_refused_with_its_line() {
        let message = rows("r,g\n0.1,0.5\n0.2,x\n", "r and g").unwrap_err().to_string();
        assert!(message.contains("line 3") && message.contains("0.2,x"), "{message}");
    }
}
