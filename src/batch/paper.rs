//! Computation of the results of Lanaro et al. (2020, <https://doi.org/10.1088/2399-6528/ab8064>)
//! that concern samplers.
//!
//! 1. Draw all patterns and compute all spectra that are needed, on all cores.
//! 2. Measure the patterns for the samplers' rows of Table 1.
//! 3. Average the pair correlation functions for Figure 1, and take the l-infinity distances
//!    between the samplers of Table 2, at several bandwidths.
//! 4. Compare the printed rows of Table 2 with these distances by the triangle inequality.

use super::output::{OutputFolder, ResultFolder};
use super::{BatchError, Progress};
use crate::compare::paper::{
    FIGURE_1_SAMPLERS, Pattern, PrintedDistances, TABLE_1_SAMPLERS, TABLE_2_SAMPLERS, distance_between,
    made_row, pattern, printed_distances, printed_regularity, tightest, with_bandwidth,
};
use crate::compare::{CompareError, draw, l_infinity, mean_curve, of_sampler};
use crate::geometry::Window;
use crate::report::tables::{BandwidthRow, FINDING, PAPER_PCF, PAPER_SPECTRA, SamplerCurve, curves_csv};
use crate::report::{
    Curve, FindingRecord, PaperResults, PowerScale, SamplerPanel, counted, samplers_figure, spectrum_plane,
};
use crate::sample::{Sampler, as_reference, sampler};
use crate::stats::{Pcf, PowerSpectrum, SpectrumOptions, spectrum};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;

/// Number of points in a pattern for the mean curves and for Figure 1, as in the paper.
const POINTS: usize = 1024;
/// Number of points in a pattern for the spectra of Figure 1, as in the paper.
const SPECTRUM_POINTS: usize = 4096;
/// Highest frequency of the spectra, in units of √n for n points in the unit square.
const MAX_FREQUENCY: f64 = 2.5;

/// Bandwidths, in hexagonal spacings, at which the distances between the samplers are computed and
/// compared with the printed rows of Table 2. They lie on both sides of 0.1, the default, to show
/// that all printed rows are possible near the default only.
const BANDWIDTHS: [f64; 7] = [0.05, 0.07, 0.09, 0.1, 0.12, 0.15, 0.2];

