//! Paired comparison of two detectors or graders on the same images: mean differences with
//! bootstrap intervals and permutation tests.

use super::Score;
use crate::compare::{Interval, bootstrap, least_p, sign_flip_test};
use crate::numeric::mean;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

/// Comparison of two detectors or graders by one measure on the same images.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Name of the measure that is compared.
    pub measure: &'static str,
    /// Number of images for which both detectors have a value of the measure.
    pub images: usize,
    /// Mean of the measure for the first detector, over the images for which both detectors have a
    /// value.
    pub first: f64,
    /// Mean of the measure for the second detector, over the images for which both detectors have a
    /// value.
    pub second: f64,
    /// Mean of the differences first − second, over the images for which both detectors have a
    /// value.
    pub difference: f64,
    /// 95 % bootstrap interval (bias-corrected and accelerated, BCa) of the mean difference; `None`
    /// for fewer than two groups of images.
    pub interval: Option<Interval>,
    /// p-value of the paired sign-flip permutation test that the mean difference is zero.
    pub p: Option<f64>,
    /// Smallest p-value that the sign-flip test can give for this number of groups, however large
    /// the differences are. Only groups in which the two detectors differ count; an image without a
    /// group is a group of its own.
    pub least_p: f64,
}

/// Name of a measure and its value for one image.
type Measure = (&'static str, fn(&Score) -> Option<f64>);

/// Measures that are always compared, as they do not depend on the scale.
const RATES: [Measure; 4] = [
    ("dice", |s| Some(s.rates.dice)),
    ("sensitivity", |s| Some(s.rates.sensitivity)),
    ("fdr", |s| Some(s.rates.fdr)),
    ("count", |s| Some(s.detections_inside as f64)),
];
/// Measure that is added if the scale of every image is known: density in cones per mm².
const PER_MM2: Measure = ("density_per_mm2", |s| density(s, s.area_mm2()));
/// Measure that is added instead if the scale of an image is unknown: density in cones per px².
const PER_PX2: Measure = ("density_per_px2", |s| density(s, Some(s.area_px)));

/// Returns the number of detections outside the border strip per unit of `area`; `None` if the area
/// is unknown or zero.
fn density(score: &Score, area: Option<f64>) -> Option<f64> {
    area.filter(|a| *a > 0.).map(|a| score.detections_inside as f64 / a)
}

/// Compares two detectors or graders that were scored against the same marks, and returns one
/// difference per measure.
///
/// The measures are Dice coefficient, sensitivity, false discovery rate, count and density (per mm²
/// if the scale of every image is known, else per px²). Each entry of `clusters` holds the indices
/// of images that belong together, such as those of one subject. Every measure starts from a copy
/// of the same `rng`, so all measures use the same resamples.
pub fn compare_scores(
    first: &[Score],
    second: &[Score],
    clusters: &[Vec<usize>],
    resamples: usize,
    rng: &ChaCha8Rng,
) -> Vec<Difference> {
    let scaled = first.iter().chain(second).all(|s| s.um_per_px.is_some());
    RATES
        .into_iter()
        .chain([if scaled { PER_MM2 } else { PER_PX2 }])
        .filter_map(|(measure, value)| {
            let pairs: Vec<Option<(f64, f64)>> =
                first.iter().zip(second).map(|(a, b)| value(a).zip(value(b))).collect();
            difference(measure, &pairs, clusters, resamples, &mut rng.clone())
        })
        .collect()
}

/// Compares two detectors by one measure. `pairs` contains their two values for each image, or
/// `None` if one of the values is missing. Returns `None` if no image has both values.
fn difference(
    measure: &'static str,
    pairs: &[Option<(f64, f64)>],
    clusters: &[Vec<usize>],
    resamples: usize,
    rng: &mut ChaCha8Rng,
) -> Option<Difference> {
    let of = |indexes: &[usize], value: fn((f64, f64)) -> f64| {
        mean(&indexes.iter().filter_map(|&i| pairs.get(i).copied().flatten().map(value)).collect::<Vec<_>>())
    };
    let all: Vec<usize> = (0..pairs.len()).collect();
    let by_difference = |indexes: &[usize]| vec![of(indexes, |(a, b)| a - b)];
    // an image without both values gets the difference 0, which changes no sum and keeps the
    // indices in `clusters` valid
    let differences: Vec<f64> = pairs.iter().map(|pair| pair.map_or(0., |(a, b)| a - b)).collect();
    let differ = |c: &&Vec<usize>| c.iter().any(|&i| differences.get(i).is_some_and(|d| *d != 0.));
    let differing = clusters.iter().filter(differ).count();
    Some(Difference {
        measure,
        images: pairs.iter().flatten().count(),
        first: of(&all, |(a, _)| a)?,
        second: of(&all, |(_, b)| b)?,
        difference: of(&all, |(a, b)| a - b)?,
        interval: bootstrap(clusters, resamples, rng, by_difference).pop().flatten(),
        p: sign_flip_test(&differences, clusters, rng),
        least_p: least_p(differing),
    })
}
