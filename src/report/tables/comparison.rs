use super::EdgeRule::{All, Own};
use super::{Row, Table, column};
use crate::report::{CoordinatesRecord, FindingRecord, VerdictRecord};
use crate::stats::{Deviation, Moments};

/// The verdict on the mosaic of a file by simulations of one sampler.
#[derive(Clone, Copy, Debug)]
pub struct VerdictRow<'a> {
    /// Path of the file, as set by the user.
    pub file: &'a str,
    /// Verdict on the mosaic.
    pub verdict: &'a VerdictRecord,
}

impl Row for VerdictRow<'static> {
    type Of<'a> = VerdictRow<'a>;
}

/// The table of tests by simulation.
pub static VERDICTS: Table<VerdictRow> = Table {
    file: "verdicts.csv",
    commands: "compare, run --verdict",
    about: "One row per mosaic and sampler: the mosaic is tested against simulations of the sampler \
            with the mosaic's own number of points and window.",
    columns: &[
        column("file", "text", "Path of the file, as given.").of(|v| v.file.into()),
        column("sampler", "text", "Name of the sampler.").of(|v| v.verdict.sampler.as_str().into()),
        column(
            "verdict",
            "text",
            "“as” if the mosaic could be a realisation of the sampler, \
                                   “differs” if not.",
        )
        .of(|v| if v.verdict.alike { "as" } else { "differs" }.into()),
        column("p_envelope", "0–1", "p-value of the global envelope test of g (extreme rank length).")
            .edge(Own)
            .source("Myllymäki et al. 2017")
            .of(|v| v.verdict.p_envelope.into()),
        column(
            "outside_r_in_spacings",
            "spacings",
            "Ranges of r, from–to, in which g lies outside the envelope.",
        )
        .of(|v| v.verdict.outside_words().as_str().into()),
        column(
            "l_infinity_to_simulations",
            "ratio",
            "Greatest difference between g and the mean of the simulations with the mosaic's own \
             number of points and window. The distance to the mean curve for mosaics of about this \
             size is in l_infinity.csv and summary.csv.",
        )
        .edge(Own)
        .source("Lanaro et al. 2020")
        .of(|v| v.verdict.l_infinity.into()),
        column(
            "p_l_infinity",
            "0–1",
            "p-value of l_infinity_to_simulations: the rank of the mosaic among the simulations.",
        )
        .edge(Own)
        .of(|v| v.verdict.p_l_infinity.into()),
        column(
            "l_infinity_usual",
            "ratio",
            "Median l-infinity between one simulation and the mean of all other curves.",
        )
        .edge(Own)
        .of(|v| v.verdict.l_infinity_usual.into()),
        column("l_infinity_95_percent", "ratio", "The l-infinity that 95 % of the simulations stay within.")
            .edge(Own)
            .of(|v| v.verdict.l_infinity_most.into()),
        column("ri_mean", "ratio", "Mean regularity index of the simulations (all points, n − 1).")
            .edge(All)
            .of(|v| v.verdict.ri_mean.into()),
        column("ri_sd", "ratio", "Standard deviation of that index over the simulations.")
            .edge(All)
            .of(|v| v.verdict.ri_sd.into()),
        column("simulations", "count", "Number of simulations.").of(|v| v.verdict.simulations.into()),
        column("points_min", "count", "Fewest points of a simulation.").of(|v| v.verdict.points.0.into()),
        column("points_max", "count", "Most points of a simulation.").of(|v| v.verdict.points.1.into()),
    ],
};

impl Row for CoordinatesRecord {
    type Of<'a> = &'a Self;
}

/// Returns the nearest-neighbour distances of a mosaic, with the standard deviation by `divisor`.
fn nearest(record: &CoordinatesRecord, divisor: Deviation) -> Moments {
    let stats = &record.mosaic.stats;
    stats.nearest.with_divisor(stats.deviation, divisor)
}

/// Returns a length of a mosaic in µm; `None` without a scale.
fn in_um(record: &CoordinatesRecord, length: Option<f64>) -> Option<f64> {
    length.zip(record.mosaic.um_per_unit).map(|(length, um)| length * um)
}

