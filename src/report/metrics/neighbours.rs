use super::MetricGroup::{Nearest, Samplers};
use super::Quantity::{Length, Plain};
use super::{Metric, metric};
use crate::report::tables::EdgeRule::{All, Bound, Interior, Own};
use crate::report::tables::column;

/// Metrics of the distances to the nearest neighbour.
pub(super) const NEAREST: &[Metric] = &[
    metric(
        Nearest,
        Length,
        column(
            "nn_mean",
            "",
            "Mean distance from a point to its nearest neighbour; empty for fewer than two \
                points.",
        )
        .edge(All)
        .source("Wässle & Riemann 1978")
        .of(|s| s.stats().nearest.mean.into()),
    ),
    metric(
        Nearest,
        Length,
        column(
            "nn_sd",
            "",
            "Standard deviation of the nearest-neighbour distances, with the divisor given in \
                sd_kind; empty for fewer than two points.",
        )
        .edge(All)
        .source("Wässle & Riemann 1978")
        .of(|s| s.stats().nearest.sd.into()),
    ),
    metric(
        Nearest,
        Plain,
        column(
            "ri",
            "ratio",
            "Regularity (conformity) index, nn_mean / nn_sd; empty if all distances are equal, as \
                in a perfect lattice.",
        )
        .edge(All)
        .source("Wässle & Riemann 1978; Cook 1996")
        .of(|s| s.stats().nearest.ri.into()),
    ),
    metric(
        Nearest,
        Plain,
        column(
            "ri_interior",
            "ratio",
            "Regularity index of the interior points, which are at least as far from the border \
                as from their nearest neighbour.",
        )
        .edge(Interior)
        .source("Wässle & Riemann 1978; Cook 1996")
        .of(|s| s.stats().nearest_interior.ri.into()),
    ),
    metric(
        Nearest,
        Plain,
        column(
            "n_interior",
            "count",
            "Number of interior points, which are at least as far from the border as from their \
                nearest neighbour.",
        )
        .edge(Interior)
        .of(|s| s.stats().nearest_interior.n.into()),
    ),
    metric(
        Nearest,
        Length,
        column(
            "nn_bound_mean",
            "",
            "Mean distance to the nearest neighbour over the points whose Voronoi cell is bound.",
        )
        .edge(Bound)
        .source("Cooper et al. 2016")
        .of(|s| s.stats().nearest_bound.mean.into()),
    ),
    metric(
        Nearest,
        Plain,
        column("nn_bound_ri", "ratio", "Regularity index of the points whose Voronoi cell is bound.")
            .edge(Bound)
            .source("Cooper et al. 2016")
            .of(|s| s.stats().nearest_bound.ri.into()),
    ),
    metric(
        Nearest,
        Plain,
        column(
            "sd_kind",
            "text",
            "Divisor in the variance of the nearest-neighbour distances: sample (n − 1) or \
                population (n).",
        )
        .of(|s| s.stats().deviation.name().into()),
    ),
];

/// Metrics of the distance between the mosaic and point samplers.
pub(super) const SAMPLERS: &[Metric] = &[
    metric(
        Samplers,
        Plain,
        column(
            "l_infinity_SAMPLER",
            "ratio",
            "Largest absolute difference between two pair correlation functions: that of the \
                mosaic, and the mean over patterns that the sampler generated with about as many \
                points in a window of about the same shape. There is one column per sampler. Pairs \
                that the border hides are compensated for by the set covariance of the window.",
        )
        .edge(Own)
        .source("Lanaro et al. 2020")
        .per_sampler(|s, name| s.mosaic().distance_to(name).into()),
    ),
    metric(
        Samplers,
        Plain,
        column("closest_sampler", "text", "Sampler with the smallest l_infinity_SAMPLER.")
            .edge(Own)
            .source("Lanaro et al. 2020")
            .of(|s| s.mosaic().closest_sampler().into()),
    ),
];
