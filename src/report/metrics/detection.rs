use super::MetricGroup::Detection;
use super::Quantity::Plain;
use super::{Metric, metric};
use crate::report::tables::{Part, column};

pub(super) const DETECTION: &[Metric] = &[
    metric(
        Detection,
        Plain,
        column(
            "cones_from",
            "text",
            "Origin of the cones: detected by this program, given (marks from elsewhere), or corrected (found \
             by this program and mended by a person). Columns about the detection are empty for the last two.",
        )
        .only(Part::Images)
        .of(|s| s.image().map(|r| r.cones_from.name()).into()),
    ),
    metric(
        Detection,
        Plain,
        column("detector", "text", "Filters that found the cones: classical or learned.")
            .only(Part::Images)
            .of(|s| s.detection().map(|d| d.detector.name()).into()),
    ),
    metric(
        Detection,
        Plain,
        column(
            "modality_confidence",
            "0–1",
            "Probability that the modality is the true one; 1 if it was given.",
        )
        .only(Part::Images)
        .of(|s| s.detection().map(|d| d.modality_confidence).into()),
    ),
    metric(
        Detection,
        Plain,
        column("polarity", "text", "Sign of the contrast that the cones were taken to have.")
            .only(Part::Images)
            .of(|s| s.detection().map(|d| d.polarity.name()).into()),
    ),
    metric(
        Detection,
        Plain,
        column("expected_false_alarms", "count", "Expected number of cones that are none: sum of 1 − score.")
            .only(Part::Images)
            .of(|s| s.detection().map(|d| d.expected_false_alarms).into()),
    ),
    metric(
        Detection,
        Plain,
        column(
            "expected_misses",
            "count",
            "Expected number of cones among the candidates that were rejected: sum of their \
                scores.",
        )
        .only(Part::Images)
        .of(|s| s.detection().map(|d| d.expected_misses).into()),
    ),
    metric(
        Detection,
        Plain,
        column(
            "expected_error_rate",
            "0–1",
            "Sum of expected_false_alarms and expected_misses over the cones found.",
        )
        .only(Part::Images)
        .of(|s| s.detection().map(|d| d.expected_error_rate()).into()),
    ),
    metric(
        Detection,
        Plain,
        column(
            "spacing_confidence",
            "0–1",
            "Probability that the spacing the detector worked with is within 15 % of the true one.",
        )
        .only(Part::Images)
        .of(|s| s.detection().map(|d| d.spacing_confidence).into()),
    ),
    metric(
        Detection,
        Plain,
        column("spacing_min_px", "px", "Closest spacing the detector worked with, from place to place.")
            .only(Part::Images)
            .of(|s| s.detection().map(|d| d.spacing_range_px[0]).into()),
    ),
    metric(
        Detection,
        Plain,
        column("spacing_max_px", "px", "Widest spacing the detector worked with, from place to place.")
            .only(Part::Images)
            .of(|s| s.detection().map(|d| d.spacing_range_px[1]).into()),
    ),
];
