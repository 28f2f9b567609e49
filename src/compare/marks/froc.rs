//! Free-response ROC curves (FROC): sensitivity against false alarms as the threshold of the score
//! falls (Bunch et al. 1978).
//!
//! 1. Within each image, detections are compared with the marks once, from the highest score to the
//!    lowest ([`judge`]).
//! 2. The detections of all images are merged in order of score. At each score that occurs, the
//!    hits and false alarms so far give one point of the curve ([`froc`]).

use super::Rates;
use super::matching::{Field, Index, MOST_CANDIDATES, MatchError, MatchOptions, check, reach};
use crate::geometry::Point;
use serde::Serialize;

/// Outcome of a detection that was compared with the marks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Detection that has a mark of its own; both lie outside the border strip of the image.
    Hit,
    /// Detection outside the border strip of the image that has no mark.
    FalseAlarm,
    /// Detection in the border strip of the image whose mark lies outside the border strip. The
    /// detection is neither hit nor false alarm, and the mark is no miss.
    Excuse,
    /// Detection that changes no count: it lies in the border strip of the image and has no mark,
    /// or its mark lies in the border strip.
    Nothing,
}

/// Detection with its score and outcome.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judged {
    /// Confidence of the detector; the higher, the surer.
    pub score: f64,
    /// Outcome of the comparison with the marks.
    pub verdict: Verdict,
}

/// Outcomes of all detections in one image.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedImage {
    /// Judged detections, from the highest score to the lowest.
    pub judged: Vec<Judged>,
    /// Number of marks outside the border strip of the image.
    pub marks: usize,
    /// Area of the image without its border, in mm²; `None` if the scale is unknown. [`judge`]
    /// leaves the field `None`; the caller may set it.
    pub area_mm2: Option<f64>,
}

/// Decides for each detection of one image of `width` × `height` px whether it is a hit or a false
/// alarm.
///
/// Detections are processed from the highest score to the lowest, equal scores in the order of
/// `detections`. Each detection takes the nearest mark within the cut-off distance that no earlier
/// detection has taken (as in Everingham et al. 2010, International Journal of Computer Vision
/// 88:303, section 4.2, <https://doi.org/10.1007/s11263-009-0275-4>). The outcome of a detection
/// thus depends only on detections before it, so a single pass gives the outcomes for every
/// threshold of the score.
///
/// `scores` has one entry per detection. Cut-off distance and border strip are those of
/// [`match_points`](crate::compare::match_points), but in that function the marks choose the
/// detections. The two functions give different pairs where several marks and detections are near
/// each other.
///
/// # Errors
/// Fails under the same conditions as [`match_points`](crate::compare::match_points).
pub fn judge(
    marks: &[Point],
    detections: &[Point],
    scores: &[f64],
    (width, height): (usize, usize),
    options: &MatchOptions,
) -> Result<JudgedImage, MatchError> {
    options.validate()?;
    check("mark", marks)?;
    check("detection", detections)?;
    let limit = reach(marks, detections, options)?;
    let field = Field::new(width, height, options.border);
    let index = Index::new(marks)?;
    let mut order: Vec<(f64, &Point)> = scores.iter().copied().zip(detections).collect();
    order.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut taken = vec![false; marks.len()];
    let mut judged = Vec::with_capacity(order.len());
    for (score, place) in order {
        let within = index.as_ref().map_or_else(Vec::new, |i| i.within(*place, limit, MOST_CANDIDATES));
        let mark = within.into_iter().map(|(mark, _)| mark).find(|&mark| !taken[mark]);
        if let Some(mark) = mark {
            taken[mark] = true;
        }
        let verdict = match (mark.map(|m| field.is_border(&marks[m])), field.is_border(place)) {
            (Some(false), false) => Verdict::Hit,
            (None, false) => Verdict::FalseAlarm,
            (Some(false), true) => Verdict::Excuse,
            (Some(true), _) | (None, true) => Verdict::Nothing,
        };
        judged.push(Judged { score, verdict });
    }
    let marks = marks.iter().filter(|m| !field.is_border(m)).count();
    Ok(JudgedImage { judged, marks, area_mm2: None })
}

