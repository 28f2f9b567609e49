use super::BatchError;
use crate::compare::{SamplerVerdict, VerdictOptions, verdict};
use crate::mosaic::Mosaic;
use crate::report::{Cell, Curve, EnvelopePanel, VerdictRecord, envelope_figure, significant};
use crate::sample::Sampler;
use crate::stats::Measures;

/// The verdict of each sampler on a mosaic, in their order, and a warning for each that has none. A mosaic without a pair
/// correlation function has neither: another warning says so.
pub(super) fn verdicts_on(
    mosaic: &Mosaic,
    measures: &Measures,
    samplers: &[&'static dyn Sampler],
    options: Option<&VerdictOptions>,
    seed: u64,
) -> (Vec<SamplerVerdict>, Vec<String>) {
    let (mut verdicts, mut warnings) = (Vec::new(), Vec::new());
    let (Some(options), Ok(pcf)) = (options, &measures.pcf) else { return (verdicts, warnings) };
    for sampler in samplers {
        match verdict(pcf, mosaic.len(), mosaic.window(), *sampler, &pcf.options, options, seed) {
            Ok(found) => verdicts.push(found),
            Err(error) => warnings.push(format!("no verdict: {error}")),
        }
    }
    (verdicts, warnings)
}

pub(super) fn records(verdicts: &[SamplerVerdict]) -> Vec<VerdictRecord> {
    verdicts.iter().map(VerdictRecord::from).collect()
}

/// Columns r, g, and of each sampler the mean of its simulations and the edges of their global envelope.
pub(super) fn envelope_table(
    measures: &Measures,
    verdicts: &[SamplerVerdict],
) -> (Vec<String>, Vec<Vec<Cell>>) {
    let column = |v: &SamplerVerdict, what: &str| format!("{what}_{}", v.sampler.replace('-', "_"));
    let header = ["r".to_owned(), "g".to_owned()]
        .into_iter()
        .chain(verdicts.iter().flat_map(|v| ["mean", "low", "high"].map(|what| column(v, what))))
        .collect();
    let rows = measures.pcf.iter().flat_map(|pcf| (0..pcf.r.len()).map(move |k| (pcf, k))).map(|(pcf, k)| {
        let edges = |v: &SamplerVerdict| [v.envelope.mean[k], v.envelope.low[k], v.envelope.high[k]];
        [pcf.r[k], pcf.g[k]].into_iter().chain(verdicts.iter().flat_map(edges)).map(Cell::from).collect()
    });
    (header, rows.collect())
}

/// The mosaic's g in the envelope of each sampler.
pub(super) fn figure(
    title: &str,
    measures: &Measures,
    verdicts: &[SamplerVerdict],
) -> Result<String, BatchError> {
    let notes: Vec<String> =
        verdicts.iter().map(|v| format!("p = {}", significant(v.p_envelope, 2))).collect();
    let panels: Vec<EnvelopePanel> = verdicts
        .iter()
        .zip(&notes)
        .map(|(v, note)| EnvelopePanel {
            name: &v.sampler,
            note,
            mean: &v.envelope.mean,
            low: &v.envelope.low,
            high: &v.envelope.high,
        })
        .collect();
    let (r, g) = measures.pcf.as_ref().map_or((&[][..], &[][..]), |pcf| (&pcf.r, &pcf.g));
    Ok(envelope_figure(title, Curve { r, g }, &panels)?)
}
