//! Lattices made of rows of points, in bounded windows and on a torus.

use crate::geometry::Point;
use crate::sample::{Frame, Setting};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

/// Largest number of random offsets tried in a bounded window to bring the number of points near n.
const OFFSETS: usize = 32;

/// Width of the strip around a bounded window from which jitter may carry points into it, in
/// standard deviations of the jitter. Larger displacements are too rare to matter.
const CARRIED: f64 = 5.;

/// Returns the parameter `jitter`, which all lattices share.
pub(super) const fn jitter<S>(get: fn(&S) -> Option<f64>, set: fn(&mut S, f64)) -> Setting<S> {
    Setting {
        name: "jitter",
        unit: "spacings",
        range: (0., 1.),
        whole: false,
        unset: "",
        meaning: "standard deviation of each point's displacement in x and y",
        get,
        set,
    }
}

/// Lattice of parallel rows.
///
/// Points in a row are `step` apart, rows are `row_step` apart, and every other row is moved along
/// itself by `shift` × `step`. Each point is then displaced by a normal deviate of standard
/// deviation `jitter` in x and y. All lengths are in the frame's unit.
#[derive(Clone, Copy)]
pub(in crate::sample) struct Lattice {
    /// Distance between successive points of a row.
    pub(in crate::sample) step: f64,
    /// Distance between successive rows.
    pub(in crate::sample) row_step: f64,
    /// Displacement of every other row along itself, in steps.
    pub(in crate::sample) shift: f64,
    /// Standard deviation of a point's random displacement in x and y.
    pub(in crate::sample) jitter: f64,
}

impl Lattice {
    /// Returns the points of the lattice in a frame, at a random offset.
    ///
    /// In a window with a border, the lattice is not deformed. The border cuts it off, so the
    /// number of points is only near `n`. On a torus, the lattice is deformed as little as possible
    /// so that it closes on itself.
    pub(in crate::sample) fn fill(self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Vec<Point> {
        if n == 0 {
            return Vec::new();
        }
        if frame.torus {
            let (columns, rows) = self.closing(n, frame);
            let closed = Self {
                step: frame.width / columns as f64,
                row_step: frame.height / rows as f64,
                // A single row closes on itself only if it is not shifted.
                shift: if rows == 1 { 0. } else { self.shift },
                jitter: self.jitter,
            };
            let (x, y) = (rng.random::<f64>() * closed.step, rng.random::<f64>() * closed.row_step);
            return (0..rows)
                .flat_map(|row| (0..columns).map(move |column| (row, column)))
                .map(|(row, column)| {
                    let moved = x + closed.shift * closed.step * (row % 2) as f64;
                    let (x, y) = (moved + column as f64 * closed.step, y + row as f64 * closed.row_step);
                    let [x, y] = closed.jittered([x, y], rng);
                    frame.place(x.rem_euclid(frame.width), y.rem_euclid(frame.height))
                })
                .collect();
        }
        let mut best = (f64::INFINITY, 0., 0.);
        for _ in 0..OFFSETS {
            // The period is two rows, so that either kind of row may come first.
            let (x, y) = (rng.random::<f64>() * self.step, rng.random::<f64>() * 2. * self.row_step);
            let count: usize =
                self.rows(x, y, [frame.width, frame.height]).map(|(_, _, columns)| columns).sum();
            let miss = (count as f64 - n as f64).abs();
            if miss < best.0 {
                best = (miss, x, y);
            }
            if miss == 0. {
                break;
            }
        }
        let margin = CARRIED * self.jitter;
        let (x, y, sides) = (best.1 + margin, best.2 + margin, [frame.width, frame.height]);
        self.rows(x, y, sides.map(|side| side + 2. * margin))
            .flat_map(|(x, y, columns)| (0..columns).map(move |i| [x + i as f64 * self.step, y]))
            .map(|[x, y]| self.jittered([x - margin, y - margin], rng))
            .filter(|[x, y]| self.jitter == 0. || (0. ..sides[0]).contains(x) && (0. ..sides[1]).contains(y))
            .map(|[x, y]| frame.place(x, y))
            .collect()
    }

    /// Displaces a point at random.
    fn jittered(self, [x, y]: [f64; 2], rng: &mut dyn Rng) -> [f64; 2] {
        if self.jitter == 0. {
            return [x, y];
        }
        let (dx, dy): (f64, f64) = (rng.sample(StandardNormal), rng.sample(StandardNormal));
        [x + self.jitter * dx, y + self.jitter * dy]
    }

    /// Returns the first x, the y and the number of points of each row in a window of size `[width,
    /// height]`.
    ///
    /// `(x, y)` is a point of the lattice, in a row that is not shifted.
    fn rows(self, x: f64, y: f64, [width, height]: [f64; 2]) -> impl Iterator<Item = (f64, f64, usize)> {
        let first = -(y / self.row_step).floor();
        (0..)
            .map(move |i| {
                let row = first + f64::from(i);
                let moved = x + self.shift * self.step * row.rem_euclid(2.);
                let start = moved - (moved / self.step).floor() * self.step;
                let columns = ((width - start) / self.step).ceil().max(0.) as usize;
                (start, y + row * self.row_step, columns)
            })
            .take_while(move |&(_, y, _)| y < height)
    }

    /// Returns the numbers of columns and rows of the least deformed lattice of about `n` points
    /// that closes on the torus.
    fn closing(self, n: usize, frame: &Frame) -> (usize, usize) {
        let (columns, rows) = (frame.width / self.step, frame.height / self.row_step);
        let around = |ideal: f64| {
            let low = (ideal.floor() as usize).saturating_sub(2).max(1);
            low..low + 6
        };
        let mut best = (f64::INFINITY, 1, 1);
        for r in around(rows) {
            // Shifted rows alternate, so only an even number of them closes.
            if r > 1 && r % 2 == 1 && self.shift != 0. {
                continue;
            }
            for c in around(columns) {
                // The score adds the deviation of the number of points and that of the lattice's
                // proportions.
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
