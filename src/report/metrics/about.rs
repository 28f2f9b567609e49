use super::MetricGroup::About;
use super::Quantity::Plain;
use super::{Metric, metric};
use crate::report::tables::{Part, column};

pub(super) const FILE: &[Metric] = &[
    metric(About, Plain, column("file", "text", "The file, as given.").of(|s| s.file().into())),
    metric(
        About,
        Plain,
        column("name", "text", "Name under which its results stand.").of(|s| s.name().into()),
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
        column("um_per_px", "µm/px", "Micrometres of retina per pixel of the image; empty if not known.")
            .of(|s| s.mosaic().um_per_px().into()),
    ),
    metric(
        About,
        Plain,
        column(
            "unit",
            "text",
            "Unit of the coordinates (px, um, unit), and of all lengths whose column names none.",
        )
        .of(|s| s.mosaic().unit.symbol().into()),
    ),
    metric(
        About,
        Plain,
        column("um_per_unit", "µm", "Micrometres of retina per unit of the coordinates; empty if not known.")
            .only(Part::Coordinates)
            .of(|s| s.mosaic().um_per_unit.into()),
    ),
    metric(
        About,
        Plain,
        column(
            "um_per_degree",
            "µm/degree",
            "Micrometres of retina per degree of visual angle: 288, or 291 × axial length / 24 mm, \
                or as given.",
        )
        .source("Drasdo & Fowler 1974")
        .of(|s| s.mosaic().um_per_degree.into()),
    ),
    metric(
        About,
        Plain,
        column("modality", "text", "Modality that the image was taken for: confocal, split or histology.")
            .only(Part::Images)
            .of(|s| s.detection().map(|d| d.modality.name()).into()),
    ),
    metric(About, Plain, column("n", "count", "Cones (points) in the window.").of(|s| s.mosaic().n.into())),
    metric(
        About,
        Plain,
        column(
            "outside_window",
            "count",
            "Points of the file outside the window, which are left out; not those that a crop \
                leaves out.",
        )
        .only(Part::Coordinates)
        .of(|s| s.coordinates().map(|r| r.outside).into()),
    ),
    metric(
        About,
        Plain,
        column("warnings", "text", "Remarks that a reader of the numbers needs, separated by semicolons.")
            .of(|s| s.warnings().join("; ").as_str().into()),
    ),
];
