use super::MetricGroup::Expected;
use super::Quantity::Plain;
use super::{Metric, metric};
use crate::report::tables::EdgeRule::All;
use crate::report::tables::column;

pub(super) const EXPECTED: &[Metric] = &[
    metric(
        Expected,
        Plain,
        column(
            "eccentricity_mm",
            "mm",
            "Distance from the fovea along the retina, from the manifest's eccentricity_mm, or its \
                eccentricity_deg by um_per_degree (which holds near the fovea only: give mm for \
                the periphery); empty if not given.",
        )
        .of(|s| s.mosaic().place.map(|p| p.eccentricity_mm).into()),
    ),
    metric(
        Expected,
        Plain,
        column(
            "meridian",
            "text",
            "Direction from the fovea on the retina, from the manifest; empty if not given: then \
                what is expected is the mean of the four.",
        )
        .of(|s| s.mosaic().place.and_then(|p| p.meridian).map(|m| m.name()).into()),
    ),
    metric(
        Expected,
        Plain,
        column(
            "density_expected_per_mm2",
            "1/mm²",
            "Cones per mm² at that place in the average eye (eight retinas of seven people of 27 \
                to 44 years, whose foveal centres have 100 000 to 324 000); empty beyond 18 mm, \
                along a meridian 18 to 22 mm.",
        )
        .source("Curcio et al. 1990, read off their curves")
        .of(|s| s.mosaic().expected_cones_per_mm2().into()),
    ),
    metric(
        Expected,
        Plain,
        column("spacing_expected_um", "µm", "Spacing of the triangular lattice of that density.")
            .source("Curcio et al. 1990, read off their curves")
            .of(|s| s.mosaic().expected_spacing_um().into()),
    ),
    metric(
        Expected,
        Plain,
        column(
            "density_of_expected_percent",
            "%",
            "density in per cent of what is expected there; empty without scale or eccentricity.",
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
