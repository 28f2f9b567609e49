//! Accuracy over several images: means over images, pooled rates, limits of agreement of counts and
//! densities, and intervals of all of these.

use super::{Rates, Score};
use crate::compare::{Agreement, Interval, agreement, bootstrap};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;
use std::collections::BTreeMap;

/// Agreement of detections with hand marks over several images.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Number of images averaged.
    pub images: usize,
    /// Mean of the images' sensitivities.
    pub sensitivity: f64,
    /// Mean of the images' false discovery rates.
    pub fdr: f64,
    /// Mean of the images' precisions.
    pub precision: f64,
    /// Mean of the images' Dice coefficients (F1).
    pub dice: f64,
    /// Mean of the images' sensitivities at the strict reach,
    /// [`STRICT_REACH`](super::STRICT_REACH).
    pub sensitivity_strict: f64,
    /// Mean of the images' false discovery rates at the strict reach.
    pub fdr_strict: f64,
    /// Mean of the images' Dice coefficients (F1) at the strict reach.
    pub dice_strict: f64,
    /// Mean of the images' localisation errors in px, over images with at least one hit; `None` if
    /// there are no such images.
    pub localisation_px: Option<f64>,
    /// Mean of the images' localisation errors in µm, over images with at least one hit and a known
    /// scale; `None` if there are no such images.
    pub localisation_um: Option<f64>,
    /// Mean of the images' localisation errors in [hexagonal
    /// spacings](crate::mosaic::hexagonal_spacing) of the marks, over images with at least one hit;
    /// `None` if there are no such images.
    pub localisation_s: Option<f64>,
    /// Mean of the images' mean displacements from mark to detection, in px to the right and down,
    /// over images with at least one hit; `None` if there are no such images.
    pub offset_px: Option<[f64; 2]>,
    /// Rates of all images taken together: hits, misses and false alarms are added up over the
    /// images first.
    pub pooled: Rates,
    /// Rates of all images taken together at the strict reach.
    pub pooled_strict: Rates,
    /// Bias and limits of agreement of the counts in cones per image. The difference of an image is
    /// its number of detections minus its number of marks, both outside the border strip.
    pub count: Option<Agreement>,
    /// Bias and limits of agreement of the densities. The difference of an image is a percentage of
    /// the mean of both densities, 100 (detections − marks) / (½ (detections + marks)), with the
    /// numbers of points outside the border strip.
    pub density_percent: Option<Agreement>,
}

/// Computes the means over images, the pooled rates and the limits of agreement; `None` without
/// images.
pub fn summarise(scores: &[Score]) -> Option<Summary> {
    let values = |value: &dyn Fn(&Score) -> Option<f64>| scores.iter().filter_map(value).collect::<Vec<_>>();
    let mean = |value: &dyn Fn(&Score) -> Option<f64>| crate::numeric::mean(&values(value));
    let offset = |axis: usize| mean(&|s| s.offset_px.map(|o| o[axis]));
    let total = |rates: fn(&Score) -> &Rates| {
        let sum = |count: fn(&Rates) -> usize| scores.iter().map(|s| count(rates(s))).sum();
        Rates::new(sum(|r| r.tp), sum(|r| r.fn_), sum(|r| r.fp))
    };
    Some(Summary {
        images: scores.len(),
        sensitivity: mean(&|s| Some(s.rates.sensitivity))?,
        fdr: mean(&|s| Some(s.rates.fdr))?,
        precision: mean(&|s| Some(s.rates.precision))?,
        dice: mean(&|s| Some(s.rates.dice))?,
        sensitivity_strict: mean(&|s| Some(s.strict.sensitivity))?,
        fdr_strict: mean(&|s| Some(s.strict.fdr))?,
        dice_strict: mean(&|s| Some(s.strict.dice))?,
        localisation_px: mean(&|s| s.localisation_px),
        localisation_um: mean(&Score::localisation_um),
        localisation_s: mean(&|s| s.localisation_s),
        offset_px: offset(0).zip(offset(1)).map(|(x, y)| [x, y]),
        pooled: total(|s| &s.rates),
        pooled_strict: total(|s| &s.strict),
        count: agreement(&values(&|s| Some(s.detections_inside as f64 - s.marks_inside as f64))),
        density_percent: agreement(&values(&|s| {
            percent_of_mean(s.detections_inside as f64, s.marks_inside as f64)
        })),
    })
}

