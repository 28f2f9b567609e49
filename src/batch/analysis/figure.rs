use crate::batch::BatchError;
use crate::compare::ReferenceCurve;
use crate::image::Plane;
use crate::mosaic::Mosaic;
use crate::report::{Curve, MosaicFigure, MosaicRecord, ReferenceLine, mosaic_figure};
use crate::stats::Measures;

/// Draws the figure of one mosaic, a row of panels as in Lanaro et al. (2020,
/// <https://doi.org/10.1088/2399-6528/ab8064>): the image, the points, their nearest-neighbour
/// distances, and g(r) with the curves of the samplers.
pub(super) fn figure(
    title: &str,
    picture: Option<&Plane>,
    mosaic: &Mosaic,
    measures: &Measures,
    record: &MosaicRecord,
    curves: &[ReferenceCurve],
) -> Result<String, BatchError> {
    let references: Vec<ReferenceLine> = curves
        .iter()
        .map(|c| ReferenceLine {
            name: &c.sampler,
            r: &c.pcf.r,
            g: &c.pcf.g,
            l_infinity: record.distance_to(&c.sampler),
        })
        .collect();
    Ok(mosaic_figure(&MosaicFigure {
        title,
        picture,
        points: mosaic.points(),
        window: mosaic.window(),
        unit: mosaic.unit(),
        um_per_unit: mosaic.micrometres_per_unit(),
        nn: &measures.neighbours.distances,
        nn_mean: measures.summary.nearest.mean,
        nn_sd: measures.summary.nearest.sd,
        ri: measures.summary.nearest.ri,
        histogram_edges: &measures.histogram.edges,
        histogram_counts: &measures.histogram.counts,
        pcf: measures.pcf.as_ref().ok().map(|p| Curve { r: &p.r, g: &p.g }),
        references: &references,
    })?)
}
