use super::MetricGroup::Fourier;
use super::Quantity::{Length, Plain};
use super::{Metric, metric};
use crate::report::tables::{Part, column};

pub(super) const FOURIER: &[Metric] = &[
    metric(
        Fourier,
        Length,
        column(
            "modal_spacing",
            "",
            "Spacing of the triangular lattice whose ring of the power spectrum is where that of \
                the points is, 2/(√3 frequency); empty for fewer than 20 points, in a polygon and \
                without a ring.",
        )
        .source("Yellott 1983")
        .of(|s| s.stats().modal.map(|m| m.spacing).into()),
    ),
    metric(
        Fourier,
        Length,
        column("modal_row_spacing", "", "Modal spacing: 1/frequency of that ring, from row to row.")
            .source("Yellott 1983")
            .of(|s| s.stats().modal.map(|m| m.row_spacing).into()),
    ),
    metric(
        Fourier,
        Plain,
        column("modal_power", "ratio", "Power on that ring: 1 for independent points.")
            .source("Yellott 1983")
            .of(|s| s.stats().modal.map(|m| m.power).into()),
    ),
    metric(
        Fourier,
        Length,
        column(
            "fourier_spacing",
            "",
            "Spacing of the triangular lattice with the ring that cones leave in the spectrum of \
                the image, in all directions, without looking for cones; empty without a ring.",
        )
        .source("Cooper, Aguirre & Morgan 2019, with another background and fit")
        .only(Part::Images)
        .of(|s| s.image().and_then(|r| r.fourier?.all).map(|f| f.spacing).into()),
    ),
    metric(
        Fourier,
        Length,
        column(
            "fourier_spacing_row",
            "",
            "Spacing of the triangular lattice with the ring that cones leave in the spectrum of \
                the image, of waves within 45° of the y axis, without looking for cones; empty \
                without a ring.",
        )
        .source("Cooper, Aguirre & Morgan 2019, with another background and fit")
        .only(Part::Images)
        .of(|s| s.image().and_then(|r| r.fourier?.row).map(|f| f.spacing).into()),
    ),
    metric(
        Fourier,
        Length,
        column(
            "fourier_spacing_cell",
            "",
            "Spacing of the triangular lattice with the ring that cones leave in the spectrum of \
                the image, of waves within 45° of the x axis, without looking for cones; empty \
                without a ring.",
        )
        .source("Cooper, Aguirre & Morgan 2019, with another background and fit")
        .only(Part::Images)
        .of(|s| s.image().and_then(|r| r.fourier?.cell).map(|f| f.spacing).into()),
    ),
    metric(
        Fourier,
        Plain,
        column(
            "fourier_confidence",
            "0–1",
            "Share of the variance of the profile in all directions about its background that the \
                ring explains, less what it explains of noise by three standard deviations: 0 of \
                noise.",
        )
        .source("Cooper, Aguirre & Morgan 2019, with another background and fit")
        .only(Part::Images)
        .of(|s| s.image().and_then(|r| r.fourier?.all).map(|f| f.confidence).into()),
    ),
];