/// Point of a FROC curve: the accuracy of the detections with a score of at least `threshold`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FrocPoint {
    /// Lowest score of a detection that counts at this point.
    pub threshold: f64,
    /// Sensitivity: hits / (hits + misses), all images pooled.
    pub sensitivity: f64,
    /// Precision: hits / (hits + false alarms), all images pooled; 0 if there are no hits and no
    /// false alarms.
    pub precision: f64,
    /// Dice coefficient (F1), 2 hits / (2 hits + misses + false alarms), all images pooled.
    pub dice: f64,
    /// Mean of the images' Dice coefficients.
    pub mean_dice: f64,
    /// Number of false alarms divided by the number of images.
    pub false_alarms_per_image: f64,
    /// False alarms per mm² of retina; `None` unless the scale of every image is known.
    pub false_alarms_per_mm2: Option<f64>,
    /// False alarms per 100 marks; `None` without marks.
    pub false_alarms_per_100_marks: Option<f64>,
}

/// Free-response receiver operating characteristic (FROC; Bunch et al. 1978): sensitivity and false
/// alarms at every threshold of the score.
#[derive(Clone, Debug, PartialEq)]
pub struct Froc {
    /// One point per score that occurs, the highest score first. Sensitivity and number of false
    /// alarms never fall along the list.
    pub points: Vec<FrocPoint>,
    /// Index in `points` of the point with the highest mean Dice coefficient. Among equal points it
    /// is the one with the highest threshold.
    pub best: usize,
}

/// Computes the FROC curve of all images together; `None` without detections.
pub fn froc(images: &[JudgedImage]) -> Option<Froc> {
    let mut events: Vec<(Judged, usize)> =
        images.iter().enumerate().flat_map(|(i, image)| image.judged.iter().map(move |j| (*j, i))).collect();
    events.sort_by(|a, b| b.0.score.total_cmp(&a.0.score));
    let n = images.len() as f64;
    let marks: usize = images.iter().map(|image| image.marks).sum();
    let area = images.iter().map(|image| image.area_mm2).sum::<Option<f64>>().filter(|a| *a > 0.);

    // all images together, and each image alone; before the first detection every mark is a miss
    let mut all = Counts { misses: marks, ..Counts::default() };
    let mut single: Vec<Counts> =
        images.iter().map(|image| Counts { misses: image.marks, ..Counts::default() }).collect();
    let mut points = Vec::new();
    // before its first detection, an image has a Dice coefficient of 0
    let mut sum_of_dice = 0.;
    for (k, (judged, image)) in events.iter().enumerate() {
        all.add(judged.verdict);
        let counts = &mut single[*image];
        sum_of_dice -= counts.rates().dice;
        counts.add(judged.verdict);
        sum_of_dice += counts.rates().dice;
        // detections of equal score share one threshold, so the point comes after the last of them
        if events.get(k + 1).is_some_and(|next| next.0.score == judged.score) {
            continue;
        }
        let rates = all.rates();
        let alarms = rates.fp as f64;
        points.push(FrocPoint {
            threshold: judged.score,
            sensitivity: rates.sensitivity,
            precision: rates.precision,
            dice: rates.dice,
            mean_dice: sum_of_dice / n,
            false_alarms_per_image: alarms / n,
            false_alarms_per_mm2: area.map(|a| alarms / a),
            false_alarms_per_100_marks: (marks > 0).then(|| 100. * alarms / marks as f64),
        });
    }
    let better = |best: usize, k: usize| if points[k].mean_dice > points[best].mean_dice { k } else { best };
    let best = (0..points.len()).reduce(better)?;
    Some(Froc { points, best })
}

/// Running counts of hits and errors as the threshold falls.
#[derive(Clone, Copy, Default)]
struct Counts {
    hits: usize,
    misses: usize,
    false_alarms: usize,
}

impl Counts {
    /// Counts one more detection. The mark of a hit or of an excused detection is no miss any
    /// longer.
    const fn add(&mut self, verdict: Verdict) {
        match verdict {
            Verdict::Hit => self.hits += 1,
            Verdict::FalseAlarm => self.false_alarms += 1,
            Verdict::Excuse | Verdict::Nothing => {}
        }
        if matches!(verdict, Verdict::Hit | Verdict::Excuse) {
            self.misses = self.misses.saturating_sub(1);
        }
    }

    fn rates(self) -> Rates {
        Rates::new(self.hits, self.misses, self.false_alarms)
    }
}

impl Froc {
    /// Returns at most `count` points of the curve, evenly spaced along the list and including the
    /// first, and in addition the last and the best point.
    pub fn thinned(&self, count: usize) -> Vec<FrocPoint> {
        let step = self.points.len().div_ceil(count.max(1));
        let last = self.points.len().saturating_sub(1);
        let kept = |k: &usize| k.is_multiple_of(step) || *k == self.best || *k == last;
        (0..self.points.len()).filter(kept).map(|k| self.points[k]).collect()
    }
}
