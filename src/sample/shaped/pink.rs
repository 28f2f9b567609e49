use super::{NearestTarget, Noise, Shaped, TargetCurve};
use std::sync::LazyLock;

/// Pair correlation function g at .15, .244, …, 2.406 spacings, smoothed by a Gaussian of standard
/// deviation .1.
///
/// It is the mean over patterns of 512 and of 1024 points that a reference program made. They are
/// the pink noise of Ahmed et al. (2015, “AA patterns for point sets with controlled spectral
/// properties”).
const PCF: [f64; 25] = [
    2.475, 2.333, 2.208, 2.069, 1.916, 1.757, 1.592, 1.421, 1.275, 1.165, 1.077, 1.016, 0.979, 0.956, 0.949,
    0.956, 0.977, 0.997, 1.008, 1.013, 1.017, 1.016, 1.009, 0.999, 0.987,
];

/// Power at .05, .1, …, .85 √n of the patterns of [`PCF`]; the power beyond is taken as 1.
///
/// The power falls from low frequencies to .65 √n.
const SPECTRUM: [f64; 17] =
    [3.44, 3.26, 3.28, 3.04, 2.99, 2.76, 2.35, 2.24, 2.05, 1.91, 1.71, 1.41, 1.22, 1.04, 1.04, 0.98, 0.99];

/// Mean and standard deviation of the nearest-neighbour distances on the torus, in spacings.
///
/// The mean lies between those of the two pink sets that Lanaro et al. measured (.372 and .378).
/// The ratio of the mean to the standard deviation lies between the ratios of the two sets (1.48
/// and 1.50) and that of the mean over many patterns.
const NEAREST: NearestTarget = NearestTarget { mean: 0.376, sd: 0.2615 };

/// Sampler with the curves of pink noise, created on first use.
static SHAPED: LazyLock<Shaped> =
    LazyLock::new(|| Shaped { curve: TargetCurve::from_tables(&PCF, &SPECTRUM), nearest: Some(NEAREST) });

/// Pink noise: power falls with frequency, and points gather in clouds.
///
/// The points are made by [`Shaped`] with the curves of the patterns of Ahmed et al. (2015).
pub static PINK: Noise = Noise {
    name: "pink",
    about: "pink noise: clouds of points (power falls up to 0.65 √n), fitted to the PCF and spectrum of Ahmed et al. (2015); exactly n",
    shaped: &SHAPED,
};