/// The table of nearest-neighbour distances by both divisors, as in Table 1 of Lanaro et al. (2020,
/// <https://doi.org/10.1088/2399-6528/ab8064>).
pub static REGULARITY: Table<CoordinatesRecord> = Table {
    file: "regularity.csv",
    commands: "compare",
    about: "One row per file: nearest-neighbour distances of all points, without edge correction.",
    columns: &[
        column("file", "text", "Path of the file, as given.").of(|r| r.file.as_str().into()),
        column("unit", "text", "Unit of the coordinates (px, um, unit).")
            .of(|r| r.mosaic.unit.symbol().into()),
        column("nn_mean", "unit", "Mean nearest-neighbour distance.")
            .edge(All)
            .source("Wässle & Riemann 1978")
            .of(|r| r.mosaic.stats.nearest.mean.into()),
        column(
            "nn_sd_population",
            "unit",
            "Standard deviation (n) of these distances, as in the tables of Lanaro et al. 2020.",
        )
        .edge(All)
        .source("Wässle & Riemann 1978")
        .of(|r| nearest(r, Deviation::Population).sd.into()),
        column("ri_population", "ratio", "nn_mean / nn_sd_population.")
            .edge(All)
            .source("Wässle & Riemann 1978")
            .of(|r| nearest(r, Deviation::Population).ri.into()),
        column("nn_sd_sample", "unit", "Standard deviation (n − 1) of these distances.")
            .edge(All)
            .source("Wässle & Riemann 1978")
            .of(|r| nearest(r, Deviation::Sample).sd.into()),
        column("ri_sample", "ratio", "nn_mean / nn_sd_sample.")
            .edge(All)
            .source("Wässle & Riemann 1978")
            .of(|r| nearest(r, Deviation::Sample).ri.into()),
        column("n", "count", "Number of points.").of(|r| r.mosaic.stats.nearest.n.into()),
        column("nn_mean_um", "µm", "nn_mean in µm; empty without a scale.")
            .edge(All)
            .source("Wässle & Riemann 1978")
            .of(|r| in_um(r, r.mosaic.stats.nearest.mean).into()),
        column("nn_sd_population_um", "µm", "nn_sd_population in µm; empty without a scale.")
            .edge(All)
            .source("Wässle & Riemann 1978")
            .of(|r| in_um(r, nearest(r, Deviation::Population).sd).into()),
        column("nn_sd_sample_um", "µm", "nn_sd_sample in µm; empty without a scale.")
            .edge(All)
            .source("Wässle & Riemann 1978")
            .of(|r| in_um(r, nearest(r, Deviation::Sample).sd).into()),
    ],
};

/// The table of l-infinity distances to samplers.
pub static L_INFINITY: Table<CoordinatesRecord> = Table {
    file: "l_infinity.csv",
    commands: "compare",
    about: "One row per file: its distances to samplers.",
    columns: &[
        column("file", "text", "Path of the file, as given.").of(|r| r.file.as_str().into()),
        column(
            "SAMPLER",
            "ratio",
            "Greatest difference between the pair correlation functions of the mosaic and of the \
             sampler; one column per sampler.",
        )
        .edge(Own)
        .source("Lanaro et al. 2020")
        .per_sampler(|r, sampler| r.mosaic.distance_to(sampler).into()),
        column("closest_sampler", "text", "Name of the sampler with the smallest of these distances.")
            .of(|r| r.mosaic.closest_sampler().into()),
        column("n", "count", "Number of points.").of(|r| r.mosaic.n.into()),
        column("ri", "ratio", "Regularity index of all points.")
            .edge(All)
            .of(|r| r.mosaic.stats.nearest.ri.into()),
        column("sd_kind", "text", "Divisor of the variance in ri: sample (n − 1) or population (n).")
            .of(|r| r.mosaic.stats.deviation.name().into()),
        column("warnings", "text", "Remarks that a reader of the numbers needs, separated by semicolons.")
            .of(|r| r.warnings.join("; ").as_str().into()),
    ],
};

impl Row for FindingRecord {
    type Of<'a> = &'a Self;
}

/// The table of correlations of regularity with the distance to samplers.
pub static FINDING: Table<FindingRecord> = Table {
    file: "finding.csv",
    commands: "compare",
    about: "One row per sampler: correlation, over the mosaics, of the regularity index with the \
            distance to the sampler.",
    columns: &[
        column("sampler", "text", "Name of the sampler.").of(|f| f.sampler.as_str().into()),
        column("mosaics", "count", "Number of mosaics that have both numbers.").of(|f| f.mosaics.into()),
        column("spearman_rho_of_ri_and_l_infinity", "−1–1", "Spearman's rank correlation of the two.")
            .source("Spearman 1904")
            .of(|f| f.correlation.map(|c| c.rho).into()),
        column("p_value", "0–1", "Two-sided p-value of that correlation.")
            .of(|f| f.correlation.map(|c| c.p_value).into()),
        column("in_words", "text", "The result in words.").of(|f| f.words().as_str().into()),
    ],
};
