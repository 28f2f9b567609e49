use super::{Frame, SampleError, Sampler};
use crate::geometry::Point;
use rand::{Rng, RngExt};

/// One uniform point in each of n cells of equal area: jittered sampling.
///
/// The window is cut into about √(n h/w) rows (w and h are its width and height), and each row into
/// cells. The number of cells may differ by one between rows; rows with one more cell are higher,
/// so all cells have the same area. A square number in a square window gives the √n × √n grid.
///
/// Source: Cook (1986), <https://doi.org/10.1145/7529.8927>.
#[derive(Clone, Copy, Debug)]
pub struct Jittered;

impl Sampler for Jittered {
    fn name(&self) -> &'static str {
        "jittered"
    }

    fn about(&self) -> &'static str {
        "one uniform point in each of n nearly square cells of equal area; exactly n (Cook 1986)"
    }

    fn exact(&self) -> bool {
        true
    }

    fn by_default(&self) -> bool {
        true
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        let ideal = (n as f64 * frame.height / frame.width).sqrt().round();
        let rows = (ideal as usize).clamp(1, n.max(1));
        let first = |row: usize| row * n / rows;
        let mut points = Vec::with_capacity(n);
        for row in 0..rows {
            let columns = first(row + 1) - first(row);
            let cell_width = frame.width / columns as f64;
            let cell_height = frame.height * columns as f64 / n as f64;
            let top = frame.height * first(row) as f64 / n as f64;
            for column in 0..columns {
                let (u, v): (f64, f64) = (rng.random(), rng.random());
                points.push(frame.place((column as f64 + u) * cell_width, top + v * cell_height));
            }
        }
        Ok(points)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Window;
    use rand::SeedableRng;

    #[test]
    fn square_number_in_a_square_has_one_point_in_every_grid_cell() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let points = Jittered.sample(1024, &Window::unit_square(), &mut rng).unwrap();
        let mut cells: Vec<_> = points.iter().map(|p| ((p.x * 32.) as usize, (p.y * 32.) as usize)).collect();
        cells.sort_unstable();
        cells.dedup();
        assert_eq!(cells.len(), 1024);
    }
}
