use super::Held;
use crate::compare::{
    Assignment, Difference, Froc, FrocPoint, GroupSummary, Intraclass, Rates, ReliabilityBin, Score, Summary,
};
use crate::compare::{agreement as agreement_of, agreement_of_clusters};
use crate::report::tables::*;
use crate::report::{Cell, ValidationRow, VersusRow};

fn score(rates: Rates, detections_inside: usize) -> Score {
    Score {
        rates,
        strict: Rates::new(61, 35, 39),
        localisation_px: Some(1.5),
        localisation_s: Some(0.15),
        offset_px: Some([0.25, -0.125]),
        marks_inside: 94,
        detections_inside,
        density_ratio: Some(1.0625),
        area_px: 15_625.,
        um_per_px: Some(0.5),
        n_marks: 120,
        n_detections: 121,
        limit_px: 4.5,
        assignment: Assignment::Nearest,
    }
}

/// Checks the columns of the table of scores against the API.
pub fn validation(held: &mut Held) {
    let first = Rates::new(80, 14, 18);
    let second = Rates::new(70, 24, 8);
    let between = Rates::new(60, 38, 16);
    let strict = Rates::new(61, 35, 39);
    let row = ValidationRow {
        file: "det/a.csv".into(),
        name: "a".into(),
        group: Some("s1".into()),
        score: score(first, 98),
        judged: None,
        expected_false_alarms: Some(12.5),
        turned: None,
        versus: Some(VersusRow { score: score(second, 76), judged: None, between: score(between, 77) }),
    };
    let expected: Vec<(&str, Cell)> = vec![
        ("file", "det/a.csv".into()),
        ("name", "a".into()),
        ("group", "s1".into()),
        ("tp", 80.into()),
        ("fn", 14.into()),
        ("fp", 18.into()),
        ("sensitivity", (80. / 94.).into()),
        ("fdr", (18. / 98.).into()),
        ("precision", (80. / 98.).into()),
        ("dice", (160. / 192.).into()),
        ("sensitivity_strict", strict.sensitivity.into()),
        ("fdr_strict", strict.fdr.into()),
        ("dice_strict", strict.dice.into()),
        ("localisation_px", 1.5.into()),
        ("localisation_um", 0.75.into()),
        ("localisation_s", 0.15.into()),
        ("offset_x_px", 0.25.into()),
        ("offset_y_px", (-0.125).into()),
        ("marks_inside", 94.into()),
        ("detections_inside", 98.into()),
        ("density_ratio", 1.0625.into()),
        ("area_px2", 15_625.0.into()),
        ("um_per_px", 0.5.into()),
        ("expected_false_alarms", 12.5.into()),
        ("n_marks", 120.into()),
        ("n_detections", 121.into()),
        ("limit_px", 4.5.into()),
        ("assignment", "nearest".into()),
        ("versus_dice", second.dice.into()),
        ("versus_sensitivity", second.sensitivity.into()),
        ("versus_fdr", second.fdr.into()),
        ("versus_detections_inside", 76.into()),
        ("between_dice", between.dice.into()),
    ];
    let rows = [row];
    let alone = String::from_utf8(validation_csv(&rows, false).unwrap()).unwrap();
    assert!(alone.lines().next().unwrap().ends_with("limit_px,assignment"));
    held.row(&VALIDATION, validation_csv(&rows, true).unwrap(), expected);

    let group = GroupSummary {
        group: "s1".into(),
        summary: Summary {
            images: 4,
            sensitivity: 0.9,
            fdr: 0.1,
            precision: 0.8,
            dice: 0.85,
            sensitivity_strict: 0.7,
            fdr_strict: 0.3,
            dice_strict: 0.65,
            localisation_px: Some(1.25),
            localisation_um: Some(0.625),
            localisation_s: Some(0.125),
            offset_px: None,
            pooled: first,
            pooled_strict: first,
            count: agreement_of(&[3., 5.]),
            density_percent: agreement_of(&[7., 9.]),
        },
        dice_sd: Some(0.05),
    };
    let expected = vec![
        ("group", "s1".into()),
        ("images", 4.into()),
        ("tp", 80.into()),
        ("fn", 14.into()),
        ("fp", 18.into()),
        ("sensitivity", 0.9.into()),
        ("fdr", 0.1.into()),
        ("precision", 0.8.into()),
        ("dice", 0.85.into()),
        ("dice_strict", 0.65.into()),
        ("dice_sd", 0.05.into()),
        ("pooled_dice", first.dice.into()),
        ("localisation_px", 1.25.into()),
        ("localisation_um", 0.625.into()),
        ("localisation_s", 0.125.into()),
        ("count_bias", 4.0.into()),
        ("density_percent_bias", 8.0.into()),
    ];
    held.row(&SUBJECT_GROUPS, SUBJECT_GROUPS.csv([&group]).unwrap(), expected);
}

