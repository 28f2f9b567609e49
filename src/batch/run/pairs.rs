//! Comparison of the images of a run with each other: pairs of channels of the same field, and the
//! image that was decided otherwise than the images beside it.

use super::Job;
use super::done::{Done, POINTS};
use crate::batch::BatchError;
use crate::compare::{Registration, register};
use crate::geometry::Point;
use crate::image::Modality;
use crate::mosaic::io::{ReadOptions, read_from};
use crate::report::ImageRecord;
use crate::report::tables::{ChannelPair, PAIRED_CONES, PAIRS, PairedCone};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use strum::VariantArray;

/// Folder of the files of cones of pairs.
const FOLDER: &str = "pairs";
/// F1 below which two channels may not show the same field: points that have nothing to do with
/// each other have about 0.45 at the best of all shifts.
const SAME_FIELD: f64 = 0.6;
/// Least number of other images that say what an image beside them is likely to be.
const SIBLINGS: usize = 5;
/// Share of these that must agree.
const AGREEING: f64 = 0.8;

impl Job<'_> {
    /// Returns the pairs among images, each with its name and the indices of its images, the
    /// split-detector one last; and remarks on images without a partner.
    fn paired(&self, done: &[Done]) -> (Vec<(String, [usize; 2])>, Vec<String>) {
        let mut groups: BTreeMap<String, Vec<(Modality, usize)>> = BTreeMap::new();
        for (k, done) in done.iter().enumerate() {
            let path = Path::new(&done.record.file);
            let decided = done.record.detection.as_ref().map(|d| d.modality);
            let of = match &self.options.pairs {
                Some(patterns) => patterns.of(path),
                None => self.options.plan.labels.pair_of(path).and_then(|name| {
                    Some((decided.or_else(|| self.options.plan.labels.modality_of(path).ok()?)?, name))
                }),
            };
            if let Some((modality, name)) = of {
                groups.entry(name).or_default().push((modality, k));
            }
        }
        let (mut pairs, mut remarks) = (Vec::new(), Vec::new());
        for (name, mut images) in groups {
            images.sort_by_key(|(modality, k)| (*modality == Modality::Split, *k));
            match images.as_slice() {
                [(one, a), (other, b)] if one != other => pairs.push((name, [*a, *b])),
                several => remarks.push(format!(
                    "“{name}” is no pair: expected two images of different modality, found {}",
                    several
                        .iter()
                        .map(|(m, k)| format!("{} ({m})", done[*k].record.name))
                        .collect::<Vec<_>>()
                        .join(", ")
                )),
            }
        }
        (pairs, remarks)
    }

    /// Compares the cones of the two images of every pair, and writes `pairs.csv` and
    /// `pairs/NAME.csv`. Returns the rows and remarks on images without a partner.
    pub(super) fn write_pairs(&self, done: &[Done]) -> Result<(Vec<ChannelPair>, Vec<String>), BatchError> {
        if self.options.pairs.is_none() && !self.options.plan.labels.has_pairs() {
            return Ok((Vec::new(), Vec::new()));
        }
        let (pairs, remarks) = self.paired(done);
        let folder = self.out.folder(FOLDER)?;
        let mut rows: Vec<ChannelPair> = Vec::new();
        for (name, [a, b]) in pairs {
            let [first, second] = [&done[a].record, &done[b].record];
            let file = Path::new(&first.file);
            let mut name = file_name(&name).unwrap_or_else(|| second.name.clone());
            while rows.iter().any(|row| row.name == name) {
                name.push('_');
            }
            let cones = [self.cones_in(first)?, self.cones_in(second)?];
            let size = (first.width_px.min(second.width_px), first.height_px.min(second.height_px));
            let found = register(&cones[0], &cones[1], size)
                .map_err(|e| BatchError::Pairing { file: file.to_owned(), problem: e.to_string() })?;
            let row = row_of(name, [first, second], &found, self.modalities([first, second]));
            let points = points_of(&cones, &found, &row.modalities);
            folder.write(&format!("{}.csv", row.name), &PAIRED_CONES.csv(&points)?)?;
            rows.push(row);
        }
        self.out.write(PAIRS.file, &PAIRS.csv(&rows)?)?;
        Ok((rows, remarks))
    }

    /// Returns the names of the modalities of two images.
    fn modalities(&self, images: [&ImageRecord; 2]) -> [String; 2] {
        images.map(|r| {
            let path = Path::new(&r.file);
            let named = || self.options.pairs.as_ref()?.of(path).map(|(modality, _)| modality);
            let labelled = || self.options.plan.labels.modality_of(path).ok().flatten();
            let modality = r.detection.as_ref().map(|d| d.modality).or_else(named).or_else(labelled);
            modality.map_or_else(|| r.name.clone(), |m| m.to_string())
        })
    }

    /// Reads the cones of an image from its results, in px.
    fn cones_in(&self, record: &ImageRecord) -> Result<Vec<Point>, BatchError> {
        let path = self.images.join(&record.name).join(POINTS);
        let bytes =
            fs::read(&path).map_err(|source| BatchError::Unreadable { path: path.clone(), source })?;
        let centres = super::cones::without_scores(&bytes);
        Ok(read_from(&path.display().to_string(), &centres, &ReadOptions::default())?.points)
    }
}

