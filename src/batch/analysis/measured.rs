use crate::batch::BatchError;
use crate::compare::{NotCompared, ReferenceCurve, SamplerCurves, l_infinity};
use crate::detect::Detections;
use crate::geometry::Point;
use crate::report::{MosaicRecord, SamplerDistance, counted};
use crate::stats::Measures;

/// Number of cones below which a warning says that all statistics are uncertain. The regularity
/// index of 30 points scatters by about 15 %.
const FEW: usize = 30;
/// Smallest number of points for which a warning says that coordinates are rounded, if all are
/// integers. Fewer points may have integer coordinates by chance, or in an example.
const ROUNDED: usize = 10;
/// Confidence, between 0 and 1, below which a warning says that the modality or the spacing is
/// uncertain.
pub(in crate::batch) const CONFIDENT: f64 = 0.8;

/// Returns the l-infinity distance between the mosaic and each reference curve; empty if the mosaic
/// has no pair correlation function.
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

/// Returns one warning for each sampler without a reference curve, with the reason.
pub(super) fn not_compared(curves: &SamplerCurves) -> impl Iterator<Item = String> {
    curves.missing.iter().map(NotCompared::to_string)
}

/// Returns whether coordinates look rounded: all points lie at integer distances from the first
/// point along both axes. Returns `false` for fewer than [`ROUNDED`] points.
fn whole_numbers(points: &[Point]) -> bool {
    let Some(first) = points.first() else { return false };
    let whole = |d: f64| (d - d.round()).abs() < 1e-9;
    points.len() >= ROUNDED && points.iter().all(|p| whole(p.x - first.x) && whole(p.y - first.y))
}

/// Returns the warnings about the numbers of one mosaic: uncertain detection, rounded coordinates,
/// few points, varying density, no pair correlation function. `found` is `None` if this program did
/// not detect the points.
pub(super) fn warnings_of(
    found: Option<&Detections>,
    record: &MosaicRecord,
    measures: &Measures,
    points: &[Point],
) -> Vec<String> {
    let mut warnings = Vec::new();
    if let Some(found) = found {
        if found.modality_confidence < CONFIDENT {
            warnings.push(format!(
                "the modality is uncertain ({}, with confidence {:.2}). If it is wrong, so may be the detections \
                 and every number: give the modality",
                found.modality, found.modality_confidence
            ));
        }
        let confidence = found.spacing_confidence;
        if confidence < CONFIDENT {
            warnings.push(format!(
                "the cone spacing is uncertain (confidence {confidence:.2}): {:.1} px from Yellott's ring, \
                 {:.1} px from the density of the cones found. If it is wrong, cones may be missed or \
                 counted twice: compare the overlay with the image, and give the spacing if you know it",
                found.ring_spacing, found.spacing
            ));
        }
    }
    if found.is_none() && whole_numbers(points) {
        warnings.push(
            "all coordinates are whole numbers. Rounding lowers the regularity index (by 6 to 20 % at \
             spacings of 5 to 10 px) and can change which sampler is closest: export the coordinates with \
             decimals if you can"
                .into(),
        );
    }
    if record.n < FEW {
        warnings.push(format!(
            "only {} in the window, so every statistic is uncertain (the regularity index of {FEW} points \
             scatters by about 15 %): check that the window and its unit are right, and use a larger one \
             if you can",
            counted(record.n, "point")
        ));
    }
    let trend = &record.stats.trend;
    if trend.significant {
        let percent = |share: f64| format!("{:.0}", 100. * share);
        let size = trend.variation.zip(trend.variation_interval).map(|(size, (low, high))| {
            format!(
                " by about {} % of its mean (98 % interval {} to {} %)",
                percent(size),
                percent(low),
                percent(high)
            )
        });
        let remedy = match measures.inhomogeneous {
            Some(_) => "use g_inhomogeneous and g_locally_scaled in pcf.csv, which allow for the variation",
            None => "use a smaller window, in which the density is more even",
        };
        warnings.push(format!(
            "the density varies{} across the window, so g(r) and the distances to the samplers, which assume \
             a constant density, are unreliable: {remedy}",
            size.unwrap_or_default()
        ));
    }
    if let Err(error) = &measures.pcf {
        warnings.push(format!("no pair correlation function, and so no distances to the samplers: {error}"));
    }
    warnings
}
