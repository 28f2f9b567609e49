//! The scoring rule, compared with an independent program, and properties that any pairing must
//! have.

use conemosaic::compare::{
    Assignment, MatchError, MatchOptions, Score, by_group, compare_scores, intervals, match_points,
    mean_over_groups, summarise, validate,
};
use conemosaic::geometry::Point;
use conemosaic::mosaic::io::{Origin, ReadOptions, read_coordinates};
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::path::Path;
use strum::VariantArray;

/// Generator of random numbers in [0, 1). The numbers are multiples of 2⁻²⁰, so that every program
/// can make exactly the same point sets.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 44) as f64 / f64::from(1 << 20)
    }
    fn around_zero(&mut self) -> f64 {
        2. * self.next() - 1.
    }
}

/// Returns rows of marks `step` apart.
///
/// Every other row is moved by half a step. Each mark is moved at random by up to `jitter` along x
/// and along y; the number for x is drawn first. With `integer`, coordinates are rounded to whole
/// pixels, halves upwards.
fn marks(seed: u64, w: f64, h: f64, step: f64, jitter: f64, integer: bool) -> Vec<Point> {
    let mut numbers = Numbers(seed);
    let mut points = Vec::new();
    for row in 0..(h / step).floor() as u32 {
        for column in 0..(w / step).floor() as u32 {
            let x = (f64::from(column) + 0.5 * f64::from(row % 2)) * step + jitter * numbers.around_zero();
            let y = f64::from(row) * step + jitter * numbers.around_zero();
            let round = |v: f64| if integer { (v + 0.5).floor() } else { v };
            points.push(Point::new(round(x), round(y)));
        }
    }
    points
}

/// Returns detections: each mark with the probability `keep`, moved by up to `noise` along x and
/// along y, and then `extra` points anywhere in the image of `w` × `h` px.
///
/// Three numbers are drawn per mark: for `keep`, x and y.
fn detections(seed: u64, marks: &[Point], w: f64, h: f64, keep: f64, noise: f64, extra: usize) -> Vec<Point> {
    let mut numbers = Numbers(seed);
    let mut points = Vec::new();
    for mark in marks {
        let kept = numbers.next() < keep;
        let p = Point::new(mark.x + noise * numbers.around_zero(), mark.y + noise * numbers.around_zero());
        if kept {
            points.push(p);
        }
    }
    for _ in 0..extra {
        points.push(Point::new(numbers.next() * w, numbers.next() * h));
    }
    points
}

/// Test case: seed, width, height, step, jitter, integer, keep, noise and extra of the functions
/// above; then the numbers of hits, misses and false alarms by `match` in
/// `../shared/tools/score.py`. The points were passed to `match` with 1 added to the coordinates,
/// because it counts pixels from 1.
///
/// To make the numbers again, write the two functions above in Python (the seed of detections is
/// seed + 100) and call `match` and `summary`.
type Case = (u64, usize, usize, f64, f64, bool, f64, f64, usize, [usize; 3]);
/// Test cases with the numbers of the independent program.
const TRUTH: [Case; 7] = [
    (1, 150, 150, 8., 2., false, 0.95, 1.5, 10, [267, 12, 8]),
    (2, 150, 120, 8., 2., true, 0.9, 3., 30, [198, 25, 26]),
    (3, 200, 200, 6., 3., false, 0.7, 6., 200, [411, 542, 445]),
    (4, 64, 64, 16., 4., false, 1., 0., 0, [10, 0, 0]),
    (5, 100, 100, 10., 10., true, 0.8, 8., 50, [33, 39, 70]),
    (6, 100, 100, 10., 2., false, 0., 1., 0, [0, 76, 0]),
    (7, 40, 30, 3., 1., true, 1., 2., 300, [43, 2, 108]),
];
/// Mean sensitivity, false discovery rate and Dice coefficient over the cases of [`TRUTH`], by
/// `summary` in `../shared/tools/score.py`.
const TRUTH_MEANS: [f64; 3] = [0.6700057410848241, 0.29426651275876525, 0.5885882882547954];

fn case(case: &Case) -> (Vec<Point>, Vec<Point>, usize, usize) {
    let &(seed, width, height, step, jitter, integer, keep, noise, extra, _) = case;
    let (w, h) = (width as f64, height as f64);
    let marks = marks(seed, w, h, step, jitter, integer);
    let detections = detections(seed + 100, &marks, w, h, keep, noise, extra);
    (marks, detections, width, height)
}