/// Piece of work for one core.
#[derive(Clone, Copy)]
enum Task {
    /// Draw and measure pattern number `k` of a sampler, with about `n` points.
    Pattern { sampler: &'static dyn Sampler, n: usize, k: usize },
    /// Compute the spectrum of one pattern of a sampler on the unit torus.
    Spectrum { sampler: &'static dyn Sampler },
}

/// Result of a [`Task`] of the same name.
enum Made {
    Pattern(Pattern),
    Spectrum(PowerSpectrum),
}

/// All patterns and spectra that were computed.
#[derive(Default)]
struct Everything {
    /// Patterns by name of the sampler and number of points asked for.
    patterns: BTreeMap<(&'static str, usize), Vec<Pattern>>,
    /// Spectra by name of the sampler.
    spectra: BTreeMap<&'static str, PowerSpectrum>,
}

/// Computes again, with the samplers of this library, the results of Lanaro et al. (2020) about
/// samplers: their rows of Table 1, Figure 1, and the distances between the samplers of Table 2.
///
/// `patterns` is the number of patterns that are drawn for each sampler and each number of points;
/// it must be at least 2. Writes `index.html`, `paper.md`, `figure1.svg` and tables as CSV into
/// `out`.
///
/// # Errors
/// Fails if a sampler is missing or makes no pattern, or `out` cannot be written to.
pub fn remake_paper(
    patterns: usize,
    seed: u64,
    out: &Path,
    progress: &dyn Progress,
) -> Result<PaperResults, BatchError> {
    let tasks = tasks(patterns)?;
    let out = ResultFolder::open(out)?;
    progress.begin(tasks.len());
    let made: Result<Vec<_>, CompareError> =
        tasks.par_iter().map(|task| work(task, seed, progress).map(|made| (*task, made))).collect();
    progress.end();
    let mut all = Everything::default();
    for (task, made) in made? {
        match (task, made) {
            (Task::Pattern { sampler, n, .. }, Made::Pattern(pattern)) => {
                all.patterns.entry((sampler.name(), n)).or_default().push(pattern);
            }
            (Task::Spectrum { sampler }, Made::Spectrum(spectrum)) => {
                all.spectra.insert(sampler.name(), spectrum);
            }
            _ => {}
        }
    }
    let results = results(&all, patterns, seed)?;
    write(&all, &results, &out)?;
    out.close(0)?;
    Ok(results)
}

/// Lists all tasks, the longest first, so that no long task is left to a single core at the end.
fn tasks(patterns: usize) -> Result<Vec<Task>, BatchError> {
    let named = |name: &str| {
        sampler(name)
            .map(as_reference)
            .map_err(|source| CompareError::Sample { sampler: name.to_owned(), source })
    };
    let mut tasks = Vec::new();
    for name in FIGURE_1_SAMPLERS {
        tasks.push(Task::Spectrum { sampler: named(name)? });
    }
    let mut sets: Vec<(&str, usize)> = TABLE_1_SAMPLERS.iter().map(|&(_, name, n)| (name, n)).collect();
    sets.extend(FIGURE_1_SAMPLERS.map(|name| (name, POINTS)));
    sets.sort_by_key(|&(name, n)| (std::cmp::Reverse(n), name));
    sets.dedup();
    for (name, n) in sets {
        let sampler = named(name)?;
        tasks.extend((0..patterns).map(|k| Task::Pattern { sampler, n, k }));
    }
    Ok(tasks)
}

/// Does one task and reports it to `progress`.
fn work(task: &Task, seed: u64, progress: &dyn Progress) -> Result<Made, CompareError> {
    match *task {
        Task::Pattern { sampler, n, k } => {
            let made = pattern(sampler, n, k, seed)?;
            let ri = made.nearest.ri.map(|ri| format!(", RI {ri:.2}")).unwrap_or_default();
            progress.done(&format!("{} {n}", sampler.name()), Ok(&format!("pattern {}{ri}", k + 1)));
            Ok(Made::Pattern(made))
        }
        Task::Spectrum { sampler } => {
            let window = Window::unit_torus();
            let points = draw(sampler, SPECTRUM_POINTS, &window, &mut ChaCha8Rng::seed_from_u64(seed))?;
            let found = spectrum(&points, &window, &SpectrumOptions { max_frequency: MAX_FREQUENCY })
                .map_err(of_sampler(sampler.name()))?;
            progress.done(sampler.name(), Ok(&format!("spectrum of {}", counted(points.len(), "point"))));
            Ok(Made::Spectrum(found))
        }
    }
}

impl Everything {
    /// Returns the patterns of a sampler for which `n` points were asked; empty if there are no
    /// such patterns.
    fn of(&self, sampler: &'static str, n: usize) -> &[Pattern] {
        self.patterns.get(&(sampler, n)).map_or(&[], Vec::as_slice)
    }

    /// Returns the pair correlation functions of a sampler's patterns of [`POINTS`] points.
    fn curves(&self, sampler: &'static str) -> Vec<&Pcf> {
        self.of(sampler, POINTS).iter().map(|p| &p.pcf).collect()
    }
}

/// Computes all numbers that the page and the tables show.
fn results(all: &Everything, patterns: usize, seed: u64) -> Result<PaperResults, BatchError> {
    let regularity = printed_regularity();
    let rows = TABLE_1_SAMPLERS.iter().filter_map(|&(name, sampler, n)| {
        let printed = regularity.iter().find(|r| r.name == name)?.clone();
        Some(made_row(printed, sampler, n, &all.of(sampler, n).iter().collect::<Vec<_>>()))
    });
    let [bnot, darts, jittered] = TABLE_2_SAMPLERS.map(|name| all.curves(name));
    let distances = [
        distance_between(&bnot, &darts)?,
        distance_between(&bnot, &jittered)?,
        distance_between(&darts, &jittered)?,
    ];
    let printed = printed_distances();
    let between = distances.map(|d| d.l_infinity);
    let findings = TABLE_2_SAMPLERS.iter().enumerate().map(|(column, sampler)| {
        let both = printed.iter().filter_map(|d| {
            let row = regularity.iter().find(|r| r.name == d.name)?;
            Some((row.ri, d.l_infinity[column]))
        });
        let pairs: Vec<(f64, f64)> = both.collect();
        FindingRecord::of(sampler, &pairs, seed)
    });
    let curves = FIGURE_1_SAMPLERS
        .iter()
        .filter_map(|name| Some(((*name).to_owned(), mean_curve(&all.curves(name))?)));
    Ok(PaperResults {
        rows: rows.collect(),
        distances,
        tightest: printed.iter().map(|row| tightest(row, &between)).collect(),
        bandwidths: bandwidths(all, &printed)?,
        findings: findings.collect(),
        curves: curves.collect(),
        printed,
        patterns,
        seed,
    })
}

/// Returns one row per bandwidth: the distances between the samplers of Table 2, and the number of
/// printed rows that satisfy the triangle inequality with these distances.
fn bandwidths(all: &Everything, printed: &[PrintedDistances]) -> Result<Vec<BandwidthRow>, BatchError> {
    let at = |&width: &f64| -> Result<_, CompareError> {
        let mut means = Vec::new();
        for name in TABLE_2_SAMPLERS {
            let curves = all.of(name, POINTS).iter().map(|p| with_bandwidth(p, width));
            let curves = curves.collect::<Result<Vec<_>, _>>().map_err(of_sampler(name))?;
            means.extend(mean_curve(&curves.iter().collect::<Vec<_>>()));
        }
        let [bnot, darts, jittered] = &means[..] else { return Err(CompareError::TooFewPoints { found: 0 }) };
        let distances = [l_infinity(bnot, darts)?, l_infinity(bnot, jittered)?, l_infinity(darts, jittered)?];
        let holds = printed.iter().filter(|row| tightest(row, &distances).room >= 0.).count();
        Ok(BandwidthRow { bandwidth: width, distances, holds })
    };
    Ok(BANDWIDTHS.par_iter().map(at).collect::<Result<Vec<_>, _>>()?)
}

/// Writes the tables, the figure, and the page as Markdown and HTML.
fn write(all: &Everything, results: &PaperResults, out: &OutputFolder) -> Result<(), BatchError> {
    for (file, bytes) in results.tables()? {
        out.write(file, &bytes)?;
    }
    out.write(FINDING.file, &FINDING.csv(&results.findings)?)?;
    let curves = results.curves.iter().map(|(name, curve)| (name.as_str(), &curve.r, &curve.g));
    out.write(PAPER_PCF.file, &curves_csv(&PAPER_PCF, &named(curves))?)?;
    let spectra = all.spectra.iter().map(|(name, spectrum)| (*name, &spectrum.frequency, &spectrum.power));
    out.write(PAPER_SPECTRA.file, &curves_csv(&PAPER_SPECTRA, &named(spectra))?)?;
    let figure = figure(all, results)?;
    out.write("figure1.svg", figure.as_bytes())?;
    let made = format!(
        "Made by conemosaic {} paper, seed {}, {} per sampler and number of points. The same seed makes \
         the same page.",
        env!("CARGO_PKG_VERSION"),
        results.seed,
        counted(results.patterns, "pattern"),
    );
    let document = results.document(figure, made);
    out.write("paper.md", document.to_markdown().as_bytes())?;
    out.write("index.html", document.to_html().as_bytes())
}

/// Returns the curves for a table. Each input has the name of a sampler, x and y; names are written
/// with `_` instead of `-`.
fn named<'a>(curves: impl Iterator<Item = (&'a str, &'a Vec<f64>, &'a Vec<f64>)>) -> Vec<SamplerCurve<'a>> {
    curves.map(|(name, x, y)| SamplerCurve { sampler: name.replace('-', "_"), x, y }).collect()
}

/// Draws Figure 1: one panel per sampler with its points, spectrum, g(r) and radial power.
fn figure(all: &Everything, results: &PaperResults) -> Result<String, BatchError> {
    let mut pictures = BTreeMap::new();
    for (name, spectrum) in &all.spectra {
        pictures.insert(*name, spectrum_plane(spectrum, PowerScale::Linear)?);
    }
    let panels: Vec<SamplerPanel> = FIGURE_1_SAMPLERS
        .iter()
        .zip(&results.curves)
        .filter_map(|(name, (_, pcf))| {
            let spectrum = all.spectra.get(name)?;
            Some(SamplerPanel {
                name,
                points: &all.of(name, POINTS).first()?.points,
                spectrum: pictures.get(name)?,
                pcf: Curve { r: &pcf.r, g: &pcf.g },
                radial: Curve { r: &spectrum.frequency, g: &spectrum.power },
            })
        })
        .collect();
    Ok(samplers_figure("Figure 1: six point samplers", &panels)?)
}
