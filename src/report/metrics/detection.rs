use super::MetricGroup::Detection;
use super::Quantity::Plain;
use super::{Metric, metric};
use crate::report::tables::{Part, column};

/// Metrics of the detection, for images whose cones this program found.
pub(super) const DETECTION: &[Metric] = &[
    metric(
        Detection,
        Plain,
        column(
            "cones_from",
            "text",
            "Origin of the cones: detected (by this program), given (marks from elsewhere) or \
                corrected (detected by this program and corrected by a person). For given and \
                corrected cones the columns about the detection are empty.",
        )
        .only(Part::Images)
        .of(|s| s.image().map(|r| r.cones_from.name()).into()),
    ),
    metric(
        Detection,
        Plain,
        column(
            "detector",
            "text",
            "Method that found the cones: classical (fixed filters) or learned (neural network).",
        )
        .only(Part::Images)
        .of(|s| s.detection().map(|d| d.detector.name()).into()),
    ),
    metric(
        Detection,
        Plain,
        column("modality_confidence", "0–1", "Probability that modality is correct; 1 if it was given.")
            .only(Part::Images)
            .of(|s| s.detection().map(|d| d.modality_confidence).into()),
    ),
    metric(
        Detection,
        Plain,
        column(
            "polarity",
            "text",
            "Sign of the contrast that the detection assumed: positive (cones brighter than their \
                surroundings; in split-detector images dark on the left and bright on the right) or \
                negative (the reverse).",
        )
        .only(Part::Images)
        .of(|s| s.detection().map(|d| d.polarity.name()).into()),
    ),
    metric(
        Detection,
        Plain,
        column(
            "split_angle",
            "degrees, counter-clockwise from the x axis",
            "Direction of the derivative that a split-detector image shows, set or found: 0 (along x) \
                to below 180, counter-clockwise as seen. With positive polarity, cones become brighter \
                in this direction. Empty for other modalities.",
        )
        .only(Part::Images)
        .of(|s| s.detection().and_then(|d| d.split_angle).into()),
    ),
    metric(
        Detection,
        Plain,
        column(
            "expected_false_alarms",
            "count",
            "Expected number of detections that are not cones: sum of 1 − score over all \
                detections.",
        )
        .only(Part::Images)
        .of(|s| s.detection().map(|d| d.expected_false_alarms).into()),
    ),
    metric(
        Detection,
        Plain,
        column(
            "expected_misses",
            "count",
            "Expected number of cones among the candidates that were rejected: sum of the scores \
                of these candidates.",
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
            "Expected share of errors among the cones detected and missed: sum of \
                expected_false_alarms and expected_misses, divided by the number of detected cones \
                plus expected_misses.",
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
            "Probability that the spacing used by the detector is within 15 % of the true \
                spacing.",
        )
        .only(Part::Images)
        .of(|s| s.detection().map(|d| d.spacing_confidence).into()),
    ),
    metric(
        Detection,
        Plain,
        column("spacing_min_px", "px", "Smallest cone spacing that the detector used anywhere in the image.")
            .only(Part::Images)
            .of(|s| s.detection().map(|d| d.spacing_range_px[0]).into()),
    ),
    metric(
        Detection,
        Plain,
        column("spacing_max_px", "px", "Largest cone spacing that the detector used anywhere in the image.")
            .only(Part::Images)
            .of(|s| s.detection().map(|d| d.spacing_range_px[1]).into()),
    ),
];
