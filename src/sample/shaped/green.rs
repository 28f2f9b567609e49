use super::{NearestTarget, Noise, Shaped, TargetCurve};
use std::sync::LazyLock;

/// Pair correlation function g at .15, .244, …, 2.406 spacings, smoothed by a Gaussian of standard
/// deviation .1.
///
/// It is the mean over patterns of 512 and of 1024 points that a reference program made. They are
/// the green noise of Ahmed et al. (2015, “AA patterns for point sets with controlled spectral
/// properties”).
const PCF: [f64; 25] = [
    2.292, 2.064, 1.785, 1.439, 1.091, 0.803, 0.600, 0.478, 0.439, 0.477, 0.580, 0.735, 0.926, 1.120, 1.277,
    1.369, 1.391, 1.348, 1.248, 1.111, 0.969, 0.852, 0.772, 0.733, 0.729,
];

/// Power at .05, .1, …, .85 √n of the patterns of [`PCF`]; the power beyond is taken as 1.
///
/// The ring of high power at .62 √n makes the noise green.
const SPECTRUM: [f64; 17] =
    [0.68, 0.85, 1.01, 1.12, 1.06, 0.98, 1.06, 1.07, 1.06, 1.25, 2.16, 3.51, 3.50, 2.30, 1.22, 1.05, 0.98];

/// Mean and standard deviation of the nearest-neighbour distances on the torus, in spacings.
///
/// The mean, and its ratio to the standard deviation, lie between those of the two green sets that
/// Lanaro et al. measured (means .343 and .352, ratios 1.376 and 1.425).
const NEAREST: NearestTarget = NearestTarget { mean: 0.348, sd: 0.2495 };

/// Sampler with the curves of green noise, created on first use.
static SHAPED: LazyLock<Shaped> =
    LazyLock::new(|| Shaped { curve: TargetCurve::from_tables(&PCF, &SPECTRUM), nearest: Some(NEAREST) });

/// Green noise: clusters at a typical distance, so that the power gathers in a ring.
///
/// The points are made by [`Shaped`] with the curves of the patterns of Ahmed et al. (2015). The
/// term is that of Lau, Arce & Gallagher (1998, “Green-noise digital halftoning”).
pub static GREEN: Noise = Noise {
    name: "green",
    about: "green noise: clusters at a typical distance (ring of power at 0.62 √n), fitted to the PCF and spectrum of Ahmed et al. (2015); exactly n",
    shaped: &SHAPED,
};
