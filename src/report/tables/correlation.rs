use super::EdgeRule::Own;
use super::{Layout, Part, Row, Table, column};
use crate::compare::{ReferenceCurve, SamplerVerdict};
use crate::report::ReportError;
use crate::stats::{Inhomogeneous, Measures, Pcf};

/// One distance, and the values of pair correlation functions at it: a row of the table.
#[derive(Clone, Copy, Debug)]
pub struct PcfRow<'a> {
    index: usize,
    pcf: &'a Pcf,
    varying: Option<&'a Inhomogeneous>,
    curves: &'a [ReferenceCurve],
}

impl Row for PcfRow<'static> {
    type Of<'a> = PcfRow<'a>;
}

impl<'a> PcfRow<'a> {
    fn varying(&self, series: fn(&Inhomogeneous) -> &Vec<f64>) -> Option<f64> {
        self.varying.and_then(|found| series(found).get(self.index).copied())
    }

    fn of_sampler(&self, sampler: &str) -> Option<f64> {
        let curve = self.curves.iter().find(|c| c.sampler == sampler)?;
        curve.pcf.g.get(self.index).copied()
    }
}

/// The table of pair correlation functions.
pub static PCF: Table<PcfRow> = Table {
    file: "NAME.pcf.csv",
    commands: "measure, compare, run (images/NAME/pcf.csv)",
    about: "One row per distance; there are no rows if the function is not defined. The edge rule \
            is the one chosen; by default g is divided by the set covariance of the window (Lanaro \
            et al. 2020).",
    columns: &[
        column(
            "r",
            "spacings",
            "Left edge of the bin, in hexagonal spacings of the mosaic's density; g is taken there.",
        )
        .of(|p| p.pcf.r.get(p.index).copied().into()),
        column(
            "g",
            "ratio",
            "Pair correlation function: number of pairs at this distance over the number expected \
             of independent points.",
        )
        .edge(Own)
        .of(|p| p.pcf.g.get(p.index).copied().into()),
        column(
            "g_inhomogeneous",
            "ratio",
            "Pair correlation function for a density that varies across the window; given only if \
             the trend is significant.",
        )
        .edge(Own)
        .source("Baddeley et al. 2000")
        .only(Part::Varying)
        .of(|p| p.varying(|f| &f.g).into()),
        column(
            "g_locally_scaled",
            "ratio",
            "Pair correlation function of distances in local spacings; given only if the trend is \
             significant.",
        )
        .edge(Own)
        .source("Hahn et al. 2003")
        .only(Part::Varying)
        .of(|p| p.varying(|f| &f.g_scaled).into()),
        column(
            "k_inhomogeneous",
            "spacings²",
            "K function for a density that varies across the window; given only if the trend is significant.",
        )
        .edge(Own)
        .source("Baddeley et al. 2000")
        .only(Part::Varying)
        .of(|p| p.varying(|f| &f.k).into()),
        column(
            "g_SAMPLER",
            "ratio",
            "Mean g of samples with about as many points in a window of about the same shape; one column \
                per sampler compared with.",
        )
        .edge(Own)
        .per_sampler(|p, sampler| p.of_sampler(sampler).into()),
    ],
};

/// Returns `NAME.pcf.csv`: the pair correlation function of a mosaic beside the mean ones of
/// samplers.
///
/// There are no rows if the function is not defined.
///
/// # Errors
/// Fails if the table cannot be written as CSV.
pub fn pcf_csv(measures: &Measures, curves: &[ReferenceCurve]) -> Result<Vec<u8>, ReportError> {
    let samplers: Vec<String> = curves.iter().map(|c| c.sampler.clone()).collect();
    let varying = measures.inhomogeneous.as_ref();
    let parts = varying.map(|_| Part::Varying);
    let rows = measures
        .pcf
        .iter()
        .flat_map(|pcf| (0..pcf.r.len()).map(move |index| PcfRow { index, pcf, varying, curves }));
    PCF.csv_as(&Layout { samplers: &samplers, parts: parts.as_slice() }, rows)
}

/// One distance, and the values of a mosaic's pair correlation function and its envelopes at it: a
/// row of the table.
#[derive(Clone, Copy, Debug)]
pub struct EnvelopeRow<'a> {
    index: usize,
    pcf: &'a Pcf,
    verdicts: &'a [SamplerVerdict],
}

impl Row for EnvelopeRow<'static> {
    type Of<'a> = EnvelopeRow<'a>;
}

impl EnvelopeRow<'_> {
    fn of_sampler(&self, sampler: &str, series: fn(&SamplerVerdict) -> &Vec<f64>) -> Option<f64> {
        let verdict = self.verdicts.iter().find(|v| v.sampler == sampler)?;
        series(verdict).get(self.index).copied()
    }
}

/// The table of global envelopes of the pair correlation function.
pub static ENVELOPE: Table<EnvelopeRow> = Table {
    file: "NAME.envelope.csv",
    commands: "compare, run --verdict (images/NAME/envelope.csv)",
    about: "One row per distance; three columns per sampler.",
    columns: &[
        column(
            "r",
            "spacings",
            "Left edge of the bin, in hexagonal spacings of the mosaic's density; g is taken there.",
        )
        .of(|e| e.pcf.r.get(e.index).copied().into()),
        column("g", "ratio", "Pair correlation function of the mosaic.")
            .edge(Own)
            .of(|e| e.pcf.g.get(e.index).copied().into()),
        column("mean_SAMPLER", "ratio", "Mean g of the simulations.")
            .edge(Own)
            .per_sampler(|e, sampler| e.of_sampler(sampler, |v| &v.envelope.mean).into()),
        column("low_SAMPLER", "ratio", "Lower edge of the global envelope.")
            .edge(Own)
            .per_sampler(|e, sampler| e.of_sampler(sampler, |v| &v.envelope.low).into()),
        column("high_SAMPLER", "ratio", "Upper edge of the global envelope.")
            .edge(Own)
            .per_sampler(|e, sampler| e.of_sampler(sampler, |v| &v.envelope.high).into()),
    ],
};

/// Returns `NAME.envelope.csv` of a mosaic; there are no rows if its function is not defined.
///
/// # Errors
/// Fails if the table cannot be written as CSV.
pub fn envelope_csv(measures: &Measures, verdicts: &[SamplerVerdict]) -> Result<Vec<u8>, ReportError> {
    let samplers: Vec<String> = verdicts.iter().map(|v| v.sampler.clone()).collect();
    let rows = measures
        .pcf
        .iter()
        .flat_map(|pcf| (0..pcf.r.len()).map(move |index| EnvelopeRow { index, pcf, verdicts }));
    ENVELOPE.csv_as(&Layout { samplers: &samplers, parts: &[] }, rows)
}