fn options(assignment: Assignment) -> MatchOptions {
    MatchOptions { assignment, ..MatchOptions::default() }
}

#[test]
fn counts_and_means_equal_those_of_the_published_rule() {
    let mut scores = Vec::new();
    for truth in &TRUTH {
        let (marks, detections, w, h) = case(truth);
        let (score, _) = validate(&marks, &detections, w, h, &MatchOptions::default()).unwrap();
        assert_eq!([score.rates.tp, score.rates.fn_, score.rates.fp], truth.9, "seed {}", truth.0);
        scores.push(score);
    }
    let summary = summarise(&scores).unwrap();
    for (ours, truth) in [summary.sensitivity, summary.fdr, summary.dice].into_iter().zip(TRUTH_MEANS) {
        assert!((ours - truth).abs() < 1e-12, "{ours} instead of {truth}");
    }
    assert_eq!(summary.pooled.tp, TRUTH.iter().map(|t| t.9[0]).sum::<usize>());
}

/// Hand marks of real images serve as detections too: every eleventh is left out and the others are
/// moved by up to 2 px. The expected totals are those of `../shared/tools/score.py`.
#[test]
fn counts_on_real_marks_equal_those_of_the_published_rule() {
    for (folder, images, [tp, fn_, fp], [sensitivity, fdr, dice]) in [
        ("confocal", 200, [41224, 4202, 3], [0.9075720152128358, 5.952443441617181e-05, 0.9515056095544862]),
        ("split", 184, [21803, 2286, 2], [0.9043777621402135, 1.5961182404392516e-05, 0.949764683073787]),
    ] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/aoslo").join(folder);
        let Ok(files) = std::fs::read_dir(&folder) else {
            println!("SKIPPED scoring of real marks: ../shared is not here");
            return;
        };
        let names = files.map(|f| f.unwrap().file_name().into_string().unwrap());
        let read_options = ReadOptions { origin: Some(Origin::One), ..ReadOptions::default() };
        let scores: Vec<Score> = names
            .filter_map(|name| name.strip_suffix(".png").map(str::to_owned))
            .map(|name| {
                let (w, h) = image::image_dimensions(folder.join(format!("{name}.png"))).unwrap();
                let file = folder.join(format!("{name}_coords.csv"));
                let marks = read_coordinates(&file, &read_options).unwrap().points;
                let step = |i: usize, factor: usize| ((i * factor % 64) as f64 - 32.) / 16.;
                let kept = marks.iter().enumerate().filter(|(i, _)| i % 11 != 0);
                let found: Vec<_> =
                    kept.map(|(i, m)| Point::new(m.x + step(i, 37), m.y + step(i, 53))).collect();
                validate(&marks, &found, w as usize, h as usize, &MatchOptions::default()).unwrap().0
            })
            .collect();
        let summary = summarise(&scores).unwrap();
        assert_eq!(summary.images, images);
        assert_eq!([summary.pooled.tp, summary.pooled.fn_, summary.pooled.fp], [tp, fn_, fp]);
        for (ours, truth) in [(summary.sensitivity, sensitivity), (summary.fdr, fdr), (summary.dice, dice)] {
            assert!((ours - truth).abs() < 1e-12, "{ours} instead of {truth}");
        }
    }
}

#[test]
fn perfect_detections_score_one() {
    let marks = marks(11, 150., 150., 8., 2., false);
    for &assignment in Assignment::VARIANTS {
        let (score, matching) = validate(&marks, &marks, 150, 150, &options(assignment)).unwrap();
        let rates = &score.rates;
        assert_eq!((rates.sensitivity, rates.fdr, rates.dice, rates.precision), (1., 0., 1., 1.));
        assert_eq!(score.offset_px, Some([0., 0.]));
        assert_eq!((score.localisation_px, score.density_ratio), (Some(0.), Some(1.)));
        assert_eq!(matching.pairs.len(), marks.len());
        assert!(matching.pairs.iter().all(|p| p.mark == p.detection));
    }
}

