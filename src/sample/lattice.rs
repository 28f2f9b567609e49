use super::Frame;
use crate::geometry::Point;
use rand::{Rng, RngExt};

/// Offsets tried in a bounded window for the one whose number of points is nearest to n.
const OFFSETS: usize = 32;

/// Rows of points `step` apart; rows `row_step` apart; every other row moved by `shift` × `step`.
#[derive(Clone, Copy)]
pub(super) struct Lattice {
    pub(super) step: f64,
    pub(super) row_step: f64,
    pub(super) shift: f64,
}

impl Lattice {
    /// The undeformed lattice where the window has a border (its spacing is that of density n/A and the border cuts
    /// it, so the number is near n); on a torus the nearest lattice that closes on itself.
    pub(super) fn fill(self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Vec<Point> {
        if n == 0 {
            return Vec::new();
        }
        if frame.torus {
            let (columns, rows) = self.closing(n, frame);
            let closed = Self {
                step: frame.width / columns as f64,
                row_step: frame.height / rows as f64,
                // A single row closes on itself only unshifted.
                shift: if rows == 1 { 0. } else { self.shift },
            };
            let (x, y) = (rng.random::<f64>() * closed.step, rng.random::<f64>() * closed.row_step);
            return (0..rows)
                .flat_map(|row| (0..columns).map(move |column| (row, column)))
                .map(|(row, column)| {
                    let moved = x + closed.shift * closed.step * (row % 2) as f64;
                    frame.place(
                        (moved + column as f64 * closed.step).rem_euclid(frame.width),
                        y + row as f64 * closed.row_step,
                    )
                })
                .collect();
        }
        let mut best = (f64::INFINITY, 0., 0.);
        for _ in 0..OFFSETS {
            // Two rows are a period, so that either kind of row may come first.
            let (x, y) = (rng.random::<f64>() * self.step, rng.random::<f64>() * 2. * self.row_step);
            let count: usize = self.rows(x, y, frame).map(|(_, _, columns)| columns).sum();
            let miss = (count as f64 - n as f64).abs();
            if miss < best.0 {
                best = (miss, x, y);
            }
            if miss == 0. {
                break;
            }
        }
        self.rows(best.1, best.2, frame)
            .flat_map(|(x, y, columns)| (0..columns).map(move |i| (x + i as f64 * self.step, y)))
            .map(|(x, y)| frame.place(x, y))
            .collect()
    }

    /// First x, y, and number of points, of every row inside the window when the point (x, y) is in the lattice.
    fn rows(self, x: f64, y: f64, frame: &Frame) -> impl Iterator<Item = (f64, f64, usize)> {
        let first = -(y / self.row_step).floor();
        let (width, height) = (frame.width, frame.height);
        (0..)
            .map(move |i| {
                let row = first + i as f64;
                let moved = x + self.shift * self.step * row.rem_euclid(2.);
                let start = moved - (moved / self.step).floor() * self.step;
                let columns = ((width - start) / self.step).ceil().max(0.) as usize;
                (start, y + row * self.row_step, columns)
            })
            .take_while(move |&(_, y, _)| y < height)
    }

    /// Columns and rows of the least deformed lattice of about n points that closes on the torus.
    fn closing(self, n: usize, frame: &Frame) -> (usize, usize) {
        let (columns, rows) = (frame.width / self.step, frame.height / self.row_step);
        let around = |ideal: f64| {
            let low = (ideal.floor() as usize).saturating_sub(2).max(1);
            low..low + 6
        };
        let mut best = (f64::INFINITY, 1, 1);
        for r in around(rows) {
            if r > 1 && r % 2 == 1 && self.shift != 0. {
                continue;
            }
            for c in around(columns) {
                let number = ((c * r) as f64 / n as f64).ln().abs();
                let shape = ((c as f64 / columns) / (r as f64 / rows)).ln().abs();
                if number + shape < best.0 {
                    best = (number + shape, c, r);
                }
            }
        }
        (best.1, best.2)
    }
}
