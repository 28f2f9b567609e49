use super::Score;
use crate::compare::{Interval, bootstrap, least_p, sign_flip_test};
use crate::numeric::mean;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

/// A measure of two detectors or graders on the same images.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// What is compared.
    pub measure: &'static str,
    /// Images for which both have a value.
    pub images: usize,
    /// Mean over these images of the first.
    pub first: f64,
    /// Mean over these images of the second.
    pub second: f64,
    /// Mean of the differences first − second of the same image.
    pub difference: f64,
    /// Its 95 % BCa bootstrap interval.
    pub interval: Option<Interval>,
    /// p-value of the paired sign-flip permutation test that the mean difference is zero.
    pub p: Option<f64>,
    /// The least p-value that the test can give for as many groups as differ at all (images, where there are no groups).
    pub least_p: f64,
}

type Measure = (&'static str, fn(&Score) -> Option<f64>);

const RATES: [Measure; 4] = [
    ("dice", |s| Some(s.rates.dice)),
    ("sensitivity", |s| Some(s.rates.sensitivity)),
    ("fdr", |s| Some(s.rates.fdr)),
    ("count", |s| Some(s.detections_inside as f64)),
];
const PER_MM2: Measure = ("density_per_mm2", |s| density(s, s.area_mm2()));
const PER_PX2: Measure = ("density_per_px2", |s| density(s, Some(s.area_px)));

fn density(score: &Score, area: Option<f64>) -> Option<f64> {
    area.filter(|a| *a > 0.).map(|a| score.detections_inside as f64 / a)
}

/// Paired differences of Dice, sensitivity, false discovery rate, count and density (per mm² where every scale is
/// known, else per px²) of two detectors or graders, each held against the same marks. `clusters` are the images that
/// belong together: subjects. Every measure begins with the same `rng`, and so has the same resamples.
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
