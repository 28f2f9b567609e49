use crate::batch::BatchError;
use crate::batch::output::{OutputFolder, write_figure};
use crate::compare::{SamplerVerdict, VerdictOptions, verdict};
use crate::mosaic::Mosaic;
use crate::report::tables::{VERDICTS, VerdictRow, envelope_csv};
use crate::report::{Curve, EnvelopePanel, FigureFormat, VerdictRecord, envelope_figure, significant};
use crate::sample::Sampler;
use crate::stats::Measures;

/// Name of the table of curves and envelopes, without the name of the mosaic.
const ENVELOPE: &str = "envelope.csv";

/// Tests a mosaic against each sampler. Returns the verdicts in the order of the samplers, and a
/// warning for each sampler without one.
///
/// Both lists are empty if `options` is `None`, or if the mosaic has no pair correlation function,
/// which causes a warning elsewhere.
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
            Err(error) => {
                warnings.push(format!("no verdict on {} (no row in verdicts.csv): {error}", sampler.name()));
            }
        }
    }
    (verdicts, warnings)
}

/// Converts verdicts to the form in which they are written to JSON and tables.
pub(super) fn records(verdicts: &[SamplerVerdict]) -> Vec<VerdictRecord> {
    verdicts.iter().map(VerdictRecord::from).collect()
}

/// Writes `verdicts.csv`, one row per file and verdict.
pub(in crate::batch) fn write_table<'a>(
    out: &OutputFolder,
    found: impl Iterator<Item = (&'a str, &'a [VerdictRecord])>,
) -> Result<(), BatchError> {
    let rows = found.flat_map(|(file, all)| all.iter().map(move |verdict| VerdictRow { file, verdict }));
    out.write(VERDICTS.file, &VERDICTS.csv(rows)?)
}

/// Writes the table of envelopes and the figure of the verdicts, with `prefix` before the names of
/// the files. Writes nothing if there are no verdicts.
pub(super) fn write(
    out: &OutputFolder,
    prefix: &str,
    title: &str,
    (measures, verdicts): (&Measures, &[SamplerVerdict]),
    figures: &[FigureFormat],
) -> Result<(), BatchError> {
    if verdicts.is_empty() {
        return Ok(());
    }
    out.write(&format!("{prefix}{ENVELOPE}"), &envelope_csv(measures, verdicts)?)?;
    write_figure(out, &format!("{prefix}verdict"), &figure(title, measures, verdicts)?, figures)
}

/// Draws the mosaic's g(r) over the envelope of each sampler.
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
