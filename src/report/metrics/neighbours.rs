use super::MetricGroup::{Nearest, Samplers};
use super::Quantity::{Length, Plain};
use super::{Metric, metric};
use crate::report::tables::EdgeRule::{All, Bound, Interior, Own};
use crate::report::tables::column;

pub(super) const NEAREST: &[Metric] = &[
    metric(
        Nearest,
        Length,
        column("nn_mean", "", "Mean distance to the nearest neighbour; empty for fewer than two points.")
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
            "Standard deviation of these distances, by the divisor that sd_kind names; empty for \
                fewer than two points.",
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
            "Regularity (conformity) index: nn_mean / nn_sd; empty where all distances are equal, \
                as in a lattice.",
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
            "Regularity index of points at least as far from the border as from their nearest \
                neighbour.",
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
            "Number of points at least as far from the border as from their nearest neighbour.",
        )
        .edge(Interior)
        .of(|s| s.stats().nearest_interior.n.into()),
    ),
    metric(
        Nearest,
        Length,
        column("nn_bound_mean", "", "Mean distance to the nearest neighbour of points with bound cells.")
            .edge(Bound)
            .source("Cooper et al. 2016")
            .of(|s| s.stats().nearest_bound.mean.into()),
    ),
    metric(
        Nearest,
        Plain,
        column("nn_bound_ri", "ratio", "Regularity index of points with bound cells.")
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
            "Divisor of the variances of nearest-neighbour distances: sample (n − 1) or population \
                (n).",
        )
        .of(|s| s.stats().deviation.name().into()),
    ),
];

pub(super) const SAMPLERS: &[Metric] = &[
    metric(
        Samplers,
        Plain,
        column(
            "l_infinity_SAMPLER",
            "ratio",
            "Greatest difference of the mosaic's pair correlation function and the mean one of \
                samples of as many points in the same window; one column per sampler. Pairs hidden \
                by the border are made up for by the window's set covariance.",
        )
        .edge(Own)
        .source("Lanaro et al. 2020")
        .per_sampler(|s, name| s.mosaic().distance_to(name).into()),
    ),
    metric(
        Samplers,
        Plain,
        column("closest_sampler", "text", "Sampler with the smallest of these distances.")
            .edge(Own)
            .source("Lanaro et al. 2020")
            .of(|s| s.mosaic().closest_sampler().into()),
    ),
];
