//! Metrics of regularity against independent points, and of the evenness of density.
//!
//! The edge rule `All` counts all points without any correction. `Own` means that the definition
//! states a correction of its own; see [`EdgeRule`](crate::report::tables::EdgeRule).

use super::MetricGroup::{Evenness, Regularity};
use super::Quantity::Plain;
use super::{Metric, metric};
use crate::report::tables::EdgeRule::{All, Own};
use crate::report::tables::column;

/// Metrics that compare the mosaic with independently placed points.
pub(super) const REGULARITY: &[Metric] = &[
    metric(
        Regularity,
        Plain,
        column(
            "clark_evans_naive",
            "ratio",
            "Clark–Evans index: nn_mean divided by its expected value for independent points of \
                the same density, 1/(2√density). It is 1 for independent points and 2.149 for the \
                triangular lattice; empty for fewer than two points.",
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
            "Clark–Evans index with an expected value that allows for the border: 1/(2√density) + \
                (0.0514 + 0.0412/√n) × length of the border/n for n points; empty for fewer than two \
                points and on a torus.",
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
            "Clark–Evans index with the mean distance taken from the Kaplan–Meier estimate of the \
                distribution of nearest-neighbour distances: a point nearer to the border than to its \
                nearest neighbour counts only up to its distance from the border. Empty for fewer than \
                two points, and if every point is nearer to the border than to its nearest neighbour.",
        )
        .edge(Own)
        .source("Baddeley, Rubak & Turner 2015")
        .of(|s| s.stats().clark_evans.cdf.into()),
    ),
];

/// Metrics of the evenness of density across the window.
pub(super) const EVENNESS: &[Metric] = &[
    metric(
        Evenness,
        Plain,
        column(
            "trend_p",
            "0–1",
            "p-value of a test for a trend in density: probability of a trend at least this \
                strong if the density varies by 10 % (the tolerated variation, not zero). Values below \
                .01 lead to a warning; empty for fewer than 20 points.",
        )
        .of(|s| s.stats().trend.p_value.into()),
    ),
    metric(
        Evenness,
        Plain,
        column(
            "density_variation",
            "ratio",
            "Size of the slow variation of density across the window, as a fraction of the mean \
                density: √12 × its root mean square, after subtraction of what chance alone \
                produces. The factor √12 makes it the difference between opposite edges for a linear \
                gradient.",
        )
        .of(|s| s.stats().trend.variation.into()),
    ),
    metric(
        Evenness,
        Plain,
        column(
            "density_variation_low",
            "ratio",
            "Lower end of the 98 % confidence interval of density_variation.",
        )
        .of(|s| s.stats().trend.variation_interval.map(|i| i.0).into()),
    ),
    metric(
        Evenness,
        Plain,
        column(
            "density_variation_high",
            "ratio",
            "Upper end of the 98 % confidence interval of density_variation.",
        )
        .of(|s| s.stats().trend.variation_interval.map(|i| i.1).into()),
    ),
    metric(
        Evenness,
        Plain,
        column(
            "density_ratio",
            "ratio",
            "Ratio of the largest to the smallest density in the window, both from a quadratic \
                fit; at most 100. Chance alone makes it larger than 1.",
        )
        .of(|s| s.stats().trend.density_ratio.into()),
    ),
];
