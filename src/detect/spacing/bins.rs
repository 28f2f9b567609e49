//! The axis of log-frequency along which spectra are summed, and the candidate spacings on it.
//!
//! The network that reads the spacing (`ring_network`) was trained by `scripts/train-ring` with all
//! of these numbers; after a change of one, it must be trained anew.

/// Number of log-frequency bins per octave: neighbouring bins differ by 2.9 %, and a parabola
/// through three bins gives the position between them.
pub(super) const PER_OCTAVE: f64 = 24.;
/// Period of the lowest bin, in px; bin b has the period 64 / 2^(b/24).
///
/// The axis begins two thirds of an octave below the ring of the widest spacing (40.3 px): the
/// network also sees the spectrum on that side of the ring.
pub(super) const LONGEST_PERIOD: f64 = 64.;
/// Number of bins: bins 0 to 120. Bin 120 has a period of 2 px, the shortest that pixels can show.
pub(super) const BINS: usize = 121;

/// Returns the position of a period (px) on the axis of bins: a bin index with a fraction.
pub(super) fn bin_of(period: f64) -> f64 {
    PER_OCTAVE * (LONGEST_PERIOD / period).log2()
}

/// Index of the bin of the widest spacing that is looked for: bin 16, 64 / 2^(16/24) = 40.3 px.
pub(super) const FIRST: usize = 16;
/// Number of candidate spacings: bins 16 to 96, from the widest down to the closest (4 px).
pub(super) const CANDIDATES: usize = 81;

/// Returns the spacing, in px, of candidate `k`; a `k` with a fraction lies between two candidates,
/// and candidate 0 is the widest.
pub(super) fn candidate(k: f64) -> f64 {
    LONGEST_PERIOD / ((FIRST as f64 + k) / PER_OCTAVE).exp2()
}
