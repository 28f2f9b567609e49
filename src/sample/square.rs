use super::lattice::Lattice;
use super::{Frame, SampleError, Sampler};
use crate::geometry::Point;
use rand::Rng;

/// The square lattice of density n/A at a random offset, without jitter.
#[derive(Clone, Copy, Debug)]
pub struct Square;

impl Sampler for Square {
    fn name(&self) -> &'static str {
        "square"
    }

    fn about(&self) -> &'static str {
        "square lattice at a random offset, no jitter; as near n as the lattice allows"
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        let side = (frame.width * frame.height / n.max(1) as f64).sqrt();
        Ok(Lattice { step: side, row_step: side, shift: 0. }.fill(n, frame, rng))
    }
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
            let points = Square.sample(1024, &window, &mut rng).unwrap();
            assert_eq!(points.len(), 1024);
            let nearest = nearest_neighbours(&points, &window);
            assert!(nearest.distances.iter().all(|d| (d * 32. - 1.).abs() < 1e-9));
        }
    }
}
