/// Converts between the spacing of a triangular lattice and the frequency of the first ring in its
/// spectrum: 2/(√3 × argument).
///
/// The same formula serves in both directions. The rows of the lattice are 1/frequency apart.
pub fn lattice_dual(frequency_or_spacing: f64) -> f64 {
    2. / (3f64.sqrt() * frequency_or_spacing)
}
