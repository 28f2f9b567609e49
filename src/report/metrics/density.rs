use super::MetricGroup::Density;
use super::{Metric, Quantity, metric};
use crate::report::tables::EdgeRule::{All, Bound};
use crate::report::tables::{Part, column};

pub(super) const DENSITY: &[Metric] = &[
    metric(
        Density,
        Quantity::Density,
        column("density", "", "Cones in the window over its area.")
            .edge(All)
            .of(|s| s.stats().density.into()),
    ),
    metric(
        Density,
        Quantity::Density,
        column("density_bound", "", "Bound Voronoi cells over their total area; empty without bound cells.")
            .edge(Bound)
            .source("Cooper et al. 2016")
            .of(|s| s.stats().voronoi.density.into()),
    ),
    metric(
        Density,
        Quantity::Area,
        column("window_area", "", "Area in which cones could have been seen.")
            .of(|s| s.mosaic().window_area.into()),
    ),
    metric(
        Density,
        Quantity::Length,
        column(
            "spacing_ring",
            "",
            "Spacing of rows of cones by Yellott's ring in the spectrum of the image, × 2/√3.",
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
            "Distance of neighbours in the triangular lattice of the same density, √(2/(√3 \
                density)); empty without points.",
        )
        .edge(All)
        .of(|s| s.stats().spacing.into()),
    ),
];
