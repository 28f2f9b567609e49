//! The axis of log-frequency that spectra are summed along.

/// Log-frequency bins per octave.
pub(super) const PER_OCTAVE: f64 = 24.;
/// Period of the lowest bin, in px; bin b holds the period 64 / 2^(b/24).
pub(super) const LONGEST_PERIOD: f64 = 64.;
/// Up to half a cycle per pixel.
pub(super) const BINS: usize = 121;

/// Where among the bins a period, px, lies.
pub(super) fn bin_of(period: f64) -> f64 {
    PER_OCTAVE * (LONGEST_PERIOD / period).log2()
}

/// The bin of the widest spacing looked for (40.3 px), and how many there are down to the closest (4 px): as the network was trained.
pub(super) const FIRST: usize = 16;
pub(super) const CANDIDATES: usize = 81;

/// The spacing, px, of a candidate.
pub(super) fn candidate(k: f64) -> f64 {
    LONGEST_PERIOD / ((FIRST as f64 + k) / PER_OCTAVE).exp2()
}
