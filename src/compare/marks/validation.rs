use super::matching::{Assignment, Field, MatchError, MatchOptions, Matching, match_points};
use crate::geometry::Point;
use crate::mosaic::hexagonal_spacing;
use serde::Serialize;

/// Counts and the rates that follow from them. 0 / 0 is 0, as in the evaluations published.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rates {
    /// Hits: pairs outside the border.
    pub tp: usize,
    /// Misses: marks without detection, outside the border.
    #[serde(rename = "fn")]
    pub fn_: usize,
    /// False alarms: detections without mark, outside the border.
    pub fp: usize,
    /// Recall, tp / (tp + fn); 0 without marks.
    pub sensitivity: f64,
    /// False discovery rate, fp / (tp + fp); 0 without detections.
    pub fdr: f64,
    /// tp / (tp + fp); 0 without detections.
    pub precision: f64,
    /// 2 tp / (2 tp + fp + fn), of points the same as F1, the harmonic mean of sensitivity and precision; 0 if there is
    /// neither mark nor detection.
    pub dice: f64,
}

impl Rates {
    /// From the numbers of hits, misses and false alarms.
    pub fn new(tp: usize, fn_: usize, fp: usize) -> Self {
        let ratio = |part: usize, whole: usize| part as f64 / whole.max(1) as f64;
        Self {
            tp,
            fn_,
            fp,
            sensitivity: ratio(tp, tp + fn_),
            fdr: ratio(fp, tp + fp),
            precision: ratio(tp, tp + fp),
            dice: ratio(2 * tp, 2 * tp + fn_ + fp),
        }
    }
}

/// How well the detections of one image agree with hand marks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Score {
    /// Hits, misses, false alarms and their rates.
    #[serde(flatten)]
    pub rates: Rates,
    /// Localisation error: median distance, in px, of the pairs outside the border.
    pub localisation_px: Option<f64>,
    /// The same in hexagonal spacings of the marks outside the border.
    pub localisation_s: Option<f64>,
    /// Mean way, in px to the right and down, from mark to detection of the pairs outside the border: near zero, unless
    /// one of the two counts pixels from elsewhere.
    pub offset_px: Option<[f64; 2]>,
    /// Marks outside the border.
    pub marks_inside: usize,
    /// Detections outside the border.
    pub detections_inside: usize,
    /// The second over the first: 1 means equal density. `None` without marks.
    pub density_ratio: Option<f64>,
    /// Area of the image without its border, in px².
    pub area_px: f64,
    /// Micrometres on the retina per pixel, where known; [`validate`] leaves it open.
    pub um_per_px: Option<f64>,
    /// Marks, border included.
    pub n_marks: usize,
    /// Detections, border included.
    pub n_detections: usize,
    /// Largest distance of a pair, in px.
    pub limit_px: f64,
    /// Who got whom where several were near.
    pub assignment: Assignment,
}

impl Score {
    /// Median distance of the pairs outside the border, in µm; `None` without pairs or scale.
    pub fn localisation_um(&self) -> Option<f64> {
        self.localisation_px.zip(self.um_per_px).map(|(px, um)| px * um)
    }

    /// Area of the image without its border, in mm²; `None` without scale.
    pub fn area_mm2(&self) -> Option<f64> {
        self.um_per_px.map(|um| self.area_px * um * um * 1e-6)
    }
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

    let hits = || matching.pairs.iter().filter(|p| p.counted);
    let mut distances: Vec<f64> = hits().map(|p| p.distance).collect();
    let offset = |axis: fn(Point) -> f64| {
        let ways = hits().map(|p| axis(detections[p.detection]) - axis(marks[p.mark]));
        ways.sum::<f64>() / distances.len() as f64
    };
    let offset_px = (!distances.is_empty()).then(|| [offset(|p| p.x), offset(|p| p.y)]);
    let localisation_px = crate::numeric::median(&mut distances);
    let area_px = Field::new(width, height, options.border).area();
    let spacing = hexagonal_spacing(marks_inside, area_px).filter(|s| *s > 0.);

    let score = Score {
        rates: Rates::new(matching.true_positives(), matching.false_negatives(), matching.false_positives()),
        localisation_px,
        localisation_s: localisation_px.zip(spacing).map(|(d, s)| d / s),
        offset_px,
        marks_inside,
        detections_inside,
        density_ratio: (marks_inside > 0).then(|| detections_inside as f64 / marks_inside as f64),
        area_px,
        um_per_px: None,
        n_marks: marks.len(),
        n_detections: detections.len(),
        limit_px: matching.limit,
        assignment: matching.assignment,
    };
    Ok((score, matching))
}
