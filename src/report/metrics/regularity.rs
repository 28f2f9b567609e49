use super::MetricGroup::{Evenness, Regularity};
use super::Quantity::Plain;
use super::{Metric, metric};
use crate::report::tables::EdgeRule::{All, Own};
use crate::report::tables::column;

pub(super) const REGULARITY: &[Metric] = &[
    metric(
        Regularity,
        Plain,
        column(
            "clark_evans_naive",
            "ratio",
            "nn_mean over that of independent points of the same density, 1/(2√density): 1 for \
                those, 2.149 for the triangular lattice; empty for fewer than two points.",
        )
        .edge(All)
        .source("Clark & Evans 1954")
        .of(|s| s.stats().clark_evans.naive.into()),
    ),
    metric(
        Regularity,
        Plain,
        column(
            "clark_evans_donnelly",
            "ratio",
            "Clark–Evans index with the expectation corrected for the border by its length; empty on a \
                torus.",
        )
        .edge(Own)
        .source("Donnelly 1978")
        .of(|s| s.stats().clark_evans.donnelly.into()),
    ),
    metric(
        Regularity,
        Plain,
        column(
            "clark_evans_cdf",
            "ratio",
            "Clark–Evans index with the mean taken from the Kaplan–Meier estimate of the distribution of \
                the distances.",
        )
        .edge(Own)
        .source("Baddeley, Rubak & Turner 2015")
        .of(|s| s.stats().clark_evans.cdf.into()),
    ),
];

pub(super) const EVENNESS: &[Metric] = &[
    metric(
        Evenness,
        Plain,
        column(
            "trend_p",
            "0–1",
            "Chance of a trend this strong in a pattern whose density varies by 10 %; below .01 \
                there is a warning; empty for fewer than 20 points.",
        )
        .of(|s| s.stats().trend.p_value.into()),
    ),
    metric(
        Evenness,
        Plain,
        column(
            "density_variation",
            "ratio",
            "Size of the slow variation of density as a share of its mean: √12 times its root mean \
                square, which of a linear gradient is the difference between opposite edges; \
                chance is taken off.",
        )
        .of(|s| s.stats().trend.variation.into()),
    ),
    metric(
        Evenness,
        Plain,
        column("density_variation_low", "ratio", "Lower end of the 98 % interval of density_variation.")
            .of(|s| s.stats().trend.variation_interval.map(|i| i.0).into()),
    ),
    metric(
        Evenness,
        Plain,
        column("density_variation_high", "ratio", "Upper end of that interval.")
            .of(|s| s.stats().trend.variation_interval.map(|i| i.1).into()),
    ),
    metric(
        Evenness,
        Plain,
        column(
            "density_ratio",
            "ratio",
            "Greatest over least density in the window by a quadratic fit, at most 100; above 1 by \
                chance alone.",
        )
        .of(|s| s.stats().trend.density_ratio.into()),
    ),
];
