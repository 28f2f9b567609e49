use super::matching::{Assignment, Field, MatchError, MatchOptions, Matching, match_points};
use crate::geometry::Point;
use crate::mosaic::hexagonal_spacing;
use serde::Serialize;

/// Numbers of hits, misses and false alarms in one image or several, and the rates computed from
/// these numbers. Ratios of 0 / 0 are set to 0, as in the published evaluations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rates {
    /// Number of hits: pairs of a mark and a detection, both outside the border strip of the image.
    pub tp: usize,
    /// Number of misses: marks outside the border strip of the image that have no detection.
    #[serde(rename = "fn")]
    pub fn_: usize,
    /// Number of false alarms: detections outside the border strip of the image that have no mark.
    pub fp: usize,
    /// Recall, tp / (tp + fn); 0 without marks.
    pub sensitivity: f64,
    /// False discovery rate, fp / (tp + fp); 0 without detections.
    pub fdr: f64,
    /// Precision, tp / (tp + fp); 0 without detections.
    pub precision: f64,
    /// Dice coefficient, 2 tp / (2 tp + fp + fn); 0 if there is neither mark nor detection. For
    /// points it equals F1, the harmonic mean of sensitivity and precision.
    pub dice: f64,
}

impl Rates {
    /// Computes the rates from the numbers of hits, misses and false alarms.
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

/// Largest distance in a pair at the strict reach, as a fraction of the median nearest-neighbour
/// distance of the marks.
///
/// The published reach of 0.75 covers most of the image: marks that are wrong, namely those of an
/// image with x and y exchanged, score a mean Dice coefficient of 0.868 (confocal) and 0.800 (split
/// detector) against the right ones. At the strict reach they score 0.433 and 0.360, and good
/// detections lose little.
pub const STRICT_REACH: f64 = 0.4;

/// Agreement of the detections in one image with hand marks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Score {
    /// Hits, misses, false alarms and their rates.
    #[serde(flatten)]
    pub rates: Rates,
    /// Hits, misses, false alarms and their rates at the strict reach, [`STRICT_REACH`].
    pub strict: Rates,
    /// Localisation error: median distance, in px, between mark and detection over all pairs
    /// outside the border strip of the image; `None` without such pairs.
    pub localisation_px: Option<f64>,
    /// Localisation error as a fraction of the [hexagonal
    /// spacing](crate::mosaic::hexagonal_spacing) of the marks outside the border strip of the
    /// image; `None` without pairs there.
    pub localisation_s: Option<f64>,
    /// Mean displacement from mark to detection, in px to the right and down, over all pairs
    /// outside the border strip of the image; `None` without such pairs. A value far from zero
    /// suggests that marks and detections count pixels from different origins.
    pub offset_px: Option<[f64; 2]>,
    /// Number of marks outside the border strip of the image.
    pub marks_inside: usize,
    /// Number of detections outside the border strip of the image.
    pub detections_inside: usize,
    /// Number of detections divided by number of marks, both outside the border strip of the image:
    /// 1 means equal density. `None` if no mark lies outside the border strip.
    pub density_ratio: Option<f64>,
    /// Area of the image without its border strip, in px².
    pub area_px: f64,
    /// Scale in µm on the retina per pixel; `None` if unknown. [`validate`] leaves the field
    /// `None`; the caller may set it.
    pub um_per_px: Option<f64>,
    /// Number of all marks, also those in the border strip of the image.
    pub n_marks: usize,
    /// Number of all detections, also those in the border strip of the image.
    pub n_detections: usize,
    /// Largest distance allowed in a pair, in px.
    pub limit_px: f64,
    /// Rule that decided between several possible partners of a mark or a detection.
    pub assignment: Assignment,
}

impl Score {
    /// Returns the localisation error in µm; `None` without pairs or scale.
    pub fn localisation_um(&self) -> Option<f64> {
        self.localisation_px.zip(self.um_per_px).map(|(px, um)| px * um)
    }

    /// Returns the area of the image without its border strip, in mm²; `None` without scale.
    pub fn area_mm2(&self) -> Option<f64> {
        self.um_per_px.map(|um| self.area_px * um * um * 1e-6)
    }
}

/// Returns the rates with another largest distance in a pair, `fraction` of the median
/// nearest-neighbour distance of the marks.
pub(super) fn at_reach(
    fraction: f64,
    marks: &[Point],
    detections: &[Point],
    (width, height): (usize, usize),
    options: &MatchOptions,
) -> Result<Rates, MatchError> {
    let options = MatchOptions { fraction, ..*options };
    let m = match_points(marks, detections, width, height, &options)?;
    Ok(Rates::new(m.true_positives(), m.false_negatives(), m.false_positives()))
}

/// Pairs the detections in one image of `width` × `height` px with hand marks, and returns the
/// score and the pairs.
///
/// # Errors
/// Fails under the same conditions as [`match_points`].
///
/// # Examples
/// ```
/// use conemosaic::compare::validate;
/// use conemosaic::prelude::*;
///
/// let place = |i: usize| Point::new((i % 10 * 10 + 5) as f64, (i / 10 * 10 + 5) as f64);
/// let marks: Vec<Point> = (0..100).map(place).collect();
/// let found: Vec<Point> = marks[45..].iter().map(|p| Point::new(p.x + 1., p.y)).collect();
/// let (score, pairs) = validate(&marks, &found, 100, 100, &MatchOptions::default())?;
/// assert_eq!(score.rates.precision, 1.);
/// assert_eq!(score.localisation_px, Some(1.));
/// assert_eq!(pairs.pairs.len(), 55);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
        strict: at_reach(STRICT_REACH, marks, detections, (width, height), options)?,
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
