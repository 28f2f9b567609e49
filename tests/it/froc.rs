//! The FROC curve over the threshold of the score: properties of any detections, and known values
//! for simple ones.

use conemosaic::compare::{
    Froc, JudgedImage, MatchOptions, Rates, Verdict, froc, judge, match_points, validate,
};
use conemosaic::geometry::Point;
use proptest::prelude::*;

/// Returns 25 marks, 10 px apart on 60 × 60 px, all outside the border of 7 px.
fn grid() -> Vec<Point> {
    (1..6).flat_map(|y| (1..6).map(move |x| Point::new(10. * f64::from(x), 10. * f64::from(y)))).collect()
}

fn judged(marks: &[Point], found: &[Point], scores: &[f64]) -> JudgedImage {
    judge(marks, found, scores, (60, 60), &MatchOptions::default()).unwrap()
}

fn curve(marks: &[Point], found: &[Point], scores: &[f64]) -> Froc {
    froc(&[judged(marks, found, scores)]).unwrap()
}

#[test]
fn thresholds_of_four_detections_give_the_rates_counted_by_hand() {
    let marks = grid();
    // the mark of the second detection is taken, and the next mark is 9.5 px away, beyond the
    // cut-off distance of 7.5 px
    let found = [Point::new(20., 20.), Point::new(20.5, 20.), Point::new(31., 30.), Point::new(40., 41.)];
    let froc = curve(&marks, &found, &[0.9, 0.8, 0.7, 0.7]);
    let rows: Vec<_> = froc
        .points
        .iter()
        .map(|p| (p.threshold, p.sensitivity, p.false_alarms_per_image, p.precision))
        .collect();
    // there are 25 marks; detections of equal score share one threshold
    assert_eq!(rows, [(0.9, 1. / 25., 0., 1.), (0.8, 1. / 25., 1., 0.5), (0.7, 3. / 25., 1., 0.75)]);
    let best = &froc.points[froc.best];
    assert_eq!((best.threshold, best.dice), (0.7, Rates::new(3, 22, 1).dice));
    assert_eq!(best.false_alarms_per_100_marks, Some(4.));
    assert_eq!(best.false_alarms_per_mm2, None);
}

#[test]
fn the_best_threshold_is_where_errors_begin() {
    let marks = grid();
    let wrong = [Point::new(26., 13.4), Point::new(53.5, 51.)];
    let far = wrong.map(|p| Point::new(p.x + 0.1, p.y));
    let found: Vec<Point> = marks.iter().copied().chain(wrong).chain(far).collect();
    let scores: Vec<f64> = (0..found.len()).map(|k| 1. - k as f64 / 100.).collect();
    let froc = curve(&marks, &found, &scores);
    let best = &froc.points[froc.best];
    assert_eq!((best.threshold, best.mean_dice, best.sensitivity), (scores[24], 1., 1.));
    assert!(froc.points.last().unwrap().precision < 1.);
    assert!(froc.thinned(3).iter().any(|p| p.threshold == best.threshold));
}

#[test]
fn pairs_with_a_member_in_the_border_are_neither_hits_nor_errors() {
    let marks = [Point::new(6.4, 30.), Point::new(6.6, 40.), Point::new(30., 30.), Point::new(40., 30.)];
    let found = [Point::new(6.6, 30.), Point::new(6.4, 40.), Point::new(3., 50.), Point::new(30., 30.)];
    let image = judged(&marks, &found, &[4., 3., 2., 1.]);
    let verdicts: Vec<_> = image.judged.iter().map(|j| j.verdict).collect();
    assert_eq!(verdicts, [Verdict::Nothing, Verdict::Excuse, Verdict::Nothing, Verdict::Hit]);
    assert_eq!(image.marks, 3);
    let froc = froc(&[image]).unwrap();
    // of the three marks outside the border strip, one is excused, one is a hit and one is a miss
    let last = froc.points.last().unwrap();
    assert_eq!((last.sensitivity, last.precision), (0.5, 1.));
    let m = match_points(&marks, &found, 60, 60, &MatchOptions::default()).unwrap();
    assert_eq!((m.true_positives(), m.false_negatives(), m.false_positives()), (1, 1, 0));
}

#[test]
fn images_are_pooled_and_areas_added_up() {
    let marks = grid();
    let image = |um: f64| JudgedImage {
        area_mm2: Some(um),
        ..judged(&marks, &[marks[0], Point::new(10.5, 10.)], &[0.9, 0.5])
    };
    let both = froc(&[image(0.25), image(0.75)]).unwrap();
    let last = both.points.last().unwrap();
    assert_eq!((last.false_alarms_per_image, last.false_alarms_per_mm2), (1., Some(2.)));
    let none: Option<Froc> = froc(&[JudgedImage { judged: vec![], marks: 3, area_mm2: None }]);
    assert_eq!(none, None);
}

fn places(n: usize) -> impl Strategy<Value = Vec<Point>> {
    let coordinate = prop_oneof![(0..60i32).prop_map(f64::from), 0f64..60.];
    prop::collection::vec((coordinate.clone(), coordinate).prop_map(|(x, y)| Point::new(x, y)), 0..n)
}

proptest! {
    #[test]
    fn sensitivity_and_false_alarms_never_fall_with_the_threshold(
        images in prop::collection::vec((places(30), places(40)), 1..4), levels in 1u32..40,
    ) {
        let judged: Vec<JudgedImage> = images
            .iter()
            .map(|(marks, found)| {
                let scores: Vec<f64> = (0..found.len() as u32).map(|k| f64::from(k * 7 % levels)).collect();
                judged(marks, found, &scores)
            })
            .collect();
        if let Some(froc) = froc(&judged) {
            prop_assert!(froc.points.is_sorted_by(|a, b| a.threshold > b.threshold));
            prop_assert!(froc.points.is_sorted_by(|a, b| a.sensitivity <= b.sensitivity));
            prop_assert!(froc.points.is_sorted_by(|a, b| a.false_alarms_per_image <= b.false_alarms_per_image));
            let best = froc.points[froc.best].mean_dice;
            prop_assert!(froc.points.iter().all(|p| p.mean_dice <= best && p.mean_dice > -1e-9));
        }
    }

    /// Detections choose marks for the curve, whereas marks choose detections by the published
    /// rule. This makes no difference if no mark has two detections within the cut-off distance and
    /// no detection has two marks.
    #[test]
    fn the_whole_curve_ends_where_the_published_rule_does(
        keep in prop::collection::vec(any::<bool>(), 25), noise in prop::collection::vec(-1f64..1., 50),
        extra in places(1),
    ) {
        let marks = grid();
        let found: Vec<Point> = marks
            .iter()
            .enumerate()
            .filter(|(k, _)| keep[*k])
            .map(|(k, m)| Point::new(m.x + noise[2 * k], m.y + noise[2 * k + 1]))
            .chain(extra)
            .collect();
        let scores: Vec<f64> = (0..found.len()).map(|k| (k * 31 % 17) as f64).collect();
        let (score, _) = validate(&marks, &found, 60, 60, &MatchOptions::default()).unwrap();
        if !found.is_empty() {
            let froc = curve(&marks, &found, &scores);
            let last = froc.points.last().unwrap();
            prop_assert_eq!((last.sensitivity, last.precision), (score.rates.sensitivity, score.rates.precision));
            prop_assert!((last.mean_dice - score.rates.dice).abs() < 1e-12);
        }
    }
}
