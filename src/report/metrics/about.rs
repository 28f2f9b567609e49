use super::MetricGroup::About;
use super::Quantity::Plain;
use super::{Metric, metric};
use crate::report::tables::{Part, column};

/// Metrics about the file, its scale and its warnings.
pub(super) const FILE: &[Metric] = &[
    metric(
        About,
        Plain,
        column("file", "text", "Path of the image or coordinate file, as given.").of(|s| s.file().into()),
    ),
    metric(
        About,
        Plain,
        column("name", "text", "Name under which the results of this file are stored.")
            .of(|s| s.name().into()),
    ),
    metric(
        About,
        Plain,
        column("width_px", "px", "Width of the image.")
            .only(Part::Images)
            .of(|s| s.image().map(|r| r.width_px).into()),
    ),
    metric(
        About,
        Plain,
        column("height_px", "px", "Height of the image.")
            .only(Part::Images)
            .of(|s| s.image().map(|r| r.height_px).into()),
    ),
    metric(
        About,
        Plain,
        column(
            "um_per_px",
            "µm/px",
            "Scale in micrometres of retina per pixel of the image; empty if unknown.",
        )
        .of(|s| s.mosaic().um_per_px().into()),
    ),
    metric(
        About,
        Plain,
        column(
            "unit",
            "text",
            "Unit of the coordinates: px, um (micrometres) or unit (the side of the unit square). \
                Lengths whose column name does not end in a unit are in this unit.",
        )
        .of(|s| s.mosaic().unit.symbol().into()),
    ),
    metric(
        About,
        Plain,
        column(
            "um_per_unit",
            "µm",
            "Scale in micrometres of retina per unit of the coordinates; empty if unknown.",
        )
        .only(Part::Coordinates)
        .of(|s| s.mosaic().um_per_unit.into()),
    ),
    metric(
        About,
        Plain,
        column(
            "um_per_degree",
            "µm/degree",
            "Micrometres of retina per degree of visual angle: 288 by default, 291 × axial length \
                / 24 mm where the axial length is given, or the value that was given directly; empty \
                without a scale.",
        )
        .source("Drasdo & Fowler 1974")
        .of(|s| s.mosaic().um_per_degree.into()),
    ),
    metric(
        About,
        Plain,
        column(
            "modality",
            "text",
            "Imaging modality that the detection assumed: confocal, split (split detector) or \
                histology.",
        )
        .only(Part::Images)
        .of(|s| s.detection().map(|d| d.modality.name()).into()),
    ),
    metric(
        About,
        Plain,
        column("n", "count", "Number of cones (points) in the window.").of(|s| s.mosaic().n.into()),
    ),
    metric(
        About,
        Plain,
        column(
            "outside_window",
            "count",
            "Number of points in the file that lie outside the window and are left out. Points \
                removed by a crop are not counted here.",
        )
        .only(Part::Coordinates)
        .of(|s| s.coordinates().map(|r| r.outside).into()),
    ),
    metric(
        About,
        Plain,
        column("warnings", "text", "Warnings about the numbers in this row, separated by semicolons.")
            .of(|s| s.warnings().join("; ").as_str().into()),
    ),
];