#[test]
fn a_second_detection_within_reach_is_used_by_optimal_assignment_only() {
    // the detection between the first two marks is the nearest for both; a second detection is
    // within the cut-off distance of the second mark
    let marks = [Point::new(20., 20.), Point::new(24., 20.), Point::new(40., 40.), Point::new(44., 40.)];
    let detections =
        [Point::new(21.9, 20.), Point::new(26.5, 20.), Point::new(40., 40.), Point::new(44., 40.)];
    let count = |assignment| {
        let m = match_points(&marks, &detections, 60, 60, &options(assignment)).unwrap();
        assert_eq!(m.limit, 3.);
        (m.true_positives(), m.false_negatives(), m.false_positives())
    };
    assert_eq!(count(Assignment::Nearest), (3, 1, 1));
    assert_eq!(count(Assignment::Optimal), (4, 0, 0));
}

#[test]
fn seven_whole_pixels_at_each_edge_are_not_counted() {
    // of 100 pixels, 0 to 6 and 93 to 99 are the border strip; there is one mark, on the diagonal,
    // and no detection
    for (pixel, counted) in [(6., 0), (7., 1), (92., 1), (93., 0)] {
        let pair = [Point::new(pixel, pixel), Point::new(50., 50.)];
        let m = match_points(&pair, &[], 100, 100, &MatchOptions::default()).unwrap();
        assert_eq!(m.false_negatives(), 1 + counted, "pixel {pixel}");
        // a pair of which one point lies in the border strip is neither hit nor miss nor false
        // alarm
        let found = [Point::new(pixel + 0.1, pixel), Point::new(50., 50.)];
        let m = match_points(&pair, &found, 100, 100, &MatchOptions::default()).unwrap();
        assert_eq!((m.true_positives(), m.false_negatives(), m.false_positives()), (1 + counted, 0, 0));
    }
}

#[test]
fn too_few_points_for_a_neighbour_distance_still_have_a_limit() {
    let (a, b, c) = (Point::new(50., 50.), Point::new(52., 50.), Point::new(62., 50.));
    let limit = |marks: &[Point], found: &[Point]| {
        let (score, m) = validate(marks, found, 100, 100, &MatchOptions::default()).unwrap();
        (m.limit, score.rates.tp, score.rates.fn_, score.rates.fp)
    };
    assert_eq!(limit(&[a], &[b, c]), (7.5, 1, 0, 1));
    assert_eq!(limit(&[a], &[b]), (7., 1, 0, 0));
    assert_eq!(limit(&[a], &[c]), (7., 0, 1, 1));
    assert_eq!(limit(&[], &[b, c]), (7.5, 0, 0, 2));
    assert_eq!(limit(&[a, b], &[]), (1.5, 0, 2, 0));
    assert_eq!(limit(&[], &[]), (7., 0, 0, 0));
    assert!(summarise(&[]).is_none());
}

#[test]
fn coordinates_and_options_out_of_range_are_refused() {
    let (good, bad) = ([Point::new(1., 1.)], [Point::new(1., f64::NAN)]);
    let default = MatchOptions::default();
    assert!(matches!(
        match_points(&bad, &good, 9, 9, &default),
        Err(MatchError::Coordinate { what: "mark", .. })
    ));
    assert!(match_points(&good, &[Point::new(1e300, 0.)], 9, 9, &default).is_err());
    assert!(match_points(&good, &good, 9, 9, &MatchOptions { border: -1., ..default }).is_err());
    assert!(match_points(&good, &good, 9, 9, &MatchOptions { fraction: 0., ..default }).is_err());
}

#[test]
fn agreement_is_of_counts_and_of_densities_outside_the_border() {
    let marks = marks(12, 150., 150., 8., 1., false);
    let more = detections(13, &marks, 150., 150., 1., 0., 40);
    let fewer = detections(14, &marks, 150., 150., 0.8, 0., 0);
    let score = |found: &[Point]| validate(&marks, found, 150, 150, &MatchOptions::default()).unwrap().0;
    let scores = [score(&more), score(&fewer)];
    let counts = scores.map(|s| s.detections_inside as f64 - s.marks_inside as f64);
    assert!(counts[0] > 0. && counts[1] < 0.);
    let summary = summarise(&scores).unwrap();
    let [low, high] = summary.count.unwrap().limits.unwrap();
    assert!((summary.count.unwrap().bias - (counts[0] + counts[1]) / 2.).abs() < 1e-12);
    // the standard deviation of two values is their difference divided by √2
    assert!((high - low - 2. * 1.96 * (counts[0] - counts[1]) / 2f64.sqrt()).abs() < 1e-9);
    let percent = |s: &Score| {
        let (d, m) = (s.detections_inside as f64, s.marks_inside as f64);
        200. * (d - m) / (d + m)
    };
    let expected = (percent(&scores[0]) + percent(&scores[1])) / 2.;
    assert!((summary.density_percent.unwrap().bias - expected).abs() < 1e-12);
}

