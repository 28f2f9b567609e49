use super::BatchError;
use super::outputs::{OutputFolder, series_table};
use crate::compare::{SamplerVerdict, VerdictOptions, verdict};
use crate::mosaic::Mosaic;
use crate::report::{Cell, Curve, EnvelopePanel, VerdictRecord, envelope_figure, significant};
use crate::sample::Sampler;
use crate::stats::Measures;

/// What [`write`] writes.
const ENVELOPE: &str = "envelope.csv";
const FIGURE: &str = "verdict.svg";
pub(super) const FILES: [&str; 2] = [ENVELOPE, FIGURE];

/// The verdict of each sampler on a mosaic, in their order, and a warning for each that has none. A
/// mosaic without a pair correlation function has neither: another warning says so.
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

/// Columns r, g, and of each sampler the mean of its simulations and the edges of their global
/// envelope.
fn envelope_table<'a>(
    measures: &'a Measures,
    verdicts: &'a [SamplerVerdict],
) -> (Vec<String>, Vec<Vec<Cell>>) {
    let (r, g) = measures.pcf.as_ref().map_or((&[][..], &[][..]), |pcf| (&pcf.r, &pcf.g));
    let edges = |v: &'a SamplerVerdict| {
        [("mean", &v.envelope.mean), ("low", &v.envelope.low), ("high", &v.envelope.high)]
            .map(|(what, values)| (format!("{what}_{}", v.sampler.replace('-', "_")), values.as_slice()))
    };
    series_table(
        [("r".to_owned(), r), ("g".to_owned(), g)].into_iter().chain(verdicts.iter().flat_map(edges)),
    )
}

/// Rows of `verdicts.csv`: each file and what was found on it.
pub(super) fn table<'a>(
    found: impl Iterator<Item = (&'a str, &'a [VerdictRecord])>,
) -> (Vec<String>, Vec<Vec<Cell>>) {
    let rows = found.flat_map(|(file, verdicts)| verdicts.iter().map(move |v| v.row(file)));
    (VerdictRecord::header(), rows.collect())
}

/// Writes the envelopes and their figure, under names that begin with `prefix`; nothing without
/// verdicts.
pub(super) fn write(
    out: &OutputFolder,
    prefix: &str,
    title: &str,
    measures: &Measures,
    verdicts: &[SamplerVerdict],
) -> Result<(), BatchError> {
    if verdicts.is_empty() {
        return Ok(());
    }
    let (header, rows) = envelope_table(measures, verdicts);
    out.write_table(&format!("{prefix}{ENVELOPE}"), &header, &rows)?;
    out.write(&format!("{prefix}{FIGURE}"), figure(title, measures, verdicts)?.as_bytes())
}

/// The mosaic's g in the envelope of each sampler.
fn figure(title: &str, measures: &Measures, verdicts: &[SamplerVerdict]) -> Result<String, BatchError> {
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
