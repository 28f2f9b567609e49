//! The axis of log-frequency along which spectra are summed.

/// Number of log-frequency bins per octave.
pub(super) const PER_OCTAVE: f64 = 24.;
/// Period of the lowest bin, in px; bin b holds the period 64 / 2^(b/24).
pub(super) const LONGEST_PERIOD: f64 = 64.;
/// Number of bins, up to half a cycle per pixel.
pub(super) const BINS: usize = 121;

/// Returns the position of a period (px) on the axis of bins: a bin index with a fraction.
pub(super) fn bin_of(period: f64) -> f64 {
    PER_OCTAVE * (LONGEST_PERIOD / period).log2()
}

/// Index of the bin of the widest spacing that is looked for (40.3 px).
///
/// The network that reads the spacing was trained with this bin and with [`CANDIDATES`].
pub(super) const FIRST: usize = 16;
/// Number of candidate spacings, from the widest down to the closest (4 px).
pub(super) const CANDIDATES: usize = 81;

/// Returns the spacing, in px, of candidate `k`, which may have a fraction; candidate 0 is the
/// widest.
pub(super) fn candidate(k: f64) -> f64 {
    LONGEST_PERIOD / ((FIRST as f64 + k) / PER_OCTAVE).exp2()
}
