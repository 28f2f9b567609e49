use super::MetricGroup::{Orientation, Recovery};
use super::Quantity::{Length, Plain};
use super::{Metric, metric};
use crate::report::tables::EdgeRule::{Bound, Interior, Own};
use crate::report::tables::column;

/// Metrics of the density recovery profile around the average cone.
pub(super) const RECOVERY: &[Metric] = &[
    metric(
        Recovery,
        Length,
        column(
            "recovery_effective_radius",
            "",
            "Effective radius of the density recovery profile: radius of an empty disk that would \
                hold, at the mean density, as many cones as are missing around the average cone. \
                Missing cones are counted up to the first annulus denser than the mean; empty if \
                there is no such annulus, and for fewer than two points. Only the part of each \
                annulus that lies in the window counts as its area.",
        )
        .edge(Own)
        .source("Rodieck 1991")
        .of(|s| s.stats().density_recovery.and_then(|r| r.effective_radius).into()),
    ),
    metric(
        Recovery,
        Plain,
        column(
            "recovery_packing",
            "ratio",
            "Packing factor: squared ratio of the effective radius to that of the triangular \
                lattice of the same density. It is 0 for independent points and 1 for the lattice.",
        )
        .edge(Own)
        .source("Rodieck 1991")
        .of(|s| s.stats().density_recovery.and_then(|r| r.packing).into()),
    ),
    metric(
        Recovery,
        Plain,
        column(
            "recovery_reliability",
            "ratio",
            "Reliability factor of the density recovery profile: density × width of the annuli × \
                √(π × area of the window).",
        )
        .source("Rodieck 1991")
        .of(|s| s.stats().density_recovery.map(|r| r.reliability).into()),
    ),
    metric(
        Recovery,
        Length,
        column(
            "recovery_bin_width",
            "",
            "Width of the annuli of the density recovery profile, chosen so that the reliability \
                factor is 4.",
        )
        .source("Rodieck 1991")
        .of(|s| s.stats().density_recovery.map(|r| r.bin_width).into()),
    ),
];

/// Metrics of the directions of neighbours, and of anisotropy: differences between directions.
pub(super) const ORIENTATION: &[Metric] = &[
    metric(
        Orientation,
        Plain,
        column(
            "nn_axes",
            "count",
            "Number of interior points whose nearest neighbour lies in a defined direction, that \
                is, does not coincide with the point.",
        )
        .edge(Interior)
        .of(|s| s.stats().orientation.axes.into()),
    ),
    metric(
        Orientation,
        Plain,
        column(
            "nn_axis_resultant",
            "0–1",
            "Resultant length of the axes to the nearest neighbours: modulus of the mean of \
                exp(2iθ) over their directions θ. It is 0 if the axes are evenly spread and 1 if \
                they are parallel; chance alone gives about .9/√nn_axes.",
        )
        .edge(Interior)
        .source("Mardia & Jupp 2000")
        .of(|s| s.stats().orientation.resultant.into()),
    ),
    metric(
        Orientation,
        Plain,
        column(
            "nn_axis_deg",
            "degrees, counter-clockwise from the x axis",
            "Mean axis of the directions to the nearest neighbours, 0–180°; empty if \
                nn_axis_resultant is 0.",
        )
        .edge(Interior)
        .source("Mardia & Jupp 2000")
        .of(|s| s.stats().orientation.direction.into()),
    ),
    metric(
        Orientation,
        Plain,
        column(
            "nn_axis_p",
            "0–1",
            "p-value of Rayleigh's test: probability of a resultant at least this long if all \
                directions are equally likely. Points that are linked as nearest neighbours form a \
                group, which counts as one; empty for fewer than 10 groups.",
        )
        .edge(Interior)
        .source("Mardia & Jupp 2000")
        .of(|s| s.stats().orientation.p_value.into()),
    ),
    metric(
        Orientation,
        Plain,
        column(
            "anisotropy",
            "ratio",
            "Ratio of the longer to the shorter semi-axis of the neighbour ellipse, which has the \
                second moments of the vectors to the Delaunay neighbours, averaged over the bound \
                cells. It is 1 without anisotropy, and the stretch factor in a stretched triangular \
                lattice; empty if no cell is bound.",
        )
        .edge(Bound)
        .source("Curcio & Sloan 1992; Cooper et al. 2016")
        .of(|s| s.stats().orientation.ellipse.map(|e| e.anisotropy).into()),
    ),
    metric(
        Orientation,
        Plain,
        column(
            "anisotropy_axis_deg",
            "degrees, counter-clockwise from the x axis",
            "Direction of the longer semi-axis of the neighbour ellipse, 0–180°; empty if both \
                semi-axes are equal.",
        )
        .edge(Bound)
        .source("Curcio & Sloan 1992; Cooper et al. 2016")
        .of(|s| s.stats().orientation.ellipse.and_then(|e| e.direction).into()),
    ),
    metric(
        Orientation,
        Length,
        column(
            "neighbour_ellipse_major",
            "",
            "Longer semi-axis of the neighbour ellipse: √2 × the root mean square component of \
                the vectors along it. In a triangular lattice it is the spacing.",
        )
        .edge(Bound)
        .source("Curcio & Sloan 1992; Cooper et al. 2016")
        .of(|s| s.stats().orientation.ellipse.map(|e| e.major).into()),
    ),
    metric(
        Orientation,
        Length,
        column(
            "neighbour_ellipse_minor",
            "",
            "Shorter semi-axis of the neighbour ellipse: √2 × the root mean square component of \
                the vectors along it.",
        )
        .edge(Bound)
        .source("Curcio & Sloan 1992; Cooper et al. 2016")
        .of(|s| s.stats().orientation.ellipse.map(|e| e.minor).into()),
    ),
    metric(
        Orientation,
        Plain,
        column(
            "hexagon_axis_deg",
            "degrees, counter-clockwise from the x axis",
            "Orientation of the hexagons, 0–60°: phase of the mean ψ6 divided by 6. In a regular \
                mosaic it is the direction of a neighbour; psi6_global says how well the hexagons \
                agree.",
        )
        .edge(Bound)
        .source("Cooper et al. 2016")
        .of(|s| s.stats().orientation.hexagon_direction.into()),
    ),
];