#[test]
fn a_systematic_shift_is_measured_with_its_direction() {
    let marks = marks(12, 150., 150., 8., 1., false);
    let shifted: Vec<Point> = marks.iter().map(|p| Point::new(p.x - 1., p.y + 0.5)).collect();
    let (score, _) = validate(&marks, &shifted, 150, 150, &MatchOptions::default()).unwrap();
    let [x, y] = score.offset_px.unwrap();
    assert!((x + 1.).abs() < 1e-9 && (y - 0.5).abs() < 1e-9);
    let scaled = Score { um_per_px: Some(0.4), ..score };
    assert!((scaled.localisation_um().unwrap() - 0.4 * 1.25f64.sqrt()).abs() < 1e-9);
    assert!((scaled.area_mm2().unwrap() - 136. * 136. * 0.16e-6).abs() < 1e-12);
    assert_eq!(score.localisation_um(), None);
}

fn scores_of(keep: &[f64]) -> Vec<Score> {
    let marks = marks(12, 150., 150., 8., 1., false);
    let one = |(k, keep): (usize, &f64)| {
        let found = detections(30 + k as u64, &marks, 150., 150., *keep, 1., 10);
        validate(&marks, &found, 150, 150, &MatchOptions::default()).unwrap().0
    };
    keep.iter().enumerate().map(one).collect()
}

#[test]
fn intervals_hold_their_means_and_agreement_of_single_images_is_in_closed_form() {
    let scores = scores_of(&[0.7, 0.75, 0.8, 0.85, 0.9, 0.95]);
    let summary = summarise(&scores).unwrap();
    let singles: Vec<Vec<usize>> = (0..6).map(|i| vec![i]).collect();
    let of = |clusters: &[Vec<usize>], seed| {
        intervals(&scores, clusters, 2000, &mut ChaCha8Rng::seed_from_u64(seed))
    };
    let found = of(&singles, 1);
    for (name, value) in [("dice", summary.dice), ("pooled.dice", summary.pooled.dice), ("fdr", summary.fdr)]
    {
        let [low, high] = found[name];
        assert!(low < value && value < high, "{name}: {low} {value} {high}");
    }
    assert_eq!(Some(found["count.bias"]), summary.count.unwrap().bias_interval());
    assert_eq!(found, of(&singles, 1), "the same seed gives the same intervals");
    assert_ne!(found, of(&singles, 2));
    assert!(of(&[(0..6).collect()], 1).is_empty(), "one subject has no interval");
    let pairs = of(&[vec![0, 1], vec![2, 3], vec![4, 5]], 1);
    assert_ne!(pairs["count.bias"], found["count.bias"]);
}

#[test]
fn groups_count_once_each_and_their_mean_is_no_mean_over_images() {
    let scores = scores_of(&[0.6, 0.9, 0.9, 0.9]);
    let names = [Some("b"), Some("a"), Some("a"), Some("a")];
    let groups = by_group(&names, &scores);
    assert_eq!(
        groups.iter().map(|g| (g.group.as_str(), g.summary.images)).collect::<Vec<_>>(),
        [("a", 3), ("b", 1)]
    );
    assert_eq!(groups[1].dice_sd, None);
    let over = mean_over_groups(&groups).unwrap();
    let dice = scores.iter().map(|s| s.rates.dice).collect::<Vec<_>>();
    let expected = ((dice[1] + dice[2] + dice[3]) / 3. + dice[0]) / 2.;
    assert!((over.dice - expected).abs() < 1e-12);
    assert!(by_group(&[None; 4], &scores).is_empty());
}