/// Checks the columns of the tables of curves over the score against the API.
pub fn curves_of_scores(held: &mut Held) {
    let point = FrocPoint {
        threshold: 0.5,
        sensitivity: 0.9,
        precision: 0.8,
        dice: 0.85,
        mean_dice: 0.84,
        false_alarms_per_image: 12.,
        false_alarms_per_mm2: Some(2000.),
        false_alarms_per_100_marks: Some(11.),
    };
    let expected = vec![
        ("threshold", 0.5.into()),
        ("sensitivity", 0.9.into()),
        ("precision", 0.8.into()),
        ("dice", 0.85.into()),
        ("mean_dice", 0.84.into()),
        ("false_alarms_per_image", 12.0.into()),
        ("false_alarms_per_mm2", 2000.0.into()),
        ("false_alarms_per_100_marks", 11.0.into()),
    ];
    held.row(&FROC, froc_csv(&Froc { points: vec![point], best: 0 }).unwrap(), expected);
    let bin = ReliabilityBin {
        from: 0.3,
        to: 0.4,
        n: 17,
        mean_score: Some(0.35),
        hits: Some(0.375),
        hits_interval: Some([0.2, 0.5]),
    };
    let expected = vec![
        ("score_from", 0.3.into()),
        ("score_to", 0.4.into()),
        ("n", 17.into()),
        ("mean_score", 0.35.into()),
        ("hits", 0.375.into()),
        ("hits_low", 0.2.into()),
        ("hits_high", 0.5.into()),
    ];
    held.row(&RELIABILITY, RELIABILITY.csv([&bin]).unwrap(), expected);
    let difference = Difference {
        measure: "dice",
        images: 8,
        first: 0.9,
        second: 0.85,
        difference: 0.05,
        interval: Some([0.01, 0.09]),
        p: Some(0.03),
        least_p: 0.0078125,
    };
    let expected = vec![
        ("measure", "dice".into()),
        ("images", 8.into()),
        ("first", 0.9.into()),
        ("second", 0.85.into()),
        ("difference", 0.05.into()),
        ("low", 0.01.into()),
        ("high", 0.09.into()),
        ("p", 0.03.into()),
        ("p_least", 0.0078125.into()),
    ];
    held.row(&COMPARISON, COMPARISON.csv([&difference]).unwrap(), expected);
}

