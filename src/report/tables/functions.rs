use super::EdgeRule::{All, Own};
use super::{Row, Table, column};
use crate::report::ReportError;
use crate::stats::{DensityRecovery, Functions, PowerSpectrum};

/// One distance, and the values of functions at it, each under its name: a row of the table.
#[derive(Clone, Copy, Debug)]
pub struct FunctionsRow<'a> {
    index: usize,
    series: &'a [(&'static str, Vec<f64>)],
}

impl Row for FunctionsRow<'static> {
    type Of<'a> = FunctionsRow<'a>;
}

impl FunctionsRow<'_> {
    fn get(&self, name: &str) -> Option<f64> {
        let (_, values) = self.series.iter().find(|(n, _)| *n == name)?;
        values.get(self.index).copied()
    }
}

/// The table of functions of distance, under spatstat's names.
pub static FUNCTIONS: Table<FunctionsRow> = Table {
    file: "NAME.functions.csv",
    commands: "measure --functions",
    about: "One row per distance. The names of the columns tell the edge rule, as in spatstat \
            (Baddeley, Rubak & Turner 2015): none: no correction; rs or border: reduced sample \
            (only points at least r from the border); km: Kaplan–Meier; han: Hanisch; trans: \
            translation; iso: isotropic; theo: value for independent points. A cell is empty where \
            the function is not defined.",
    columns: &[
        column("r", "unit", "Distance at which the functions are given.")
            .by_name(|f, name| f.get(name).into()),
        column("G_none", "0–1", "Share of points whose nearest neighbour is at most r away.")
            .edge(All)
            .by_name(|f, name| f.get(name).into()),
        column("G_rs", "0–1", "G_none by the reduced sample rule.")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
        column("G_km", "0–1", "G_none by the Kaplan–Meier rule.")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
        column("G_han", "0–1", "G_none by the Hanisch rule.").edge(Own).by_name(|f, name| f.get(name).into()),
        column("G_theo", "0–1", "1 − exp(−π r² density).").by_name(|f, name| f.get(name).into()),
        column(
            "F_none",
            "0–1",
            "Share of the window (of 128 × 128 places) that is at most r away \
                                 from a point.",
        )
        .edge(All)
        .by_name(|f, name| f.get(name).into()),
        column("F_rs", "0–1", "F_none by the reduced sample rule.")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
        column("F_km", "0–1", "F_none by the Kaplan–Meier rule.")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
        column("F_han", "0–1", "F_none by the Hanisch rule (Chiu & Stoyan 1998).")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
        column(
            "J_none",
            "ratio",
            "(1 − G)/(1 − F) (van Lieshout & Baddeley 1996): above 1 for regular patterns.",
        )
        .edge(All)
        .by_name(|f, name| f.get(name).into()),
        column("J_rs", "ratio", "J_none by the reduced sample rule.")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
        column("J_km", "ratio", "J_none by the Kaplan–Meier rule.")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
        column("J_han", "ratio", "J_none by the Hanisch rule.")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
        column(
            "K_none",
            "unit²",
            "Mean number of further points within r of a point, divided by the density (Ripley 1976).",
        )
        .edge(All)
        .by_name(|f, name| f.get(name).into()),
        column("K_border", "unit²", "K_none by the reduced sample rule.")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
        column("K_iso", "unit²", "K_none by the isotropic rule.")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
        column("K_trans", "unit²", "K_none by the translation rule.")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
        column("K_theo", "unit²", "π r².").by_name(|f, name| f.get(name).into()),
        column("L_none", "unit", "√(K/π) (Besag 1977).").edge(All).by_name(|f, name| f.get(name).into()),
        column("L_border", "unit", "L_none by the reduced sample rule.")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
        column("L_iso", "unit", "L_none by the isotropic rule.")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
        column("L_trans", "unit", "L_none by the translation rule.")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
        column(
            "pcf_trans_divr",
            "ratio",
            "Pair correlation function by an Epanechnikov kernel of half-width 0.15/√density, \
             divided by 2πr (pcf.ppp of spatstat), with the translation rule.",
        )
        .edge(Own)
        .by_name(|f, name| f.get(name).into()),
        column("pcf_iso_divr", "ratio", "pcf_trans_divr by the isotropic rule.")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
        column(
            "pcf_trans_divd",
            "ratio",
            "pcf_trans_divr, but with each pair divided by its own distance (Guan 2007).",
        )
        .edge(Own)
        .by_name(|f, name| f.get(name).into()),
        column("pcf_iso_divd", "ratio", "pcf_trans_divd by the isotropic rule.")
            .edge(Own)
            .by_name(|f, name| f.get(name).into()),
    ],
};

