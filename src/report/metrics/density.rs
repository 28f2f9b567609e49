use super::MetricGroup::Density;
use super::{Metric, Quantity, metric};
use crate::report::tables::EdgeRule::{All, Bound};
use crate::report::tables::{Part, column};

/// Metrics of density, and of the spacing of neighbouring cones.
pub(super) const DENSITY: &[Metric] = &[
    metric(
        Density,
        Quantity::Density,
        column("density", "", "Number of cones in the window divided by the area of the window.")
            .edge(All)
            .of(|s| s.stats().density.into()),
    ),
    metric(
        Density,
        Quantity::Density,
        column(
            "density_bound",
            "",
            "Number of bound Voronoi cells divided by their total area; empty if no cell is \
                bound.",
        )
        .edge(Bound)
        .source("Cooper et al. 2016")
        .of(|s| s.stats().voronoi.density.into()),
    ),
    metric(
        Density,
        Quantity::Area,
        column(
            "window_area",
            "",
            "Area of the window, that is, of the region in which cones could have been seen.",
        )
        .of(|s| s.mosaic().window_area.into()),
    ),
    metric(
        Density,
        Quantity::Length,
        column(
            "spacing_ring",
            "",
            "Spacing of neighbouring cones according to Yellott's ring in the power spectrum of \
                the image: 2/√3 × the spacing of the rows of cones.",
        )
        .source("Yellott 1983")
        .only(Part::Images)
        .of(|s| s.detection().map(|d| d.ring_spacing_px).into()),
    ),
    metric(
        Density,
        Quantity::Length,
        column(
            "spacing_density",
            "",
            "Spacing of neighbouring points in the triangular lattice of the same density, \
                √(2/(√3 density)); empty if there are no points.",
        )
        .edge(All)
        .of(|s| s.stats().spacing.into()),
    ),
];