/// Returns a name that can be a file name on every system; `None` if nothing is left.
fn file_name(name: &str) -> Option<String> {
    let safe = |c: char| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' };
    let name: String = name.chars().map(safe).collect();
    let name = name.trim_matches(['.', '_']);
    (!name.is_empty()).then(|| name.to_owned())
}

/// Returns the row of a pair, with its warnings.
fn row_of(
    name: String,
    [first, second]: [&ImageRecord; 2],
    found: &Registration,
    modalities: [String; 2],
) -> ChannelPair {
    let rates = &found.rates;
    let mut warnings = Vec::new();
    if (first.width_px, first.height_px) != (second.width_px, second.height_px) {
        warnings.push(format!(
            "the images differ in size ({} × {} and {} × {} px): are they registered?",
            first.width_px, first.height_px, second.width_px, second.height_px
        ));
    }
    if found.at_limit {
        warnings.push("the shift is at its limit of 8 px: register the images first".into());
    }
    if rates.dice < SAME_FIELD {
        warnings.push(format!(
            "the channels agree little more than by chance (F1 {:.2}): do they show the same field?",
            rates.dice
        ));
    }
    ChannelPair {
        name,
        images: [first.name.clone(), second.name.clone()],
        modalities,
        shift: found.shift,
        limit_px: found.limit_px,
        both: rates.tp,
        alone: [rates.fp, rates.fn_],
        shares: [rates.precision, rates.sensitivity],
        f1: rates.dice,
        warnings,
    }
}

/// Returns the cones of both images at their places in the second image, row by row.
fn points_of(cones: &[Vec<Point>; 2], found: &Registration, modalities: &[String; 2]) -> Vec<PairedCone> {
    let mut partner = vec![false; cones[0].len()];
    let mut seen = vec![&*modalities[1]; cones[1].len()];
    for &(a, b) in &found.pairs {
        (partner[a], seen[b]) = (true, "both");
    }
    let cone = |p: Point, seen_in: &str, counted: bool| PairedCone {
        x: p.x,
        y: p.y,
        seen_in: seen_in.into(),
        counted,
    };
    let [x, y] = found.shift;
    let alone = (0..partner.len()).filter(|&a| !partner[a]).map(|a| {
        let p = cones[0][a];
        cone(Point::new(p.x + x, p.y + y), &modalities[0], found.first_counts[a])
    });
    let of_second = (0..seen.len()).map(|b| cone(cones[1][b], seen[b], found.second_counts[b]));
    let mut all: Vec<PairedCone> = of_second.chain(alone).collect();
    all.sort_by(|a, b| a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x)));
    all
}

/// Adds a warning to every image whose modality was decided otherwise than that of most images of
/// its folder that are of its size. Images whose modality was given take part as siblings only.
pub(super) fn warn_of_odd_ones(done: &mut [Done], given: impl Fn(&Path) -> bool) {
    let mut folders: BTreeMap<_, Vec<(usize, Modality)>> = BTreeMap::new();
    for (k, done) in done.iter().enumerate() {
        let (record, path) = (&done.record, Path::new(&done.record.file));
        if let Some(found) = &record.detection {
            let alike = (path.parent().map(Path::to_owned), record.width_px, record.height_px);
            folders.entry(alike).or_default().push((k, found.modality));
        }
    }
    for images in folders.values() {
        let others = images.len() - 1;
        let counts = |modality: Modality| images.iter().filter(|(_, m)| *m == modality).count();
        let counts: Vec<(Modality, usize)> = Modality::VARIANTS.iter().map(|&m| (m, counts(m))).collect();
        for &(k, modality) in images {
            // the most frequent modality of the others: an image does not agree with itself
            let among_others = counts.iter().map(|&(m, n)| (m, n - usize::from(m == modality)));
            let Some((most, n)) = among_others.max_by_key(|(_, n)| *n) else { continue };
            let agree = n as f64 >= AGREEING * others as f64;
            if others < SIBLINGS || !agree || most == modality || given(Path::new(&done[k].record.file)) {
                continue;
            }
            done[k].record.odd_one_out = true;
            done[k].record.warnings.insert(
                0,
                format!(
                    "decided {modality} while {n} of {} images of this size in the folder are {most}: look at it, \
                     and if it is {most} too, state so in a column “modality” of the manifest",
                    images.len()
                ),
            );
        }
    }
}
