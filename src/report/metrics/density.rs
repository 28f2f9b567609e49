use super::EdgeRule::{All, Bound, NotAffected};
use super::MetricGroup::{Density, Expected};
use super::metric::Value::One;
use super::{Metric, Quantity, SummaryKind};

pub(super) const DENSITY: &[Metric] = &[
    Metric {
        name: "density",
        group: Density,
        quantity: Quantity::Density,
        edge: All,
        definition: "Cones in the window over its area.",
        source: "",
        only: None,
        value: One(|s| s.mosaic().density.into()),
    },
    Metric {
        name: "density_bound",
        group: Density,
        quantity: Quantity::Density,
        edge: Bound,
        definition: "Bound Voronoi cells over their total area; empty without bound cells.",
        source: "Cooper et al. 2016",
        only: None,
        value: One(|s| s.mosaic().voronoi.density.into()),
    },
    Metric {
        name: "window_area",
        group: Density,
        quantity: Quantity::Area,
        edge: NotAffected,
        definition: "Area in which cones could have been seen.",
        source: "",
        only: None,
        value: One(|s| s.mosaic().window_area.into()),
    },
    Metric {
        name: "spacing_ring",
        group: Density,
        quantity: Quantity::Length,
        edge: NotAffected,
        definition: "Spacing of rows of cones by Yellott's ring in the spectrum of the image, × 2/√3.",
        source: "Yellott 1983",
        only: Some(SummaryKind::Images),
        value: One(|s| s.image().map(|r| r.detection.ring_spacing_px).into()),
    },
    Metric {
        name: "spacing_density",
        group: Density,
        quantity: Quantity::Length,
        edge: All,
        definition: "Distance of neighbours in the triangular lattice of the same density, √(2/(√3 density)); empty without cones.",
        source: "",
        only: Some(SummaryKind::Images),
        value: One(|s| s.mosaic().spacing.into()),
    },
    Metric {
        name: "spacing",
        group: Density,
        quantity: Quantity::Length,
        edge: All,
        definition: "Distance of neighbours in the triangular lattice of the same density, √(2/(√3 density)); empty without points.",
        source: "",
        only: Some(SummaryKind::Coordinates),
        value: One(|s| s.mosaic().spacing.into()),
    },
];

pub(super) const EXPECTED: &[Metric] = &[
    Metric {
        name: "eccentricity_mm",
        group: Expected,
        quantity: Quantity::Plain("mm"),
        edge: NotAffected,
        definition: "Distance from the fovea along the retina, from the manifest's eccentricity_mm, or its eccentricity_deg by um_per_degree \
                     (which holds near the fovea only: give mm for the periphery); empty if not given.",
        source: "",
        only: None,
        value: One(|s| s.mosaic().place.map(|p| p.eccentricity_mm).into()),
    },
    Metric {
        name: "meridian",
        group: Expected,
        quantity: Quantity::Plain("text"),
        edge: NotAffected,
        definition: "Direction from the fovea on the retina, from the manifest; empty if not given: then what is expected is the mean of the four.",
        source: "",
        only: None,
        value: One(|s| s.mosaic().place.and_then(|p| p.meridian).map(|m| m.name()).into()),
    },
    Metric {
        name: "density_expected_per_mm2",
        group: Expected,
        quantity: Quantity::Plain("1/mm²"),
        edge: NotAffected,
        definition: "Cones per mm² at that place in the average eye (eight retinas of seven people of 27 to 44 years, whose foveal centres have \
                     100 000 to 324 000); empty beyond 18 mm, along a meridian 18 to 22 mm.",
        source: "Curcio et al. 1990, read off their curves",
        only: None,
        value: One(|s| s.mosaic().expected_cones_per_mm2().into()),
    },
    Metric {
        name: "spacing_expected_um",
        group: Expected,
        quantity: Quantity::Plain("µm"),
        edge: NotAffected,
        definition: "Spacing of the triangular lattice of that density.",
        source: "Curcio et al. 1990, read off their curves",
        only: None,
        value: One(|s| s.mosaic().expected_spacing_um().into()),
    },
    Metric {
        name: "density_of_expected_percent",
        group: Expected,
        quantity: Quantity::Plain("%"),
        edge: All,
        definition: "density in per cent of what is expected there; empty without scale or eccentricity.",
        source: "Curcio et al. 1990, read off their curves",
        only: None,
        value: One(|s| {
            let mosaic = s.mosaic();
            let ratio = mosaic.density_per_mm2().zip(mosaic.expected_cones_per_mm2());
            ratio.map(|(found, expected)| 100. * found / expected).into()
        }),
    },
];
