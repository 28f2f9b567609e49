use super::MetricGroup::Expected;
use super::Quantity::Plain;
use super::{Metric, metric};
use crate::report::tables::EdgeRule::All;
use crate::report::tables::column;

/// Metrics of the location of the image on the retina, and values expected at this location.
pub(super) const EXPECTED: &[Metric] = &[
    metric(
        Expected,
        Plain,
        column(
            "eccentricity_mm",
            "mm",
            "Distance from the fovea along the retina, from the manifest: its eccentricity_mm or \
                else its eccentricity_deg, converted by um_per_degree. The conversion holds near the \
                fovea only; give mm for the periphery. Empty if not given.",
        )
        .of(|s| s.mosaic().place.map(|p| p.eccentricity_mm).into()),
    ),
    metric(
        Expected,
        Plain,
        column(
            "meridian",
            "text",
            "Direction from the fovea on the retina, from the manifest: nasal, temporal, superior \
                or inferior. Empty if not given; the expected density is then the mean of the four.",
        )
        .of(|s| s.mosaic().place.and_then(|p| p.meridian).map(|m| m.name()).into()),
    ),
    metric(
        Expected,
        Plain,
        column(
            "density_expected_per_mm2",
            "1/mm²",
            "Cone density expected at this place in the average eye. The average is over eight \
                retinas of seven people aged 27 to 44 years, with 100 000 to 324 000 cones per mm² \
                at the centre of the fovea. Empty farther than 18 mm from the fovea; if the meridian \
                is known, farther than 18 to 22 mm, depending on the meridian.",
        )
        .source("Curcio et al. 1990, read off their curves")
        .of(|s| s.mosaic().expected_cones_per_mm2().into()),
    ),
    metric(
        Expected,
        Plain,
        column(
            "spacing_expected_um",
            "µm",
            "Spacing of neighbouring cones in the triangular lattice of density \
                density_expected_per_mm2.",
        )
        .source("Curcio et al. 1990, read off their curves")
        .of(|s| s.mosaic().expected_spacing_um().into()),
    ),
    metric(
        Expected,
        Plain,
        column(
            "density_of_expected_percent",
            "%",
            "Measured density as a percentage of density_expected_per_mm2; empty without a scale \
                or an eccentricity.",
        )
        .edge(All)
        .source("Curcio et al. 1990, read off their curves")
        .of(|s| {
            let mosaic = s.mosaic();
            let ratio = mosaic.density_per_mm2().zip(mosaic.expected_cones_per_mm2());
            ratio.map(|(found, expected)| 100. * found / expected).into()
        }),
    ),
];
