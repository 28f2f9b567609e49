use super::rows::{Lattice, jitter};
use crate::geometry::Point;
use crate::sample::{Configure, Frame, SampleError, Sampler, Settable, Setting};
use rand::Rng;

/// Square lattice of about n points at a random offset, with optional jitter.
#[derive(Clone, Copy, Debug)]
pub struct Square {
    /// Standard deviation of each point's displacement in x and y, in hexagonal spacings.
    pub jitter: f64,
}

impl Square {
    /// Default setting: the lattice without jitter.
    pub const DEFAULT: Self = Self { jitter: 0. };
}

impl Sampler for Square {
    fn name(&self) -> &'static str {
        "square"
    }

    fn about(&self) -> &'static str {
        "square lattice at a random offset, with optional jitter; as near n as the lattice allows"
    }

    fn in_rows(&self) -> bool {
        true
    }

    fn settable(&self) -> Option<&dyn Configure> {
        Some(self)
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        let side = (frame.width * frame.height / n.max(1) as f64).sqrt();
        let jitter = self.jitter * frame.spacing(n.max(1));
        Ok(Lattice { step: side, row_step: side, shift: 0., jitter }.fill(n, frame, rng))
    }
}

impl Settable for Square {
    const SETTINGS: &'static [Setting<Self>] = &[jitter(|s| Some(s.jitter), |s, v| s.jitter = v)];
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Window;
    use crate::stats::nearest_neighbours;
    use rand::SeedableRng;

    #[test]
    fn square_lattice_has_every_neighbour_at_the_side_of_its_cell() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        for window in [Window::unit_square(), Window::unit_torus()] {
            let points = Square::DEFAULT.sample(1024, &window, &mut rng).unwrap();
            assert_eq!(points.len(), 1024);
            let nearest = nearest_neighbours(&points, &window);
            assert!(nearest.distances.iter().all(|d| (d * 32. - 1.).abs() < 1e-9));
        }
    }
}
