use super::BatchError;
use super::outputs::series_table;
use crate::compare::{NotCompared, ReferenceCurve, SamplerCurves, l_infinity};
use crate::detect::Detections;
use crate::geometry::Window;
use crate::mosaic::Mosaic;
use crate::report::{Cell, MosaicRecord, RecoveryRecord, SamplerDistance, counted, tables};
use crate::stats::{Functions, Measures};

/// Fewer cones than this leave every statistic uncertain: the RI of 30 points scatters by about 15 %.
const FEW: usize = 30;
/// Below this confidence in the modality or the spacing, a person should look.
pub(super) const CONFIDENT: f64 = 0.8;

pub(super) fn record_of(
    mosaic: &Mosaic,
    measures: &Measures,
    l_infinity: Vec<SamplerDistance>,
) -> MosaicRecord {
    let bounds = mosaic.window().bounds();
    MosaicRecord {
        n: mosaic.len(),
        unit: mosaic.unit(),
        um_per_unit: mosaic.micrometres_per_unit(),
        um_per_degree: mosaic.scale().map(|s| s.micrometres_per_degree()),
        place: None,
        labels: Vec::new(),
        window: [bounds.x0(), bounds.y0(), bounds.x1(), bounds.y1()],
        window_area: mosaic.window().area(),
        outline: match mosaic.window() {
            Window::Polygon(polygon) => Some(polygon.clone()),
            Window::Rectangle(_) | Window::Torus(_) => None,
        },
        density: mosaic.density(),
        spacing: mosaic.hexagonal_spacing(),
        deviation: measures.deviation,
        nearest: measures.nearest,
        nearest_interior: measures.nearest_interior,
        nearest_bound: measures.nearest_bound,
        clark_evans: measures.clark_evans,
        voronoi: measures.voronoi,
        density_recovery: measures.density_recovery.as_ref().ok().map(RecoveryRecord::from),
        orientation: (&measures.orientation).into(),
        modal: measures.modal.as_ref().ok().copied().flatten(),
        trend: measures.trend,
        l_infinity,
        verdicts: Vec::new(),
    }
}

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

/// Columns r, g, where density varies those that allow for it, and one g a sampler; no rows where the function is not
/// defined.
pub(super) fn pcf_table(measures: &Measures, curves: &[ReferenceCurve]) -> (Vec<String>, Vec<Vec<Cell>>) {
    let (r, g) = measures.pcf.as_ref().map_or((&[][..], &[][..]), |pcf| (&pcf.r, &pcf.g));
    let varying = measures.inhomogeneous.iter().flat_map(|f| f.columns());
    let samplers = curves.iter().map(|c| (format!("g_{}", c.sampler.replace('-', "_")), c.pcf.g.as_slice()));
    series_table(
        [("r".to_owned(), r), ("g".to_owned(), g)]
            .into_iter()
            .chain(varying.map(|(name, values)| (name.to_owned(), values)))
            .chain(samplers),
    )
}

/// A warning for every sampler that has no curve, with the reason.
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
                "it is uncertain how the image was taken (confidence {:.2} that it is {}), and with it the detections; --modality settles it",
                found.modality_confidence, found.modality
            ));
        }
        let confidence = found.spacing_confidence;
        if confidence < CONFIDENT {
            warnings.push(format!(
                "the cone spacing is uncertain (confidence {confidence:.2}), and with it the detections: {:.1} px by Yellott's ring, {:.1} px by the density of the cones found; --spacing overrules both",
                found.ring_spacing, found.spacing
            ));
        }
    }
    if record.n < FEW {
        warnings.push(format!("only {}: every statistic is uncertain", counted(record.n, "point")));
    }
    if record.trend.significant {
        let percent = |share: f64| format!("{:.0}", 100. * share);
        let size = record.trend.variation.zip(record.trend.variation_interval).map(|(size, (low, high))| {
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

/// Columns of `NAME.points.csv`: lengths in the unit of the coordinates, areas in its square. What is not defined (no
/// neighbour, an infinite cell, a point that coincides with an earlier one) is empty.
pub(super) fn points_table(mosaic: &Mosaic, measures: &Measures) -> (Vec<String>, Vec<Vec<Cell>>) {
    let angle = |angles: &[Option<f64>], k: usize| angles.get(k).copied().flatten().into();
    let rows = mosaic
        .points()
        .iter()
        .zip(&measures.cells.cells)
        .enumerate()
        .map(|(k, (p, cell))| {
            vec![
                p.x.into(),
                p.y.into(),
                measures.neighbours.distances.get(k).copied().into(),
                // rows count from 1, as in R
                measures.neighbours.indices.get(k).map(|j| j + 1).into(),
                measures.borders.get(k).copied().into(),
                cell.clipped_area.into(),
                cell.area.into(),
                cell.sides.into(),
                usize::from(cell.bound).into(),
                cell.inter_cell.into(),
                cell.furthest.into(),
                cell.psi6.map(|[re, im]| re.hypot(im)).into(),
                angle(&measures.orientation.nearest.degrees, k),
                angle(&measures.orientation.hexagons, k),
            ]
        })
        .collect();
    (tables::POINTS.header(), rows)
}

/// Columns of `NAME.density_recovery.csv`: middle radius of every annulus in the unit of the coordinates, points per squared unit there,
/// and that over the mean; no rows for fewer than two points.
pub(super) fn recovery_table(measures: &Measures) -> (Vec<String>, Vec<Vec<Cell>>) {
    let none = (Vec::new(), Vec::new(), Vec::new());
    let (r, density, relative) = measures.density_recovery.as_ref().map_or(none, |profile| {
        let relative = profile.density.iter().map(|d| d / profile.mean_density).collect();
        (profile.r.clone(), profile.density.clone(), relative)
    });
    series_table([
        ("r".to_owned(), r.as_slice()),
        ("density".to_owned(), density.as_slice()),
        ("relative_density".to_owned(), relative.as_slice()),
    ])
}

/// Columns of `NAME.functions.csv`.
pub(super) fn functions_table(functions: &Functions) -> (Vec<String>, Vec<Vec<Cell>>) {
    let columns = functions.columns();
    series_table(columns.iter().map(|(name, values)| ((*name).to_owned(), values.as_slice())))
}
