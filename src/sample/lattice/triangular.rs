use super::rows::{Lattice, jitter};
use crate::geometry::Point;
use crate::sample::{Configure, Frame, SampleError, Sampler, Settable, Setting};
use rand::Rng;

/// Triangular lattice (hexagonal packing) of about n points at a random offset, with optional
/// jitter.
///
/// Rows lie along x. On a torus, rows and columns must close on themselves, which stretches the
/// lattice by a few per cent.
#[derive(Clone, Copy, Debug)]
pub struct Triangular {
    /// Standard deviation of each point's displacement in x and y, in hexagonal spacings.
    pub jitter: f64,
}

impl Triangular {
    /// Default setting: the lattice without jitter.
    pub const DEFAULT: Self = Self { jitter: 0. };
}

impl Sampler for Triangular {
    fn name(&self) -> &'static str {
        "triangular"
    }

    fn about(&self) -> &'static str {
        "triangular lattice at a random offset, with optional jitter; as near n as the lattice allows, and \
         stretched to close on a torus"
    }

    fn in_rows(&self) -> bool {
        true
    }

    fn by_default(&self) -> bool {
        true
    }

    fn settable(&self) -> Option<&dyn Configure> {
        Some(self)
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        let step = frame.spacing(n.max(1));
        let jitter = self.jitter * frame.spacing(n.max(1));
        Ok(Lattice { step, row_step: step * 3f64.sqrt() / 2., shift: 0.5, jitter }.fill(n, frame, rng))
    }
}

impl Settable for Triangular {
    const SETTINGS: &'static [Setting<Self>] = &[jitter(|s| Some(s.jitter), |s, v| s.jitter = v)];
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Rectangle, Window};
    use crate::mosaic::hexagonal_spacing;
    use crate::stats::nearest_neighbours;
    use rand::SeedableRng;

    #[test]
    fn triangular_lattice_has_every_neighbour_at_the_hexagonal_spacing() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let spacing = hexagonal_spacing(1000, 1.).unwrap();
        let window = Window::unit_square();
        let points = Triangular::DEFAULT.sample(1000, &window, &mut rng).unwrap();
        assert!(points.len().abs_diff(1000) <= 30, "{}", points.len());
        let nearest = nearest_neighbours(&points, &window);
        assert!(nearest.distances.iter().all(|d| (d / spacing - 1.).abs() < 1e-9));
    }

    #[test]
    fn triangular_lattice_on_a_fitting_torus_is_exact_and_undeformed() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let window = Window::Torus(Rectangle::new(-3., 5., 17., 5. + 12. * 3f64.sqrt()).unwrap());
        let points = Triangular::DEFAULT.sample(20 * 24, &window, &mut rng).unwrap();
        assert_eq!(points.len(), 480);
        let nearest = nearest_neighbours(&points, &window);
        assert!(nearest.distances.iter().all(|d| (d - 1.).abs() < 1e-9));
    }
}
