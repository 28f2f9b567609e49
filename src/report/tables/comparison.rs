use super::{OutputTable, column};

/// Simulated tests.
pub static VERDICTS: OutputTable = OutputTable {
    file: "verdicts.csv",
    commands: "compare, run --verdict",
    about: "A row a mosaic and sampler: simulations of the sampler at the mosaic's own number of points and window.",
    columns: &[
        column("file", "text", "The file, as given."),
        column("sampler", "text", "The sampler."),
        column("verdict", "text", "as: the mosaic could be a realisation of it; differs."),
        column(
            "p_envelope",
            "0–1",
            "p-value of the global envelope test of g (extreme rank length; Myllymäki et al. 2017).",
        ),
        column(
            "outside_r_in_spacings",
            "spacings",
            "Stretches of r, from–to, at which g is outside the envelope.",
        ),
        column("l_infinity", "ratio", "Greatest difference of g and the mean of the simulations."),
        column("p_l_infinity", "0–1", "p-value of it: the mosaic's rank among the simulations."),
        column(
            "l_infinity_usual",
            "ratio",
            "Median of it for one simulation against the mean of all other curves.",
        ),
        column("l_infinity_95_percent", "ratio", "What 95 % of the simulations stay within."),
        column("ri_mean", "ratio", "Mean regularity index of the simulations (all points, n − 1)."),
        column("ri_sd", "ratio", "Its standard deviation over the simulations."),
        column("simulations", "count", "Number of simulations."),
        column("points_min", "count", "Fewest points of a simulation."),
        column("points_max", "count", "Most points of a simulation."),
    ],
};

/// Envelopes of g.
pub static ENVELOPE: OutputTable = OutputTable {
    file: "NAME.envelope.csv",
    commands: "compare, run --verdict (images/NAME/envelope.csv)",
    about: "A row a distance; three columns a sampler.",
    columns: &[
        column("r", "spacings", "Middle of the bin, in hexagonal spacings."),
        column("g", "ratio", "Pair correlation function of the mosaic."),
        column("mean_SAMPLER", "ratio", "Mean of the simulations."),
        column("low_SAMPLER", "ratio", "Lower edge of the global envelope."),
        column("high_SAMPLER", "ratio", "Upper edge of the global envelope."),
    ],
};

/// Nearest neighbours by both divisors.
pub static REGULARITY: OutputTable = OutputTable {
    file: "regularity.csv",
    commands: "compare",
    about: "A row a file: distances to the nearest neighbour of all points, nothing done about the border (Wässle & Riemann 1978).",
    columns: &[
        column("file", "text", "The file, as given."),
        column("unit", "text", "Unit of the coordinates (px, um, unit)."),
        column("nn_mean", "unit", "Mean distance."),
        column("nn_sd_population", "unit", "Standard deviation (n), as in the tables of Lanaro et al. 2020."),
        column("ri_population", "ratio", "Mean over that."),
        column("nn_sd_sample", "unit", "Standard deviation (n − 1)."),
        column("ri_sample", "ratio", "Mean over that."),
        column("n", "count", "Points."),
    ],
};

/// Distances to samplers.
pub static L_INFINITY: OutputTable = OutputTable {
    file: "l_infinity.csv",
    commands: "compare",
    about: "A row a file.",
    columns: &[
        column("file", "text", "The file, as given."),
        column(
            "SAMPLER",
            "ratio",
            "Greatest difference of the pair correlation functions of the mosaic and of the sampler (Lanaro et al. 2020); a column a sampler.",
        ),
        column("closest_sampler", "text", "The sampler of the least."),
        column("n", "count", "Points."),
        column("ri", "ratio", "Regularity index of all points."),
        column("sd_kind", "text", "Its divisor: sample (n − 1) or population (n)."),
        column("warnings", "text", "What a reader of the numbers should know."),
    ],
};

/// Regularity against distance.
pub static FINDING: OutputTable = OutputTable {
    file: "finding.csv",
    commands: "compare",
    about: "A row a sampler: how regularity and distance to it hang together over the mosaics.",
    columns: &[
        column("sampler", "text", "The sampler."),
        column("mosaics", "count", "Mosaics with both."),
        column("spearman_rho_of_ri_and_l_infinity", "−1–1", "Rank correlation (Spearman 1904)."),
        column("p_value", "0–1", "Two-sided p-value of it."),
        column("in_words", "text", "The same in words."),
    ],
};
