use super::MetricGroup::Voronoi;
use super::Quantity::{Area, Length, Plain};
use super::{Metric, metric};
use crate::report::tables::EdgeRule::{All, Bound};
use crate::report::tables::column;

/// Metrics of Voronoi cells and Delaunay neighbours.
pub(super) const VORONOI: &[Metric] = &[
    metric(
        Voronoi,
        Plain,
        column(
            "n_bound",
            "count",
            "Number of bound Voronoi cells, which are finite and have every vertex strictly \
                inside the window.",
        )
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
            "Mean inter-cell distance of the bound cells. The inter-cell distance of a cell is \
                the mean distance to its Delaunay neighbours.",
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
            "Regularity index of the inter-cell distances of the bound cells: mean divided by \
                standard deviation (divisor n − 1).",
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
            "Mean over the bound cells of the distance to the furthest Delaunay neighbour.",
        )
        .edge(Bound)
        .source("Cooper et al. 2016")
        .of(|s| s.stats().voronoi.furthest.mean.into()),
    ),
    metric(
        Voronoi,
        Plain,
        column(
            "furthest_bound_ri",
            "ratio",
            "Regularity index of the distances from bound cells to their furthest Delaunay \
                neighbour: mean divided by standard deviation (divisor n − 1).",
        )
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
            "Mean inter-cell distance of all cells. The value is too large, because cells at the \
                border are linked along the convex hull to cells that are not true neighbours.",
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
            "Mean over all cells of the distance to the furthest Delaunay neighbour. The value is \
                too large, for the same reason as icd_all_mean.",
        )
        .edge(All)
        .of(|s| s.stats().voronoi.furthest_all.mean.into()),
    ),
    metric(
        Voronoi,
        Area,
        column("voronoi_area_mean", "", "Mean area of the bound Voronoi cells.")
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
            "Coefficient of variation of the areas of the bound Voronoi cells: standard deviation \
                (divisor n − 1) divided by mean.",
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
            "Regularity index of the areas of the bound Voronoi cells: mean divided by standard \
                deviation (divisor n − 1).",
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
            "Regularity index of the numbers of sides of the bound Voronoi cells: mean divided by \
                standard deviation (divisor n − 1); empty if all have the same number, for example \
                six.",
        )
        .edge(Bound)
        .source("Cooper et al. 2016")
        .of(|s| s.stats().voronoi.sides.ri.into()),
    ),
    metric(
        Voronoi,
        Plain,
        column("six_sided_percent", "%", "Percentage of the bound Voronoi cells that have six sides.")
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
            "Mean over the bound cells of the modulus of the bond-orientational order parameter \
                ψ6: 1 if every cell is a regular hexagon.",
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
            "Modulus of the mean of ψ6 over the bound cells: 1 if all cells are regular hexagons \
                of the same orientation.",
        )
        .edge(Bound)
        .source("Nelson & Halperin 1979")
        .of(|s| s.stats().voronoi.psi6_global.into()),
    ),
];