/// Returns the difference of two numbers as a percentage of their mean; `None` if both are zero.
pub(super) fn percent_of_mean(first: f64, second: f64) -> Option<f64> {
    (first + second > 0.).then(|| 200. * (first - second) / (first + second))
}

/// Function that reads one value of a summary; `None` if the summary lacks the value.
type Value = fn(&Summary) -> Option<f64>;

/// Values of a summary for which [`intervals`] computes an interval, with their names in
/// `validation.json`.
const VALUES: &[(&str, Value)] = &[
    ("sensitivity", |s| Some(s.sensitivity)),
    ("fdr", |s| Some(s.fdr)),
    ("precision", |s| Some(s.precision)),
    ("dice", |s| Some(s.dice)),
    ("sensitivity_strict", |s| Some(s.sensitivity_strict)),
    ("fdr_strict", |s| Some(s.fdr_strict)),
    ("dice_strict", |s| Some(s.dice_strict)),
    ("localisation_px", |s| s.localisation_px),
    ("localisation_um", |s| s.localisation_um),
    ("localisation_s", |s| s.localisation_s),
    ("pooled.sensitivity", |s| Some(s.pooled.sensitivity)),
    ("pooled.fdr", |s| Some(s.pooled.fdr)),
    ("pooled.precision", |s| Some(s.pooled.precision)),
    ("pooled.dice", |s| Some(s.pooled.dice)),
    ("pooled_strict.sensitivity", |s| Some(s.pooled_strict.sensitivity)),
    ("pooled_strict.fdr", |s| Some(s.pooled_strict.fdr)),
    ("pooled_strict.dice", |s| Some(s.pooled_strict.dice)),
    ("count.bias", |s| Some(s.count?.bias)),
    ("count.lower_limit", |s| Some(s.count?.limits?[0])),
    ("count.upper_limit", |s| Some(s.count?.limits?[1])),
    ("density_percent.bias", |s| Some(s.density_percent?.bias)),
    ("density_percent.lower_limit", |s| Some(s.density_percent?.limits?[0])),
    ("density_percent.upper_limit", |s| Some(s.density_percent?.limits?[1])),
];

/// Returns the 95 % confidence intervals of the values of a [`Summary`], by their names in
/// `validation.json`.
///
/// Each entry of `clusters` holds the indices of images that belong together, such as those of one
/// subject. The intervals come from [`bootstrap()`] over the clusters. If every cluster is a single
/// image, the intervals of bias and limits of agreement follow from Student's t distribution
/// instead (see [`Agreement`]). A value whose interval cannot be computed is missing from the map.
pub fn intervals(
    scores: &[Score],
    clusters: &[Vec<usize>],
    resamples: usize,
    rng: &mut ChaCha8Rng,
) -> BTreeMap<&'static str, Interval> {
    let statistics = |indexes: &[usize]| {
        let drawn: Vec<Score> = indexes.iter().filter_map(|&i| scores.get(i).copied()).collect();
        let summary = summarise(&drawn);
        VALUES.iter().map(|(_, value)| summary.as_ref().and_then(value)).collect()
    };
    let drawn = bootstrap(clusters, resamples, rng, statistics);
    let mut found: BTreeMap<&str, Interval> =
        VALUES.iter().zip(drawn).filter_map(|((name, _), interval)| Some((*name, interval?))).collect();
    if clusters.iter().all(|c| c.len() == 1)
        && let Some(summary) = summarise(scores)
    {
        let count = ["count.bias", "count.lower_limit", "count.upper_limit"];
        let density = ["density_percent.bias", "density_percent.lower_limit", "density_percent.upper_limit"];
        for (names, agreement) in [(count, summary.count), (density, summary.density_percent)] {
            let exact = agreement.and_then(|a| a.bias_interval().zip(a.limit_intervals()));
            let intervals = exact.into_iter().flat_map(|(bias, [low, high])| [bias, low, high]);
            found.extend(names.into_iter().zip(intervals));
        }
    }
    found
}
