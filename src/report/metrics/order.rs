use super::MetricGroup::{Orientation, Recovery};
use super::Quantity::{Length, Plain};
use super::{Metric, metric};
use crate::report::tables::EdgeRule::{Bound, Interior, Own};
use crate::report::tables::column;

pub(super) const RECOVERY: &[Metric] = &[
    metric(
        Recovery,
        Length,
        column(
            "recovery_effective_radius",
            "",
            "Radius of the empty disk that lacks as many cones as there are too few around the \
                average cone, up to the first annulus above the mean density; empty if there is \
                none, and for fewer than two points. Annuli are corrected by the share of them \
                that lies in the window.",
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
            "Packing factor: square of the effective radius over that of the triangular lattice of \
                the same density; 0 for independent points, 1 for the lattice.",
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
            "Reliability factor: density × width of the annuli × √(π area).",
        )
        .source("Rodieck 1991")
        .of(|s| s.stats().density_recovery.map(|r| r.reliability).into()),
    ),
    metric(
        Recovery,
        Length,
        column("recovery_bin_width", "", "Width of the annuli: such that the reliability factor is 4.")
            .source("Rodieck 1991")
            .of(|s| s.stats().density_recovery.map(|r| r.bin_width).into()),
    ),
];

pub(super) const ORIENTATION: &[Metric] = &[
    metric(
        Orientation,
        Plain,
        column(
            "nn_axes",
            "count",
            "Interior points whose nearest neighbour has a direction (does not coincide with them).",
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
            "Length of the mean of exp(2iθ), θ the directions of nearest neighbours: 0 if they are \
                spread evenly, 1 if parallel; by chance about .9/√nn_axes.",
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
            "Mean axis of the nearest neighbours, 0–180; empty where the resultant is 0.",
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
            "Chance of such a resultant where all directions are alike (Rayleigh's test; points \
                linked as nearest neighbours count as one); empty for fewer than 10 of these \
                groups.",
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
            "Longer over shorter half axis of the ellipse with the second moments of the ways to \
                Delaunay neighbours, mean over bound cells: 1 for none, the stretch of a stretched \
                triangular lattice; empty without bound cells.",
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
            "Direction of the longer half axis of that ellipse, 0–180; empty where both are equal.",
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
            "Longer half axis of that ellipse, √2 × the root mean square along it: the spacing of a triangular \
                lattice.",
        )
        .edge(Bound)
        .source("Curcio & Sloan 1992; Cooper et al. 2016")
        .of(|s| s.stats().orientation.ellipse.map(|e| e.major).into()),
    ),
    metric(
        Orientation,
        Length,
        column("neighbour_ellipse_minor", "", "Shorter half axis of that ellipse.")
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
            "Phase of the mean ψ6 over 6, 0–60: direction of a neighbour in a regular mosaic; \
                psi6_global says how far the hexagons agree.",
        )
        .edge(Bound)
        .source("Cooper et al. 2016")
        .of(|s| s.stats().orientation.hexagon_direction.into()),
    ),
];
