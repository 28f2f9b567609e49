use super::matching::{Assignment, MatchError, MatchOptions, Matching, match_points};
use crate::geometry::Point;
use crate::mosaic::hexagonal_spacing;
use serde::Serialize;

/// How well the detections of one image agree with hand marks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Score {
    /// Hits: pairs outside the border.
    pub tp: usize,
    /// Misses: marks without detection, outside the border.
    #[serde(rename = "fn")]
    pub fn_: usize,
    /// False alarms: detections without mark, outside the border.
    pub fp: usize,
    /// tp / (tp + fn); 0 without marks.
    pub sensitivity: f64,
    /// False discovery rate, fp / (tp + fp); 0 without detections.
    pub fdr: f64,
    /// 2 tp / (2 tp + fp + fn); 0 if there is neither.
    pub dice: f64,
    /// tp / (tp + fp); 0 without detections.
    pub precision: f64,
    /// Median distance, in px, of the pairs outside the border.
    pub localisation_px: Option<f64>,
    /// The same in hexagonal spacings of the marks outside the border.
    pub localisation_s: Option<f64>,
    /// Detections / marks, both outside the border: 1 means equal density.
    pub density_ratio: Option<f64>,
    /// Marks, border included.
    pub n_marks: usize,
    /// Detections, border included.
    pub n_detections: usize,
    /// Largest distance of a pair, in px.
    pub limit_px: f64,
    /// Who got whom where several were near.
    pub assignment: Assignment,
}

/// Scores detections against hand marks of one image of `width` × `height` px, and says which belongs to which.
///
/// # Errors
/// As [`match_points`].
pub fn validate(
    marks: &[Point],
    detections: &[Point],
    width: usize,
    height: usize,
    options: &MatchOptions,
) -> Result<(Score, Matching), MatchError> {
    let matching = match_points(marks, detections, width, height, options)?;
    let inside = |in_border: &[bool]| in_border.iter().filter(|b| !**b).count();
    let marks_inside = inside(&matching.marks_in_border);
    let detections_inside = inside(&matching.detections_in_border);

    let mut distances: Vec<f64> = matching.pairs.iter().filter(|p| p.counted).map(|p| p.distance).collect();
    let localisation_px = super::median(&mut distances);
    let side = |pixels: usize| (pixels as f64 - 2. * options.border).max(0.);
    let spacing = hexagonal_spacing(marks_inside, side(width) * side(height)).filter(|s| *s > 0.);

    let rates = Rates::new(matching.true_positives(), matching.false_negatives(), matching.false_positives());
    let score = Score {
        tp: rates.tp,
        fn_: rates.fn_,
        fp: rates.fp,
        sensitivity: rates.sensitivity,
        fdr: rates.fdr,
        dice: rates.dice,
        precision: ratio(rates.tp, rates.tp + rates.fp),
        localisation_px,
        localisation_s: localisation_px.zip(spacing).map(|(d, s)| d / s),
        density_ratio: (marks_inside > 0).then(|| detections_inside as f64 / marks_inside as f64),
        n_marks: marks.len(),
        n_detections: detections.len(),
        limit_px: matching.limit,
        assignment: matching.assignment,
    };
    Ok((score, matching))
}

/// Counts and the rates that follow from them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rates {
    /// Hits.
    pub tp: usize,
    /// Misses.
    #[serde(rename = "fn")]
    pub fn_: usize,
    /// False alarms.
    pub fp: usize,
    /// tp / (tp + fn).
    pub sensitivity: f64,
    /// fp / (tp + fp).
    pub fdr: f64,
    /// 2 tp / (2 tp + fp + fn).
    pub dice: f64,
}

impl Rates {
    fn new(tp: usize, fn_: usize, fp: usize) -> Self {
        let (sensitivity, fdr) = (ratio(tp, tp + fn_), ratio(fp, tp + fp));
        Self { tp, fn_, fp, sensitivity, fdr, dice: ratio(2 * tp, 2 * tp + fn_ + fp) }
    }
}

/// 0 / 0 is 0, as in the evaluations published.
fn ratio(part: usize, whole: usize) -> f64 {
    part as f64 / whole.max(1) as f64
}

/// How well detections agree with hand marks over several images.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Number of images.
    pub images: usize,
    /// Mean of the images' sensitivities.
    pub sensitivity: f64,
    /// Mean of the images' false discovery rates.
    pub fdr: f64,
    /// Mean of the images' Dice coefficients.
    pub dice: f64,
    /// Mean of the images' localisation errors in px, over images with a hit.
    pub localisation_px: Option<f64>,
    /// The same in hexagonal spacings.
    pub localisation_s: Option<f64>,
    /// Agreement of density (Bland & Altman 1986): mean over images of density ratio − 1.
    pub density_bias: Option<f64>,
    /// Its 95 % limits, bias ± 1.96 standard deviations (n − 1); none for fewer than two images.
    pub density_limits: Option<[f64; 2]>,
    /// All images' points counted together.
    pub pooled: Rates,
}

/// Means over images and pooled rates; `None` without images.
pub fn summarise(scores: &[Score]) -> Option<Summary> {
    let mean = |value: fn(&Score) -> Option<f64>| mean(&scores.iter().filter_map(value).collect::<Vec<_>>());
    let ratios: Vec<f64> = scores.iter().filter_map(|s| s.density_ratio).collect();
    let density_bias = mean(|s| s.density_ratio).map(|m| m - 1.);
    let density_limits = density_bias.filter(|_| ratios.len() > 1).map(|bias| {
        let squares: f64 = ratios.iter().map(|r| (r - 1. - bias).powi(2)).sum();
        let reach = 1.96 * (squares / (ratios.len() - 1) as f64).sqrt();
        [bias - reach, bias + reach]
    });
    let total = |count: fn(&Score) -> usize| scores.iter().map(count).sum();
    Some(Summary {
        images: scores.len(),
        sensitivity: mean(|s| Some(s.sensitivity))?,
        fdr: mean(|s| Some(s.fdr))?,
        dice: mean(|s| Some(s.dice))?,
        localisation_px: mean(|s| s.localisation_px),
        localisation_s: mean(|s| s.localisation_s),
        density_bias,
        density_limits,
        pooled: Rates::new(total(|s| s.tp), total(|s| s.fn_), total(|s| s.fp)),
    })
}

fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}