/// Returns `NAME.functions.csv` of a mosaic.
///
/// # Errors
/// Fails if the table cannot be written as CSV.
pub fn functions_csv(functions: &Functions) -> Result<Vec<u8>, ReportError> {
    let series = functions.columns();
    FUNCTIONS.csv((0..functions.r.len()).map(|index| FunctionsRow { index, series: &series }))
}

/// An annulus around the average point.
#[derive(Clone, Copy, Debug)]
pub struct AnnulusRow {
    r: f64,
    density: f64,
    mean_density: f64,
}

impl Row for AnnulusRow {
    type Of<'a> = Self;
}

/// The table of the density around the average point.
pub static DENSITY_RECOVERY: Table<AnnulusRow> = Table {
    file: "NAME.density_recovery.csv",
    commands: "measure --functions",
    about: "One row per annulus around the average point (Rodieck 1991); there are no rows for \
            fewer than two points. The density is corrected for the part of the annuli that lies \
            outside the window.",
    columns: &[
        column("r", "unit", "Radius of the middle of the annulus.").of(|a| a.r.into()),
        column("density", "1/unit²", "Number of points per area in the annulus.")
            .edge(Own)
            .of(|a| a.density.into()),
        column("relative_density", "ratio", "density over the mean density.")
            .edge(Own)
            .of(|a| (a.density / a.mean_density).into()),
    ],
};

/// Returns `NAME.density_recovery.csv`; there are no rows without a profile.
///
/// # Errors
/// Fails if the table cannot be written as CSV.
pub fn density_recovery_csv(profile: Option<&DensityRecovery>) -> Result<Vec<u8>, ReportError> {
    let rows = profile.into_iter().flat_map(|p| {
        let annulus = |(&r, &density)| AnnulusRow { r, density, mean_density: p.mean_density };
        p.r.iter().zip(&p.density).map(annulus)
    });
    DENSITY_RECOVERY.csv(rows)
}

/// A ring of frequencies in a power spectrum.
#[derive(Clone, Copy, Debug)]
pub struct FrequencyRow<'a> {
    index: usize,
    spectrum: &'a PowerSpectrum,
}

impl Row for FrequencyRow<'static> {
    type Of<'a> = FrequencyRow<'a>;
}

/// The table of the radial power spectrum of the points.
pub static SPECTRUM: Table<FrequencyRow> = Table {
    file: "NAME.spectrum.csv",
    commands: "measure --spectrum",
    about: "One row per ring of frequencies (Ulichney 1987; Lanaro et al. 2020).",
    columns: &[
        column("frequency", "√density", "Frequency of the middle of the ring, in cycles per 1/√density.")
            .of(|f| f.spectrum.frequency.get(f.index).copied().into()),
        column("power", "ratio", "Mean power in the ring: 1 for independent points.")
            .of(|f| f.spectrum.power.get(f.index).copied().into()),
        column(
            "anisotropy_db",
            "dB",
            "Variance of the power in the ring over its squared mean, in \
                                       decibels: about 0 for a pattern without preferred direction.",
        )
        .of(|f| f.spectrum.anisotropy_db.get(f.index).copied().into()),
    ],
};

/// Returns `NAME.spectrum.csv` of a mosaic.
///
/// # Errors
/// Fails if the table cannot be written as CSV.
pub fn spectrum_csv(spectrum: &PowerSpectrum) -> Result<Vec<u8>, ReportError> {
    SPECTRUM.csv((0..spectrum.power.len()).map(|index| FrequencyRow { index, spectrum }))
}
