/// Distance of neighbours in the triangular lattice whose first ring in the spectrum has this frequency, and the other way round:
/// 2/(√3 ·). Rows of that lattice are 1/frequency apart.
pub fn lattice_dual(frequency_or_spacing: f64) -> f64 {
    2. / (3f64.sqrt() * frequency_or_spacing)
}
