use super::{OutputTable, column};

const R: &str = "Distance.";

/// Pair correlation.
pub static PCF: OutputTable = OutputTable {
    file: "NAME.pcf.csv",
    commands: "measure, compare, run (images/NAME/pcf.csv)",
    about: "A row a distance; no rows where the function is not defined. Edge rule as chosen by --edge, by default division by the \
            set covariance of the window (Lanaro et al. 2020).",
    columns: &[
        column("r", "spacings", "Middle of the bin, in hexagonal spacings of the mosaic's density."),
        column(
            "g",
            "ratio",
            "Pair correlation function: pairs at this distance over those of independent points.",
        ),
        column(
            "g_inhomogeneous",
            "ratio",
            "The same for a density that varies (Baddeley et al. 2000); only where the trend is significant.",
        ),
        column(
            "g_locally_scaled",
            "ratio",
            "The same with distances in local spacings (Hahn et al. 2003); only where the trend is significant.",
        ),
        column(
            "k_inhomogeneous",
            "spacings²",
            "K for a density that varies (Baddeley et al. 2000); only where the trend is significant.",
        ),
        column(
            "g_SAMPLER",
            "ratio",
            "Mean g of samples of as many points in the same window; one column a sampler compared with.",
        ),
    ],
};

/// Functions of distance by spatstat's names.
pub static FUNCTIONS: OutputTable = OutputTable {
    file: "NAME.functions.csv",
    commands: "measure --functions",
    about: "A row a distance. Edge rules in the names, as in spatstat (Baddeley, Rubak & Turner 2015): none: nothing is done; rs or border: \
            reduced sample (points at least r from the border); km: Kaplan–Meier; han: Hanisch; trans: translation; iso: isotropic; \
            theo: independent points. A cell is empty where the function is not defined.",
    columns: &[
        column("r", "unit", R),
        column("G_none", "0–1", "Share of points whose nearest neighbour is at most r away."),
        column("G_rs", "0–1", "The same."),
        column("G_km", "0–1", "The same."),
        column("G_han", "0–1", "The same."),
        column("G_theo", "0–1", "1 − exp(−π r² density)."),
        column("F_none", "0–1", "Share of the window (128 × 128 places) that is at most r from a point."),
        column("F_rs", "0–1", "The same."),
        column("F_km", "0–1", "The same."),
        column("F_han", "0–1", "The same (Chiu & Stoyan 1998)."),
        column(
            "J_none",
            "ratio",
            "(1 − G)/(1 − F) (van Lieshout & Baddeley 1996): above 1 for regular patterns.",
        ),
        column("J_rs", "ratio", "The same."),
        column("J_km", "ratio", "The same."),
        column("J_han", "ratio", "The same."),
        column(
            "K_none",
            "unit²",
            "Mean number of further points within r of a point, over density (Ripley 1976).",
        ),
        column("K_border", "unit²", "The same."),
        column("K_iso", "unit²", "The same."),
        column("K_trans", "unit²", "The same."),
        column("K_theo", "unit²", "π r²."),
        column("L_none", "unit", "√(K/π) (Besag 1977)."),
        column("L_border", "unit", "The same."),
        column("L_iso", "unit", "The same."),
        column("L_trans", "unit", "The same."),
        column(
            "pcf_trans_divr",
            "ratio",
            "Pair correlation by an Epanechnikov kernel of half-width .15/√density, divided by 2πr (pcf.ppp of spatstat).",
        ),
        column("pcf_iso_divr", "ratio", "The same."),
        column("pcf_trans_divd", "ratio", "The same, each pair divided by its own distance (Guan 2007)."),
        column("pcf_iso_divd", "ratio", "The same."),
    ],
};

/// Density around the average point.
pub static DENSITY_RECOVERY: OutputTable = OutputTable {
    file: "NAME.density_recovery.csv",
    commands: "measure --functions",
    about: "A row an annulus about the average point (Rodieck 1991); no rows for fewer than two points. What the annuli cover beyond the \
            window is made up for.",
    columns: &[
        column("r", "unit", "Middle of the annulus."),
        column("density", "1/unit²", "Points per area in the annulus."),
        column("relative_density", "ratio", "That over the mean density."),
    ],
};

/// Power spectrum of points.
pub static SPECTRUM: OutputTable = OutputTable {
    file: "NAME.spectrum.csv",
    commands: "measure --spectrum",
    about: "A row a ring of frequencies (Ulichney 1987; Lanaro et al. 2020).",
    columns: &[
        column("frequency", "√density", "Middle of the ring, in cycles per 1/√density."),
        column("power", "ratio", "Mean power: 1 for independent points."),
        column("anisotropy_db", "dB", "Variance of the power over its squared mean: 0 without direction."),
    ],
};
