use super::MetricGroup::Fourier;
use super::Quantity::{Length, Plain};
use super::{Metric, metric};
use crate::report::tables::{Part, column};

/// Metrics of spacing from power spectra of the points and of the image.
pub(super) const FOURIER: &[Metric] = &[
    metric(
        Fourier,
        Length,
        column(
            "modal_spacing",
            "",
            "Spacing of the triangular lattice whose power spectrum has its ring at the same \
                frequency as the ring of the points, 2/(√3 frequency); empty for fewer than 20 \
                points, in a polygonal window and if there is no ring.",
        )
        .source("Yellott 1983")
        .of(|s| s.stats().modal.map(|m| m.spacing).into()),
    ),
    metric(
        Fourier,
        Length,
        column(
            "modal_row_spacing",
            "",
            "Modal spacing, from row to row of that lattice: 1/frequency of the ring in the power \
                spectrum of the points.",
        )
        .source("Yellott 1983")
        .of(|s| s.stats().modal.map(|m| m.row_spacing).into()),
    ),
    metric(
        Fourier,
        Plain,
        column(
            "modal_power",
            "ratio",
            "Mean power on the ring in the power spectrum of the points: 1 for independent \
                points.",
        )
        .source("Yellott 1983")
        .of(|s| s.stats().modal.map(|m| m.power).into()),
    ),
    metric(
        Fourier,
        Length,
        column(
            "fourier_spacing",
            "",
            "Spacing of the triangular lattice that has the same ring in its power spectrum as \
                the image, over all directions. No cones are detected for it; empty if there is no \
                ring.",
        )
        .source("After Cooper, Aguirre & Morgan 2019, but with a different background model and fit")
        .only(Part::Images)
        .of(|s| s.image().and_then(|r| r.fourier?.all).map(|f| f.spacing).into()),
    ),
    metric(
        Fourier,
        Length,
        column(
            "fourier_spacing_row",
            "",
            "Spacing of the triangular lattice that has the same ring in its power spectrum as \
                the image, over waves within 45° of the y axis. No cones are detected for it; empty \
                if there is no ring.",
        )
        .source("After Cooper, Aguirre & Morgan 2019, but with a different background model and fit")
        .only(Part::Images)
        .of(|s| s.image().and_then(|r| r.fourier?.row).map(|f| f.spacing).into()),
    ),
    metric(
        Fourier,
        Length,
        column(
            "fourier_spacing_cell",
            "",
            "Spacing of the triangular lattice that has the same ring in its power spectrum as \
                the image, over waves within 45° of the x axis. No cones are detected for it; empty \
                if there is no ring.",
        )
        .source("After Cooper, Aguirre & Morgan 2019, but with a different background model and fit")
        .only(Part::Images)
        .of(|s| s.image().and_then(|r| r.fourier?.cell).map(|f| f.spacing).into()),
    ),
    metric(
        Fourier,
        Plain,
        column(
            "fourier_confidence",
            "0–1",
            "How clearly the ring stands out: share of the variance of the spectral profile (over all \
                directions, smooth background removed) that the ring explains, minus the share that \
                noise of three standard deviations would explain. 0 means noise.",
        )
        .source("After Cooper, Aguirre & Morgan 2019, but with a different background model and fit")
        .only(Part::Images)
        .of(|s| s.image().and_then(|r| r.fourier?.all).map(|f| f.confidence).into()),
    ),
];