/// Checks the columns of the tables of agreement against the API.
pub fn agreement(held: &mut Held) {
    let found = agreement_of_clusters(&[1., 2., 6.], &[vec![0, 1], vec![2]]).unwrap();
    let plain = found.agreement;
    let icc = Intraclass {
        items: 3,
        raters: 2,
        agreement: Some(0.9),
        agreement_interval: Some([0.8, 0.95]),
        consistency: Some(0.91),
        consistency_interval: Some([0.81, 0.96]),
        within_sd: 1.5,
        repeatability: 4.2,
        within_cv_percent: Some(7.5),
    };
    let row = AgreementRow {
        column: "density",
        graders: ["one", "two"],
        n: 3,
        means: Some([13., 10.]),
        agreement: Some(found),
        intraclass: Some(icc),
        grouped: false,
    };
    let [bias_low, bias_high] = found.bias_interval.unwrap();
    let [low, high] = plain.limits.unwrap();
    let [[low_from, low_to], [high_from, high_to]] = found.limit_intervals.unwrap();
    let expected = vec![
        ("column", "density".into()),
        ("first", "one".into()),
        ("second", "two".into()),
        ("n", 3.into()),
        ("mean_first", 13.0.into()),
        ("mean_second", 10.0.into()),
        ("difference", plain.bias.into()),
        ("difference_low", bias_low.into()),
        ("difference_high", bias_high.into()),
        ("sd", plain.sd.into()),
        ("limit_low", low.into()),
        ("limit_low_from", low_from.into()),
        ("limit_low_to", low_to.into()),
        ("limit_high", high.into()),
        ("limit_high_from", high_from.into()),
        ("limit_high_to", high_to.into()),
        ("icc_agreement", 0.9.into()),
        ("icc_agreement_low", 0.8.into()),
        ("icc_agreement_high", 0.95.into()),
        ("icc_consistency", 0.91.into()),
        ("icc_consistency_low", 0.81.into()),
        ("icc_consistency_high", 0.96.into()),
        ("within_sd", 1.5.into()),
        ("repeatability", 4.2.into()),
        ("within_cv_percent", 7.5.into()),
        ("groups", 2.into()),
    ];
    held.row(&AGREEMENT, AGREEMENT.csv([row]).unwrap(), expected);
    let row = DifferenceRow { image: "a", column: "density", graders: ["one", "two"], values: [13., 10.] };
    let expected = vec![
        ("image", "a".into()),
        ("column", "density".into()),
        ("first", "one".into()),
        ("second", "two".into()),
        ("value_first", 13.0.into()),
        ("value_second", 10.0.into()),
        ("mean", 11.5.into()),
        ("difference", 3.0.into()),
    ];
    held.row(&DIFFERENCES, DIFFERENCES.csv([row]).unwrap(), expected);
    let row = UnpairedRow { image: "b", missing_from: "two" };
    let expected = vec![("image", "b".into()), ("missing_from", "two".into())];
    held.row(&UNPAIRED, UNPAIRED.csv([row]).unwrap(), expected);
}

/// Checks the columns of the tables of pairs of channels against the API.
pub fn pairs(held: &mut Held) {
    let pair = ChannelPair {
        name: "f1".into(),
        images: ["c".into(), "s".into()],
        modalities: ["confocal".into(), "split".into()],
        shift: [0.5, -1.25],
        limit_px: 3.5,
        both: 90,
        alone: [10, 5],
        shares: [0.9, 0.95],
        f1: 0.92,
        warnings: vec!["one".into(), "two".into()],
    };
    let expected = vec![
        ("name", "f1".into()),
        ("image_1", "c".into()),
        ("image_2", "s".into()),
        ("modality_1", "confocal".into()),
        ("modality_2", "split".into()),
        ("shift_x_px", 0.5.into()),
        ("shift_y_px", (-1.25).into()),
        ("limit_px", 3.5.into()),
        ("both", 90.into()),
        ("alone_1", 10.into()),
        ("alone_2", 5.into()),
        ("share_1", 0.9.into()),
        ("share_2", 0.95.into()),
        ("f1", 0.92.into()),
        ("warnings", "one; two".into()),
    ];
    held.row(&PAIRS, PAIRS.csv([&pair]).unwrap(), expected);
    let cone = PairedCone { x: 1.5, y: 2.5, seen_in: "both".into(), counted: true };
    let expected =
        vec![("x_px", 1.5.into()), ("y_px", 2.5.into()), ("seen_in", "both".into()), ("counted", 1.into())];
    held.row(&PAIRED_CONES, PAIRED_CONES.csv([&cone]).unwrap(), expected);
}
