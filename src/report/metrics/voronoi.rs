use super::MetricGroup::Voronoi;
use super::Quantity::{Area, Length, Plain};
use super::{Metric, metric};
use crate::report::tables::EdgeRule::{All, Bound};
use crate::report::tables::column;

pub(super) const VORONOI: &[Metric] = &[
    metric(
        Voronoi,
        Plain,
        column("n_bound", "count", "Bound cells: finite, with every vertex strictly inside the window.")
            .edge(Bound)
            .source("Cooper et al. 2016")
            .of(|s| s.stats().voronoi.bound.into()),
    ),
    metric(
        Voronoi,
        Length,
        column(
            "icd_bound_mean",
            "",
            "Inter-cell distance: mean over bound cells of the mean distance to their Delaunay \
                neighbours.",
        )
        .edge(Bound)
        .source("Cooper et al. 2016")
        .of(|s| s.stats().voronoi.inter_cell.mean.into()),
    ),
    metric(
        Voronoi,
        Plain,
        column(
            "icd_bound_ri",
            "ratio",
            "Mean over standard deviation (n − 1) of the inter-cell distances of bound cells.",
        )
        .edge(Bound)
        .source("Cooper et al. 2016")
        .of(|s| s.stats().voronoi.inter_cell.ri.into()),
    ),
    metric(
        Voronoi,
        Length,
        column(
            "furthest_bound_mean",
            "",
            "Mean over bound cells of the distance to their furthest Delaunay neighbour.",
        )
        .edge(Bound)
        .source("Cooper et al. 2016")
        .of(|s| s.stats().voronoi.furthest.mean.into()),
    ),
    metric(
        Voronoi,
        Plain,
        column("furthest_bound_ri", "ratio", "Mean over standard deviation (n − 1) of these distances.")
            .edge(Bound)
            .source("Cooper et al. 2016")
            .of(|s| s.stats().voronoi.furthest.ri.into()),
    ),
    metric(
        Voronoi,
        Length,
        column(
            "icd_all_mean",
            "",
            "Inter-cell distance of all cells. Those at the border have neighbours along the hull \
                that are none: too large.",
        )
        .edge(All)
        .of(|s| s.stats().voronoi.inter_cell_all.mean.into()),
    ),
    metric(
        Voronoi,
        Length,
        column(
            "furthest_all_mean",
            "",
            "Distance to the furthest neighbour of all cells: too large, as icd_all_mean.",
        )
        .edge(All)
        .of(|s| s.stats().voronoi.furthest_all.mean.into()),
    ),
    metric(
        Voronoi,
        Area,
        column("voronoi_area_mean", "", "Mean area of bound cells.")
            .edge(Bound)
            .source("Cooper et al. 2016")
            .of(|s| s.stats().voronoi.area.mean.into()),
    ),
    metric(
        Voronoi,
        Plain,
        column(
            "voronoi_area_cv",
            "ratio",
            "Standard deviation (n − 1) of the areas of bound cells over their mean.",
        )
        .edge(Bound)
        .of(|s| s.stats().voronoi.area_cv.into()),
    ),
    metric(
        Voronoi,
        Plain,
        column(
            "voronoi_area_ri",
            "ratio",
            "Mean of the areas of bound cells over their standard deviation (n − 1).",
        )
        .edge(Bound)
        .source("Cooper et al. 2016")
        .of(|s| s.stats().voronoi.area.ri.into()),
    ),
    metric(
        Voronoi,
        Plain,
        column(
            "voronoi_sides_ri",
            "ratio",
            "Mean number of sides of bound cells over its standard deviation (n − 1); empty if all \
                have six.",
        )
        .edge(Bound)
        .source("Cooper et al. 2016")
        .of(|s| s.stats().voronoi.sides.ri.into()),
    ),
    metric(
        Voronoi,
        Plain,
        column("six_sided_percent", "%", "Share of the bound cells that have six sides.")
            .edge(Bound)
            .source("Curcio & Sloan 1992; Cooper et al. 2016")
            .of(|s| s.stats().voronoi.six_sided_percent.into()),
    ),
    metric(
        Voronoi,
        Plain,
        column(
            "psi6_mean",
            "0–1",
            "Mean modulus of the bond-orientational order ψ6 of bound cells: 1 where every cell is \
                a regular hexagon.",
        )
        .edge(Bound)
        .source("Nelson & Halperin 1979")
        .of(|s| s.stats().voronoi.psi6_mean.into()),
    ),
    metric(
        Voronoi,
        Plain,
        column(
            "psi6_global",
            "0–1",
            "Modulus of the mean ψ6 of bound cells: 1 where all hexagons have one orientation.",
        )
        .edge(Bound)
        .source("Nelson & Halperin 1979")
        .of(|s| s.stats().voronoi.psi6_global.into()),
    ),
];
