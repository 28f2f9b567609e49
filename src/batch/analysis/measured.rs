use crate::batch::BatchError;
use crate::compare::{NotCompared, ReferenceCurve, SamplerCurves, l_infinity};
use crate::detect::Detections;
use crate::report::{MosaicRecord, SamplerDistance, counted};
use crate::stats::Measures;

/// Fewer cones than this leave every statistic uncertain: the RI of 30 points scatters by about 15 %.
const FEW: usize = 30;
/// Below this confidence in the modality or the spacing, a person should look.
pub(in crate::batch) const CONFIDENT: f64 = 0.8;

/// The mosaic's distance to each curve.
pub(super) fn distances(
    measures: &Measures,
    curves: &[ReferenceCurve],
) -> Result<Vec<SamplerDistance>, BatchError> {
    let Ok(pcf) = &measures.pcf else { return Ok(Vec::new()) };
    curves
        .iter()
        .map(|c| Ok(SamplerDistance { sampler: c.sampler.clone(), l_infinity: l_infinity(pcf, &c.pcf)? }))
        .collect()
}

/// Warns of every sampler that has no curve, with the reason.
pub(super) fn not_compared(curves: &SamplerCurves) -> impl Iterator<Item = String> {
    curves.missing.iter().map(NotCompared::to_string)
}

/// What a reader of the numbers should know.
pub(super) fn warnings_of(
    found: Option<&Detections>,
    record: &MosaicRecord,
    measures: &Measures,
) -> Vec<String> {
    let mut warnings = Vec::new();
    if let Some(found) = found {
        if found.modality_confidence < CONFIDENT {
            warnings.push(format!(
                "it is uncertain how the image was taken (confidence {:.2} that it is {}), and with it the detections: give the modality",
                found.modality_confidence, found.modality
            ));
        }
        let confidence = found.spacing_confidence;
        if confidence < CONFIDENT {
            warnings.push(format!(
                "the cone spacing is uncertain (confidence {confidence:.2}), and with it the detections: {:.1} px by Yellott's ring, {:.1} px by the density of the cones found; give the spacing if you know it",
                found.ring_spacing, found.spacing
            ));
        }
    }
    if record.n < FEW {
        warnings.push(format!("only {}: every statistic is uncertain", counted(record.n, "point")));
    }
    let trend = &record.stats.trend;
    if trend.significant {
        let percent = |share: f64| format!("{:.0}", 100. * share);
        let size = trend.variation.zip(trend.variation_interval).map(|(size, (low, high))| {
            format!(" by about {} % (at least {}, at most {})", percent(size), percent(low), percent(high))
        });
        let remedy = match measures.inhomogeneous {
            Some(_) => "; g_inhomogeneous and g_locally_scaled beside it allow for that",
            None => "",
        };
        warnings.push(format!(
            "density varies{} across the window: g(r) assumes that it does not{remedy}",
            size.unwrap_or_default()
        ));
    }
    if let Err(error) = &measures.pcf {
        warnings.push(format!("no pair correlation function: {error}"));
    }
    warnings
}
