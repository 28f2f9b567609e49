//! Dart throwing over a quadtree of the squares that may still have room.
//!
//! 1. Choose a square with a probability proportional to its area, and throw a uniform dart into
//!    it.
//! 2. A dart that is at least the disk radius from every point becomes a point, and the square is
//!    dropped.
//! 3. Otherwise the square is cut in four, and each quarter that lies in the disk around a single
//!    point is dropped.
//!
//! No dart in a dropped square could become a point, and the darts are uniform over the remaining
//! squares, so the points have exactly the distribution of plain dart throwing.
//!
//! Source: White, Cline and Egbert (2007), <https://doi.org/10.1109/RT.2007.4342600>.

use crate::geometry::index::{Nearby, TorusGrid};
use rand::{Rng, RngExt};

/// Number of halvings after which a square counts as covered. Its area is then 2⁻⁵⁰ of that of a
/// cell of the grid, so the lost room does not matter.
const DEEPEST: usize = 25;

/// Throws darts until `n` of them are kept, or until the torus is full, and returns the kept darts.
///
/// No two kept darts are nearer to each other than `radius` on the torus. `grid` is emptied first,
/// and then contains the kept darts.
pub(super) fn throw(n: usize, radius: f64, grid: &mut TorusGrid, rng: &mut dyn Rng) -> Vec<[f64; 2]> {
    grid.clear();
    let radius2 = radius * radius;
    let mut squares = Squares::new(grid);
    let mut points = Vec::with_capacity(n.min(grid.columns() * grid.rows()));
    let mut near = Nearby::default();
    while points.len() < n {
        let Some((level, [left, top])) = squares.take(rng) else { break };
        let (width, height) = squares.size(level);
        let half = [width / 2., height / 2.];
        let reach = radius + half[0].hypot(half[1]);
        grid.gather(left + half[0], top + half[1], reach, &mut near);
        let (u, v): (f64, f64) = (rng.random(), rng.random());
        let dart = [left + u * width, top + v * height];
        if !near.any_nearer(dart[0], dart[1], radius2) {
            // The square needs no more darts: a disk covers the entire grid cell in which its
            // centre lies.
            grid.insert(dart[0], dart[1]);
            points.push(dart);
            continue;
        }
        if level == DEEPEST {
            continue;
        }
        for (column, row) in [(0., 0.), (1., 0.), (0., 1.), (1., 1.)] {
            let corner = [left + column * half[0], top + row * half[1]];
            let quarter = [half[0] / 2., half[1] / 2.];
            let covered = near.any_covers(corner[0] + quarter[0], corner[1] + quarter[1], quarter, radius2);
            if !covered {
                squares.put(level + 1, corner);
            }
        }
    }
    points
}

/// Squares that may have room for a dart, sorted by the number of times they were halved.
///
/// Strictly, they are rectangles with the proportions of the grid's cells.
struct Squares {
    /// Upper left corners of the squares, by the number of halvings.
    corners: Vec<Vec<[f64; 2]>>,
    /// Largest number of halvings of any square so far.
    deepest: usize,
    /// Width of a square that was not halved, which is a cell of the grid.
    width: f64,
    /// Height of a square that was not halved.
    height: f64,
}

impl Squares {
    fn new(grid: &TorusGrid) -> Self {
        let (width, height) = grid.cell_size();
        let mut corners = vec![Vec::new(); DEEPEST + 1];
        corners[0] = (0..grid.rows())
            .flat_map(|row| {
                (0..grid.columns()).map(move |column| [column as f64 * width, row as f64 * height])
            })
            .collect();
        Self { corners, deepest: 0, width, height }
    }

    /// Returns the width and height of a square that was halved `level` times.
    fn size(&self, level: usize) -> (f64, f64) {
        let scale = 0.5f64.powi(level as i32);
        (self.width * scale, self.height * scale)
    }

    /// Adds a square that was halved `level` times, by its upper left corner.
    fn put(&mut self, level: usize, corner: [f64; 2]) {
        self.corners[level].push(corner);
        self.deepest = self.deepest.max(level);
    }

    /// Removes a square chosen with probability proportional to its area.
    ///
    /// Returns the number of times it was halved and its upper left corner, or `None` if no square
    /// is left.
    fn take(&mut self, rng: &mut dyn Rng) -> Option<(usize, [f64; 2])> {
        let mut areas = [0.; DEEPEST + 1];
        let (mut total, mut share) = (0., 1.);
        for (area, squares) in areas.iter_mut().zip(&self.corners[..=self.deepest]) {
            *area = share * squares.len() as f64;
            total += *area;
            share /= 4.;
        }
        let mut left = rng.random::<f64>() * total;
        let mut chosen = None;
        for (level, area) in areas.iter().enumerate().filter(|(_, area)| **area > 0.) {
            chosen = Some(level);
            left -= area;
            if left < 0. {
                break;
            }
        }
        let level = chosen?;
        let squares = &mut self.corners[level];
        let picked = rng.random_range(0..squares.len());
        Some((level, squares.swap_remove(picked)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn full_window_is_an_error_that_says_how_many_fitted() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut grid = TorusGrid::new(1., 1., 0.2);
        let placed = throw(1000, 0.2, &mut grid, &mut rng).len();
        // A full torus holds at least as many points as the loosest maximal packing and at most as
        // many as the densest.
        assert!((8..29).contains(&placed), "{placed}");
    }
}
