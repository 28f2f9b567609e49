use super::Rates;
use super::matching::{Field, Index, MOST_CANDIDATES, MatchError, MatchOptions, check, reach};
use crate::geometry::Point;
use serde::Serialize;

/// What a detection turned out to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It has a mark of its own.
    Hit,
    /// It has none.
    FalseAlarm,
    /// It lies in the border, its mark does not: neither hit nor false alarm, and the mark is no miss.
    Excuse,
    /// It lies in the border, or its mark does, and nothing follows.
    Nothing,
}

/// A detection, judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judged {
    /// How sure the detector was; more is surer.
    pub score: f64,
    /// What it was.
    pub verdict: Verdict,
}

/// All detections of an image, judged.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedImage {
    /// From the highest score to the lowest.
    pub judged: Vec<Judged>,
    /// Marks outside the border.
    pub marks: usize,
    /// Area outside the border in mm², where the scale is known.
    pub area_mm2: Option<f64>,
}

/// Judges detections from the highest score to the lowest, equal ones in the order given: each takes the nearest mark
/// within reach that is still free (as Everingham et al. 2010, International Journal of Computer Vision 88:303, section
/// 4.2). So what a detection is depends on surer ones only, and one run holds for every threshold. Reach and border
/// are those of [`match_points`](crate::compare::match_points), which lets marks choose instead; the two differ where several
/// marks and detections are within reach of each other.
///
/// # Errors
/// As [`match_points`](crate::compare::match_points).
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

/// How good the detections are that score at least `threshold`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FrocPoint {
    /// Least score of the detections that count.
    pub threshold: f64,
    /// Hits / (hits + misses), all images pooled.
    pub sensitivity: f64,
    /// Hits / (hits + false alarms), all images pooled; 0 without either.
    pub precision: f64,
    /// 2 hits / (2 hits + misses + false alarms), the F1, all images pooled.
    pub dice: f64,
    /// Mean of the images' Dice coefficients.
    pub mean_dice: f64,
    /// False alarms per image.
    pub false_alarms_per_image: f64,
    /// False alarms per mm² of retina, where the scale of every image is known.
    pub false_alarms_per_mm2: Option<f64>,
    /// False alarms per 100 marks.
    pub false_alarms_per_100_marks: Option<f64>,
}

/// Free-response receiver operating characteristic (Bunch et al. 1978): what every threshold of the score makes of
/// sensitivity and false alarms.
#[derive(Clone, Debug, PartialEq)]
pub struct Froc {
    /// One point a score that occurs, the highest first: sensitivity and false alarms never fall.
    pub points: Vec<FrocPoint>,
    /// Index of the point of the highest mean Dice; of several, the one of the highest threshold.
    pub best: usize,
}

/// The curve of all images together; `None` without detections.
pub fn froc(images: &[JudgedImage]) -> Option<Froc> {
    let mut events: Vec<(Judged, usize)> =
        images.iter().enumerate().flat_map(|(i, image)| image.judged.iter().map(move |j| (*j, i))).collect();
    events.sort_by(|a, b| b.0.score.total_cmp(&a.0.score));
    let n = images.len() as f64;
    let marks: usize = images.iter().map(|image| image.marks).sum();
    let area = images.iter().map(|image| image.area_mm2).sum::<Option<f64>>().filter(|a| *a > 0.);

    let mut all = Counts { misses: marks, ..Counts::default() };
    let mut single: Vec<Counts> =
        images.iter().map(|image| Counts { misses: image.marks, ..Counts::default() }).collect();
    let mut points = Vec::new();
    // every image's is 0 before its first detection
    let mut sum_of_dice = 0.;
    for (k, (judged, image)) in events.iter().enumerate() {
        all.add(judged.verdict);
        let counts = &mut single[*image];
        sum_of_dice -= counts.rates().dice;
        counts.add(judged.verdict);
        sum_of_dice += counts.rates().dice;
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

#[derive(Clone, Copy, Default)]
struct Counts {
    hits: usize,
    misses: usize,
    false_alarms: usize,
}

impl Counts {
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
    /// At most about `count` points, evenly along the curve; first, last and best always.
    pub fn thinned(&self, count: usize) -> Vec<FrocPoint> {
        let step = self.points.len().div_ceil(count.max(1));
        let last = self.points.len().saturating_sub(1);
        let kept = |k: &usize| k.is_multiple_of(step) || *k == self.best || *k == last;
        (0..self.points.len()).filter(kept).map(|k| self.points[k]).collect()
    }
}