#[test]
fn a_detector_compared_with_itself_does_not_differ_and_a_better_one_does() {
    let (good, bad) = (scores_of(&[0.95; 8]), scores_of(&[0.6; 8]));
    let singles: Vec<Vec<usize>> = (0..8).map(|i| vec![i]).collect();
    let of = |a: &[Score], b: &[Score]| compare_scores(a, b, &singles, 2000, &ChaCha8Rng::seed_from_u64(1));
    for same in of(&good, &good) {
        assert_eq!(
            (same.difference, same.interval, same.p),
            (0., Some([0., 0.]), Some(1.)),
            "{}",
            same.measure
        );
    }
    let dice = &of(&good, &bad)[0];
    assert_eq!((dice.measure, dice.images), ("dice", 8));
    assert!((dice.difference - (dice.first - dice.second)).abs() < 1e-12 && dice.interval.unwrap()[0] > 0.);
    // all eight differences have the same sign
    assert_eq!(dice.p, Some(2. / 256.));
}

#[test]
fn optimal_assignment_of_many_cones_is_quick() {
    let side = 2600.;
    let marks = marks(15, side, side, 8., 2., false);
    let found = detections(16, &marks, side, side, 0.95, 4., 5000);
    assert!(marks.len() > 100_000);
    let start = std::time::Instant::now();
    let m = match_points(&marks, &found, 2600, 2600, &options(Assignment::Optimal)).unwrap();
    let seconds = start.elapsed().as_secs_f64();
    println!("{} marks, {} detections, {} pairs: {seconds:.2} s", marks.len(), found.len(), m.pairs.len());
    assert!(m.pairs.len() > 90_000);
    // a method of quadratic time would need minutes; this one stays below the limit even in an
    // unoptimised build on a busy machine
    assert!(seconds < 60., "{seconds} s");
}

fn places(n: usize) -> impl Strategy<Value = Vec<Point>> {
    // integer coordinates make equal distances and coincident points likely
    let coordinate = prop_oneof![(0..40i32).prop_map(f64::from), 0f64..40.];
    prop::collection::vec((coordinate.clone(), coordinate).prop_map(|(x, y)| Point::new(x, y)), 0..n)
}

proptest! {
    #[test]
    fn pairs_are_one_to_one_and_everything_outside_the_border_counts_once(
        marks in places(40), found in places(40), border in 0f64..8.,
    ) {
        for &assignment in Assignment::VARIANTS {
            let options = MatchOptions { border, assignment, ..MatchOptions::default() };
            let m = match_points(&marks, &found, 40, 40, &options).unwrap();
            let mut used = vec![0; found.len()];
            for pair in &m.pairs {
                used[pair.detection] += 1;
                prop_assert!(pair.distance <= m.limit);
            }
            prop_assert!(used.iter().all(|&n| n <= 1));
            prop_assert!(m.pairs.is_sorted_by(|a, b| a.mark < b.mark));
            let lost = m.pairs.iter().filter(|p| !p.counted && !m.marks_in_border[p.mark]).count();
            let inside = m.marks_in_border.iter().filter(|b| !**b).count();
            prop_assert_eq!(m.true_positives() + m.false_negatives() + lost, inside);
        }
    }

    #[test]
    fn optimal_assignment_never_has_fewer_pairs(marks in places(60), found in places(60)) {
        let pairs = |assignment| match_points(&marks, &found, 40, 40, &options(assignment)).unwrap().pairs;
        let (nearest, optimal) = (pairs(Assignment::Nearest), pairs(Assignment::Optimal));
        prop_assert!(optimal.len() >= nearest.len());
        if optimal.len() == nearest.len() {
            let sum = |pairs: &[conemosaic::compare::Pair]| pairs.iter().map(|p| p.distance).sum::<f64>();
            prop_assert!(sum(&optimal) <= sum(&nearest) + 1e-9);
        }
    }

    #[test]
    fn no_coordinates_make_it_panic(
        marks in prop::collection::vec(any::<(f64, f64)>(), 0..6),
        found in prop::collection::vec(any::<(f64, f64)>(), 0..6),
        scale in prop_oneof![Just(1.), Just(1e-300), Just(1e-302)],
    ) {
        let points = |v: Vec<(f64, f64)>| v.iter().map(|p| Point::new(p.0 * scale, p.1 * scale)).collect::<Vec<_>>();
        let (marks, found) = (points(marks), points(found));
        for &assignment in Assignment::VARIANTS {
            let _ = validate(&marks, &found, 3, 3, &options(assignment));
        }
    }
}
